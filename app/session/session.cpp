#include "app/session/session.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <utility>

#include "devices/live/probe_buttons.h"
#include "devices/replay/read_log.h"
#include "scenarios/words.h"
#include "sim/core/input_error.h"
#include "sim/tissue/acoustic_volume.h"

namespace insonate {
namespace {

/// Moves `mouse` from one pose to another. MouseTracker takes motions in the probe's own frame.
void push(MouseTracker& mouse, const Pose& from, const Pose& to) {
  const Pose step = from.inverse() * to;
  const glm::dquat turn = glm::normalize(glm::quat_cast(step.rotation));
  const double angle = glm::angle(turn);
  mouse.move(step.translation, angle > 1e-12 ? angle * glm::axis(turn) : glm::dvec3(0.0));
}

/// Returns the setting that a scenario locks in order to lock `knob`.
ActionKind lock_of(ActionKind knob) {
  switch (knob) {
    case ActionKind::dynamic_range:
    case ActionKind::time_gain:
    case ActionKind::compounding:
    case ActionKind::persistence:
    case ActionKind::edge_enhancement:
    case ActionKind::speckle_reduction:
      return ActionKind::gain;
    default:
      return knob;
  }
}

/// Returns what people call a setting, in the middle of a sentence.
std::string name_of(ActionKind setting) {
  return "the " + in_words(std::string(word_of(setting)));
}

/// Returns whether `action` only replaces the value that `before` has set.
bool replaces(const Action& action, const Action& before) {
  switch (action.kind) {
    case ActionKind::depth:
    case ActionKind::frequency:
    case ActionKind::gain:
    case ActionKind::dynamic_range:
    case ActionKind::compounding:
    case ActionKind::persistence:
    case ActionKind::edge_enhancement:
    case ActionKind::speckle_reduction:
      return before.kind == action.kind;
    case ActionKind::time_gain:
      return before.kind == action.kind && before.slot() == action.slot();
    case ActionKind::effect:
      return before.kind == action.kind && before.text == action.text;
    default:
      return false;
  }
}

}  // namespace

void check_source(const Tracker& tracker, bool exam) {
  if (exam && tracker.repeats())
    throw InputError(tracker.state().name, "option 'loop'", "an exam is scored from a log that comes once",
                     "leave loop=1 out, or practise on a patient of your own, without a scenario");
  if (tracker.recording()) check_is_of_probe(*tracker.recording());
  if (exam && tracker.recording()) check_has_times(*tracker.recording());
}

Session::Session(std::shared_ptr<const LoadedCase> loaded_case, OpenTracker open, double predict_s, ExamRules rules)
    : loaded_case_(std::move(loaded_case)),
      open_(std::move(open)),
      predict_s_(predict_s),
      rules_(rules),
      hand_(loaded_case_->subject.ct) {
  tracker_ = open_fresh();
  if (MouseTracker* own_hand = tracker_->steered()) {
    only_learner_ = true;
    static_cast<void>(tracker_.release());
    learner_.reset(own_hand);
    holder_ = Holder::learner;
  }
  shown_ = first_machine();
  if (loaded_case_->scenario) activity_ = Activity::exam;
  begin_attempt();
}

bool Session::can_take_steps() const {
  return loaded_case_->scenario && (holder_ == Holder::learner || !tracker_->rehearsed());
}

Machine Session::first_machine() const {
  if (loaded_case_->scenario) return starting_machine(*loaded_case_->scenario, loaded_case_->subject);
  Machine machine;
  machine.choose(probes().front().name);
  return machine;
}

const Tracker& Session::source() const {
  if (holder_ == Holder::learner) return *learner_;
  return *tracker_;
}

Tracker& Session::source() {
  if (holder_ == Holder::learner) return *learner_;
  return *tracker_;
}

std::unique_ptr<Tracker> Session::open_fresh() const {
  std::unique_ptr<Tracker> tracker = open_();
  check_source(*tracker, loaded_case_->scenario.has_value());
  if (const Recording* recording = tracker->recording()) check_recorded_on(*loaded_case_, *recording);
  return tracker;
}

void Session::restart_tracker() {
  if (tracker_->live()) return;  // a device has no beginning, and would be busy if opened twice
  tracker_ = open_fresh();
}

void Session::begin_attempt() {
  ++attempt_;
  runner_.reset();
  exam_samples_.clear();
  result_.reset();
  if (!can_take_steps()) activity_ = Activity::practice;
  if (activity_ == Activity::exam)
    runner_ = std::make_unique<Runner>(*loaded_case_->scenario, loaded_case_->subject, loaded_case_->tissues);
  last_usable_s_ = attempt_began_s_ = now_s_;
  event_markers_s_.clear();
  history_.clear();
  // A recorded scan sets the machine anew each time.
  if (source().recording()) shown_ = first_machine();
  shown_.apply({ActionKind::unfreeze}, std::nullopt);
  if (activity_ == Activity::exam) shown_.effects.clear();  // of practice
  machine_ = runner_ ? runner_->machine() : Machine();
  acts_ = actions_between(machine_, shown_);
  actions_.clear();
  latest_actions_.clear();
  attempt_is_fresh_ = true;
  held_back_.clear();
  log_actions_.clear();
  if (const Recording* recording = source().recording())
    log_actions_ = parse_action_log(recording->actions, recording->file);
  // Not the learner's: a log with it alone has no actions.
  for (auto at = log_actions_.begin(); at != log_actions_.end();) {
    std::erase_if(at->second, [](const Action& action) { return action.kind == ActionKind::patient; });
    at = at->second.empty() ? log_actions_.erase(at) : std::next(at);
  }
}

void Session::start_over(Activity activity) {
  if (strict() && runner_ && runner_->live().started) return;
  activity_ = activity;
  if (holder_ == Holder::learner)
    learner_ = std::make_unique<MouseTracker>(loaded_case_->surroundings.start);
  else
    restart_tracker();
  shown_pose_.reset();
  newest_pose_.reset();
  begin_attempt();
}

void Session::practise() {
  if (strict()) return;
  activity_ = taken_in_ = Activity::practice;
  begin_attempt();
}

void Session::hold(Holder holder) {
  holder_ = holder;
  // The learner's hand has no buttons of its own, and does not know which buttons are held on the tracker.
  presses_ = holder == Holder::learner ? ButtonPresses(0) : ButtonPresses();
}

void Session::take_probe() {
  if (holder_ == Holder::learner || strict()) return;
  learner_ = std::make_unique<MouseTracker>(newest_pose_.value_or(loaded_case_->surroundings.start));
  const Activity taken_in = activity_;
  hold(Holder::learner);
  practise();
  taken_in_ = taken_in;
}

void Session::give_back_probe() {
  if (holder_ == Holder::tracker || only_learner_) return;
  restart_tracker();  // if it throws, the learner keeps the probe
  if (tracker_->relative()) left_place_.leave_at(learner_->pose());
  hold(Holder::tracker);
  if (activity_ == Activity::practice) activity_ = taken_in_;
  begin_attempt();
}

bool Session::looks_past_ct() const {
  if (!shown_pose_) return false;
  constexpr int kPoints = 8;
  int past = 0;
  for (int i = 0; i < kPoints; ++i) {
    const glm::dvec3 point = shown_pose_->point({0, machine_.depth_mm * (i + 0.5) / kPoints, 0});
    past += to_end_mm(loaded_case_->subject.ct.grid, point) < kEnd_mm / 2;
  }
  return past > kPoints / 4;
}

void Session::move_probe(const std::function<std::optional<Pose>(const ProbeHand&, const Pose&)>& motion) {
  take_probe();
  if (holder_ != Holder::learner) return;
  const Pose from = learner_->pose();
  follow(from, motion(hand_, from), Stop::at_edge);
}

void Session::turn_probe(double tilt_deg, double rotation_deg, double rock_deg) {
  take_probe();
  if (holder_ != Holder::learner) return;
  const Pose from = learner_->pose();
  follow(from, hand_.turn_on_skin(from, tilt_deg, rotation_deg, rock_deg), Stop::tilted);
}

/// Moves the learner's probe, or shows what has stopped it.
void Session::follow(const Pose& from, const std::optional<Pose>& to, Stop otherwise) {
  constexpr double kStopShown_s = 1.5;
  if (to) {
    push(*learner_, from, *to);
    if (stop_ == otherwise) stop_ = Stop::none;
  } else {
    stop_ = otherwise;
    stop_shown_until_s_ = now_s_ + kStopShown_s;
  }
}

void Session::act(const Action& action) {
  if (source().recording()) return;
  if (strict() && (action.kind == ActionKind::hint || action.kind == ActionKind::guide)) return;
  acts_.push_back(action);
}

void Session::set(const Action& action) {
  if (locks(action.kind)) return;
  const Machine before = shown_;
  shown_.apply(action, newest_pose_);
  if (shown_ == before) return;
  // The picture that the next sample freezes is that of the newest pose, not of an extrapolated one.
  if (shown_.frozen && !before.frozen) shown_pose_ = newest_pose_;
  if (source().recording()) return catch_up();
  // Freezing and unfreezing between two samples cancel out: the picture stays as it was at the previous sample.
  if (shown_.frozen != before.frozen && !acts_.empty() &&
      acts_.back().kind == (shown_.frozen ? ActionKind::unfreeze : ActionKind::freeze)) {
    acts_.pop_back();
    shown_.frozen_at = shown_.frozen ? machine_.frozen_at : std::nullopt;
    if (shown_.frozen) shown_pose_ = shown_.frozen_at;
    return;
  }
  if (!acts_.empty() && replaces(action, acts_.back())) acts_.pop_back();
  acts_.push_back(action);
}

std::optional<Pose> Session::frozen_picture() const {
  if (!shown_.frozen) return std::nullopt;
  return source().recording() ? shown_pose_ : machine_.frozen_at;
}

bool Session::locks(ActionKind setting) const {
  if (setting == ActionKind::effect) return activity_ == Activity::exam;
  return strict() && runner_ && !result_ && runner_->scenario().locked.contains(lock_of(setting));
}

std::string Session::why_not(ActionKind setting) const {
  if (setting == ActionKind::effect && locks(setting)) return "Effects are for practice, without steps and score.";
  if (locks(setting)) return "This exam keeps " + name_of(setting) + " as it is.";
  if (shown_.refuses(setting)) return "Frozen: press Space to scan on, then change " + name_of(setting) + ".";
  return "";
}

std::vector<Action> Session::actions_before(const ProbeSample& sample) {
  if (source().recording()) {
    const auto found = log_actions_.find(sample.time_s);
    return found == log_actions_.end() ? std::vector<Action>() : found->second;
  }
  return std::exchange(acts_, {});
}

/// Shows what an action of the log does. The viewer may have frozen the picture, which the log does not contain.
void Session::show_of_log(const Action& action) {
  if (shown_.refuses(action.kind) && !machine_.refuses(action.kind))
    held_back_.push_back(action);
  else if (!machine_.refuses(action.kind))
    shown_.apply(action, newest_pose_);
  catch_up();
}

/// Follows the log's settings again once the picture is no longer frozen.
void Session::catch_up() {
  if (shown_.frozen) return;
  for (const Action& action : std::exchange(held_back_, {})) shown_.apply(action, newest_pose_);
}

void Session::take(const ProbeSample& sample) {
  const bool was_frozen = shown_.frozen;
  const std::uint32_t pressed = presses_.see(sample);
  // A log with actions itself contains when the picture was frozen.
  if ((pressed & kFreezeButton) && log_actions_.empty()) freeze(!shown_.frozen);
  if (pressed & kEventMarkerButton) event_markers_s_.push_back(attempt_for_s());
  if (pressed & kContinueButton) go_on_ = true;
  const std::vector<Action> actions = actions_before(sample);
  for (const Action& action : actions) {
    if (source().recording()) show_of_log(action);
    machine_.apply(action, newest_pose_);
  }
  if (shown_.frozen && !was_frozen) shown_pose_ = newest_pose_;
  if (!actions.empty()) latest_actions_[sample.time_s] = actions;
  if (runner_ && !result_) {
    runner_->feed(sample, actions);
    exam_samples_.push_back(sample);
    if (!actions.empty()) actions_[sample.time_s] = actions;
    machine_ = runner_->machine();
  }
  // Measurements belong to the sampled pose, not to the predicted one.
  if (shown_.frozen && machine_.frozen_at) shown_pose_ = shown_.frozen_at = machine_.frozen_at;
  if (sample.status != PoseStatus::ok) return;
  newest_pose_ = sample.patient_from_probe;
  last_usable_s_ = now_s_;
}

void Session::find_pose() {
  pose_estimate_.reset();
  std::optional<Pose> pose = newest_pose_;
  if (source().live()) {
    for (const ProbeSample& sample : samples_) history_.add(sample);
    pose_estimate_ = history_.at(source().clock_s(now_s_), predict_s_);
    if (pose_estimate_->how != PoseAnswer::none) pose = pose_estimate_->patient_from_probe;
  }
  if (!shown_.frozen) shown_pose_ = pose;
}

void Session::advance(double now_s) {
  now_s_ = now_s;
  // A session that is created while the clock runs has not lost the tracker yet.
  if (!std::exchange(advanced_, true)) last_usable_s_ = attempt_began_s_ = now_s;
  samples_.clear();
  latest_actions_.clear();
  if (holder_ == Holder::learner && tracker_ && tracker_->live()) {
    tracker_->poll(now_s, samples_);
    samples_.clear();
  }
  source().poll(now_s, samples_);
  if (holder_ == Holder::tracker) left_place_.move(samples_);
  // A sample without button data could not report their release.
  const auto pressing = std::find_if(samples_.begin(), samples_.end(),
                                     [](const ProbeSample& sample) { return reports_buttons(sample.status); });
  if (pressing != samples_.end()) pressing->buttons |= std::exchange(pressed_, 0);
  if (!samples_.empty()) samples_begin_attempt_ = std::exchange(attempt_is_fresh_, false);
  for (const ProbeSample& sample : samples_) take(sample);
  find_pose();

  if (runner_ && source().state().condition == TrackerCondition::finished) runner_->end();
  keep_result();
}

void Session::hand_in() {
  if (runner_) runner_->end();
  keep_result();
}

void Session::keep_result() {
  if (!runner_ || result_ || !runner_->live().finished) return;
  result_ = runner_->result();
  result_->provenance.mode = strict() ? AttemptMode::exam : AttemptMode::practice;
  if (const Recording* recording = source().recording()) {
    result_->provenance.mode = AttemptMode::recording;
    result_->provenance.log = recording->file;
    result_->provenance.log_digest = recording->digest;
    result_->provenance.log_transform = recording->transform;
  }
}

std::optional<double> Session::lost_for_s() const {
  if (source().state().condition == TrackerCondition::finished) return std::nullopt;
  const double lost_s = now_s_ - last_usable_s_;
  return lost_s > kStale_s ? std::optional(lost_s) : std::nullopt;
}

}  // namespace insonate
