#include "app/session.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <utility>

#include "devices/live/probe_buttons.h"
#include "devices/replay/read_log.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

/// The motion from one pose to another as MouseTracker takes it: in the probe's own frame.
void push(MouseTracker& mouse, const Pose& from, const Pose& to) {
  const Pose step = from.inverse() * to;
  const glm::dquat turn = glm::normalize(glm::quat_cast(step.rotation));
  const double angle = glm::angle(turn);
  mouse.move(step.translation, angle > 1e-12 ? angle * glm::axis(turn) : glm::dvec3(0.0));
}

Machine machine_of(const Console& console) {
  Machine machine;
  machine.probe = console.probe.name;
  machine.depth_mm = console.depth_mm;
  machine.frequency_mhz = console.frequency_mhz;
  machine.gain_db = console.gain_db;
  machine.frozen = console.frozen;
  return machine;
}

void set_console(Console& console, const Machine& machine) {
  if (const Probe* probe = find_probe(machine.probe)) console.probe = *probe;
  console.depth_mm = std::clamp(machine.depth_mm, Console::kLeastDepth_mm, Console::kMostDepth_mm);
  console.frequency_mhz = machine.frequency_mhz;
  console.gain_db = machine.gain_db;
  console.frozen = machine.frozen;
}

/// What the learner has set on the console since the machine was as it is.
std::vector<Action> settings_since(const Machine& before, const Console& console) {
  std::vector<Action> actions;
  Machine machine = before;
  const auto set = [&](ActionKind kind, double value) { actions.push_back({kind, {value}}); };
  if (machine.probe != console.probe.name) {
    actions.push_back({ActionKind::probe, {}, console.probe.name});
    machine.choose(console.probe.name);
  }
  if (machine.depth_mm != console.depth_mm) set(ActionKind::depth, console.depth_mm);
  if (machine.frequency_mhz != console.frequency_mhz) set(ActionKind::frequency, console.frequency_mhz);
  if (machine.gain_db != console.gain_db) set(ActionKind::gain, console.gain_db);
  if (machine.frozen != console.frozen) actions.push_back({console.frozen ? ActionKind::freeze : ActionKind::unfreeze});
  return actions;
}

}  // namespace

void Console::choose(const Probe& chosen) {
  probe = chosen;
  depth_mm = chosen.depth_mm;
  frequency_mhz = chosen.frequency_mhz;
}

Settings Console::settings() const {
  Settings settings = trainer_settings(frequency_mhz, depth_mm);
  settings.gain_db = gain_db;
  settings.dynamic_range_db = dynamic_range_db;
  for (std::size_t i = 0; i < tgc_db.size(); ++i) settings.tgc_db[i] += tgc_db[i];
  return settings;
}

bool Console::operator==(const Console& other) const {
  return probe.name == other.probe.name && depth_mm == other.depth_mm && frequency_mhz == other.frequency_mhz &&
         gain_db == other.gain_db && dynamic_range_db == other.dynamic_range_db && tgc_db == other.tgc_db &&
         frozen == other.frozen;
}

void check_source(const Tracker& tracker, bool exam) {
  if (exam && tracker.repeats())
    throw InputError(tracker.state().name, "option 'loop'", "an exam is scored from a log that comes once",
                     "leave loop=1 out, or practise on a patient of your own, without a scenario");
  if (tracker.recording()) check_is_of_probe(*tracker.recording());
  if (exam && tracker.recording()) check_has_times(*tracker.recording());
}

Session::Session(std::shared_ptr<const Study> study, OpenTracker open, double predict_s, ExamRules rules)
    : study_(std::move(study)),
      open_(std::move(open)),
      predict_s_(predict_s),
      rules_(rules),
      hand_(study_->subject.ct) {
  tracker_ = open_fresh();
  only_learner_ = dynamic_cast<MouseTracker*>(tracker_.get()) != nullptr;
  if (only_learner_) {
    learner_.reset(static_cast<MouseTracker*>(tracker_.release()));
    holder_ = Holder::learner;
  }
  console_.choose(probes().front());
  if (study_->scenario) {
    set_console(console_, starting_machine(*study_->scenario, study_->subject));
    activity_ = Activity::exam;
  }
  begin_attempt();
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
  check_source(*tracker, study_->scenario.has_value());
  return tracker;
}

void Session::restart_tracker() {
  if (tracker_->live()) return;  // a device has no beginning, and opened twice it would be busy
  tracker_ = open_fresh();
}

void Session::begin_attempt() {
  ++attempt_;
  runner_.reset();
  exam_samples_.clear();
  result_.reset();
  if (activity_ == Activity::exam && study_->scenario)
    runner_ = std::make_unique<Runner>(*study_->scenario, study_->subject, study_->tissues);
  last_usable_s_ = attempt_began_s_ = now_s_;
  marks_s_.clear();
  history_.clear();
  console_.frozen = false;
  acts_.clear();
  actions_.clear();
  latest_actions_.clear();
  at_start_ = console_;
  machine_ = acted_ = runner_ ? runner_->machine() : Machine();
  attempt_is_fresh_ = true;
  log_actions_.clear();
  if (const Recording* recording = source().recording())
    log_actions_ = parse_action_log(recording->actions, recording->file);
}

void Session::start_over() {
  if (strict() && runner_ && runner_->live().started) return;
  activity_ = study_->scenario ? Activity::exam : Activity::practice;
  if (holder_ == Holder::learner)
    learner_ = std::make_unique<MouseTracker>(study_->surroundings.start);
  else
    restart_tracker();
  shown_pose_.reset();
  newest_pose_.reset();
  begin_attempt();
}

void Session::practise() {
  if (strict()) return;
  activity_ = Activity::practice;
  begin_attempt();
}

void Session::hold(Holder holder) {
  holder_ = holder;
  // The learner's hand has no buttons of its own, and knows nothing of those that are held on the tracker.
  presses_ = holder == Holder::learner ? ButtonPresses(0) : ButtonPresses();
}

void Session::take_probe() {
  if (holder_ == Holder::learner || strict()) return;
  learner_ = std::make_unique<MouseTracker>(newest_pose_.value_or(study_->surroundings.start));
  hold(Holder::learner);
  practise();
}

void Session::give_back_probe() {
  if (holder_ == Holder::tracker || only_learner_) return;
  restart_tracker();  // may throw: then the learner keeps the probe
  if (tracker_->relative()) left_place_.leave_at(learner_->pose());
  hold(Holder::tracker);
  if (study_->scenario) activity_ = Activity::exam;
  begin_attempt();
}

void Session::move_probe(const std::function<Pose(const ProbeHand&, const Pose&)>& motion) {
  take_probe();
  if (holder_ != Holder::learner) return;
  const Pose from = learner_->pose();
  push(*learner_, from, motion(hand_, from));
}

void Session::act(const Action& action) {
  if (source().recording()) return;
  if (strict() && action.kind == ActionKind::hint) return;
  note_settings();
  acts_.push_back(action);
}

std::vector<Action> Session::settings() const {
  return settings_since(Machine(), console_);
}

std::optional<Pose> Session::frozen_picture() const {
  if (!console_.frozen) return std::nullopt;
  return source().recording() ? shown_pose_ : machine_.frozen_at;
}

bool Session::locks(ActionKind setting) const {
  return strict() && runner_ && !result_ && runner_->scenario().locked.contains(setting);
}

/// Whoever sets the console need not know what is locked.
void Session::undo_locked() {
  if (locks(ActionKind::probe)) console_.probe = *find_probe(acted_.probe);
  if (locks(ActionKind::depth)) console_.depth_mm = acted_.depth_mm;
  if (locks(ActionKind::frequency)) console_.frequency_mhz = acted_.frequency_mhz;
  if (locks(ActionKind::gain)) {
    console_.gain_db = acted_.gain_db;
    console_.tgc_db = at_start_.tgc_db;
    console_.dynamic_range_db = at_start_.dynamic_range_db;
  }
}

/// What is on the console comes before what is done next.
void Session::note_settings() {
  undo_locked();
  for (Action& setting : settings_since(acted_, console_)) {
    acted_.apply(setting, newest_pose_);
    acts_.push_back(std::move(setting));
  }
}

std::vector<Action> Session::actions_before(const PoseSample& sample) {
  if (source().recording()) {
    const auto found = log_actions_.find(sample.time_s);
    return found == log_actions_.end() ? std::vector<Action>() : found->second;
  }
  note_settings();
  return std::exchange(acts_, {});
}

void Session::take(const PoseSample& sample) {
  const bool was_frozen = console_.frozen;
  const std::uint32_t pressed = presses_.see(sample);
  // A log with actions tells itself when the picture froze.
  if ((pressed & kFreezeButton) && log_actions_.empty()) console_.frozen = !console_.frozen;
  if (pressed & kMarkButton) marks_s_.push_back(attempt_for_s());
  if (pressed & kGoOnButton) go_on_ = true;
  const std::vector<Action> actions = actions_before(sample);
  if (source().recording() && !actions.empty()) {
    Machine machine = machine_of(console_);
    for (const Action& action : actions) machine.apply(action, newest_pose_);
    set_console(console_, machine);
  }
  if (console_.frozen && !was_frozen) shown_pose_ = newest_pose_;
  for (const Action& action : actions) machine_.apply(action, newest_pose_);
  if (!actions.empty()) latest_actions_[sample.time_s] = actions;
  if (runner_ && !result_) {
    runner_->feed(sample, actions);
    exam_samples_.push_back(sample);
    if (!actions.empty()) actions_[sample.time_s] = actions;
    machine_ = runner_->machine();
  }
  // What is measured in is what was sampled, not what was predicted of it.
  if (console_.frozen && machine_.frozen_at) shown_pose_ = machine_.frozen_at;
  if (sample.status != PoseStatus::ok) return;
  newest_pose_ = sample.patient_from_probe;
  last_usable_s_ = now_s_;
}

void Session::find_pose() {
  answer_.reset();
  std::optional<Pose> pose = newest_pose_;
  if (source().live()) {
    for (const PoseSample& sample : samples_) history_.add(sample);
    answer_ = history_.at(source().clock_s(now_s_), predict_s_);
    if (answer_->how != PoseAnswer::none) pose = answer_->patient_from_probe;
  }
  if (!console_.frozen) shown_pose_ = pose;
}

void Session::advance(double now_s) {
  now_s_ = now_s;
  // A session that is made while the clock runs has not lost anything yet.
  if (!std::exchange(advanced_, true)) last_usable_s_ = attempt_began_s_ = now_s;
  samples_.clear();
  latest_actions_.clear();
  undo_locked();
  if (holder_ == Holder::learner && tracker_ && tracker_->live()) {
    tracker_->poll(now_s, samples_);
    samples_.clear();
  }
  source().poll(now_s, samples_);
  if (holder_ == Holder::tracker) left_place_.move(samples_);
  // One that does not tell of buttons would not tell that they are let go again.
  const auto pressing = std::find_if(samples_.begin(), samples_.end(), tells_of_buttons);
  if (pressing != samples_.end()) pressing->buttons |= std::exchange(pressed_, 0);
  if (!samples_.empty()) samples_begin_attempt_ = std::exchange(attempt_is_fresh_, false);
  for (const PoseSample& sample : samples_) take(sample);
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
