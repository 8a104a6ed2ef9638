#include "scenarios/runner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scenarios/case_digest.h"
#include "scenarios/criterion_score.h"
#include "scenarios/words.h"

namespace insonate {
namespace {

constexpr double kTraceStep_s = 0.1;

constexpr char kNothingValid[] = "there was no valid pose to judge.";

CriterionScore score_motion(const Criterion& criterion, const MotionValues& motion, bool task_done) {
  CriterionScore m = score_criterion(criterion, motion.of(criterion.metric), kNothingValid);
  if (info(criterion.metric).economy && !task_done && m.value) {
    m.points = 0;
    m.why = in_words(criterion.metric, *m.value) + ": nothing, because the task was not done.";
  }
  return m;
}

bool usable(const ProbeSample& sample) {
  if (sample.status != PoseStatus::ok) return true;
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) sum += sample.patient_from_probe.rotation[c][r];
  for (int r = 0; r < 3; ++r) sum += sample.patient_from_probe.translation[r];
  return std::isfinite(sum);
}

}  // namespace

Runner::Runner(Scenario scenario, const Case& subject, const TissueTable& tissues)
    : scenario_(std::move(scenario)), subject_(subject), tissues_(tissues), labels_(subject) {
  check_against_case(scenario_, subject);
  case_digest_ = digest_of(subject);
  machine_ = starting_machine(scenario_, subject);
  for (const Step& step : scenario_.steps) {
    const ReferenceView* view = subject.find_view(step.view);
    meters_.push_back(view ? std::make_unique<ViewMeter>(subject, *view, tissues) : nullptr);
    begin_.push_back(step.task->prepare({step, subject_, labels_, tissues_, meters_.back().get()}));
  }
  ended_.resize(scenario_.steps.size());
  left_.resize(scenario_.steps.size());
  hints_taken_.resize(scenario_.steps.size());
  live_.step_remaining_s = scenario_.steps.front().time_limit_s;
  live_.exam_remaining_s = scenario_.time_limit_s;
}

void Runner::feed(std::span<const ProbeSample> samples, const ActionLog& actions) {
  for (const ProbeSample& sample : samples) {
    const auto before = actions.find(sample.time_s);
    feed(sample, before == actions.end() ? std::span<const Action>() : before->second);
  }
}

void Runner::feed(const ProbeSample& sample, std::span<const Action> before) {
  if (live_.finished) return;
  waiting_.insert(waiting_.end(), before.begin(), before.end());
  if (!std::isfinite(sample.time_s) || !usable(sample)) return;
  if (!live_.started) {
    live_.started = true;
    first_s_ = sample.time_s;
    begin_step(0, 0);
  } else if (sample.time_s - first_s_ <= last_s_) {
    return;
  }
  double now = sample.time_s - first_s_;
  pass_limits(now);
  if (live_.finished) return;
  now = std::max(now, step_start_s_);  // a step may have begun at a limit that is later by a rounding error
  last_s_ = now;
  for (const Action& action : std::exchange(waiting_, {}))
    if (!live_.finished) act(action, now);
  if (!live_.finished) evaluate(sample, now);
}

void Runner::end() {
  if (live_.finished || !live_.started) return;
  end_step(run_->counts_as_done() ? StepOutcome::done : StepOutcome::scan_ended, last_s_, Then::finish);
}

/// Ends all steps, and the exam, whose limits `now` has reached.
void Runner::pass_limits(double now) {
  while (!live_.finished) {
    const double limit = std::min(step_limit_s(), exam_limit_s());
    if (now < limit - kTimeRounding_s) return;
    end_step(run_->counts_as_done() ? StepOutcome::done : StepOutcome::timed_out, limit,
             exam_limit_s() <= limit ? Then::finish : Then::go_on);
  }
}

void Runner::act(const Action& given, double now) {
  Action action = given;
  if (action.text.size() > Action::kLongestText) action.text.resize(Action::kLongestText);  // as a log stores it
  machine_.apply(action, last_valid_);
  if (action.kind == ActionKind::go_on)
    return end_step(run_->counts_as_done() ? StepOutcome::done : StepOutcome::went_on, now);
  if (action.kind == ActionKind::go_to) return go_to(action.text, now);
  if (action.kind == ActionKind::hint && live_.hints_left > 0) {
    live_.hints.push_back(step().hints[hints_taken_[live_.step]++].text);
    --live_.hints_left;
  }
  if (action.kind == ActionKind::guide) {
    hide_guide(now);
    guided_ = action.numbers[0] != 0;
    if (guided_) show_guide(now);
  }
  run_->act(action, {now, last_valid_.has_value(), last_valid_.value_or(Pose{}), nullptr, machine_});
  if (run_->done()) end_step(StepOutcome::done, now);
}

void Runner::evaluate(const ProbeSample& raw, double now) {
  ProbeSample sample = raw;
  sample.time_s = now;
  const bool valid = sample.status == PoseStatus::ok;
  live_.tracking = sample.status;
  live_.elapsed_s = now;
  live_.on_skin = valid && contact().at(sample.patient_from_probe);
  motion_.feed(sample, live_.on_skin);
  step_motion_.feed(sample, live_.on_skin);
  if (valid) last_valid_ = sample.patient_from_probe;

  if (!valid || !looked_s_ || now - *looked_s_ >= kLook_s - kTimeRounding_s) {
    show(sample, now);
    record(sample, now);
    if (run_->done()) {
      end_step(step().task->holds_view() ? StepOutcome::held : StepOutcome::done, now);
      if (!live_.finished) show(sample, now);
    }
  }
  live_.step_remaining_s = std::max(0.0, step_limit_s() - now);
  live_.exam_remaining_s = counts_from_s_ ? std::max(0.0, exam_limit_s() - now) : scenario_.time_limit_s;
}

/// Measures the picture of a sample and passes it to the current step.
void Runner::show(const ProbeSample& sample, double now) {
  const bool valid = sample.status == PoseStatus::ok;
  const ViewMeter* meter = meters_[live_.step].get();
  looked_s_ = valid ? std::optional(now) : std::nullopt;
  live_.view.reset();
  if (valid && meter) live_.view = meter->measure(sample.patient_from_probe, machine_.depth_mm);
  run_->see({now, valid, sample.patient_from_probe, live_.view ? &*live_.view : nullptr, machine_});
  live_.within_tolerance = run_->on_target();
  live_.lacks = run_->lacks();
  live_.hold_share = run_->share_done();
  live_.counts_as_done = run_->counts_as_done();
}

/// Returns the contact of the probe of the step's view, or else of the learner's probe.
const SkinContact& Runner::contact() {
  const ReferenceView* view = subject_.find_view(step().view);
  const std::string& probe = view ? view->probe : machine_.probe;
  return contacts_.try_emplace(probe, subject_.ct, *find_probe(probe)).first->second;
}

double Runner::exam_limit_s() const {
  return counts_from_s_ ? *counts_from_s_ + scenario_.time_limit_s : std::numeric_limits<double>::infinity();
}

void Runner::begin_step(std::size_t index, double now) {
  live_.step = index;
  step_start_s_ = now;
  if (!left_[index].began_s) left_[index].began_s = now;
  step_motion_ = step_motion_.following(now);
  looked_s_.reset();
  const Step& asked = step();
  if (asked.counts && !counts_from_s_) {
    counts_from_s_ = now;
    if (now > 0) motion_ = motion_.following(now);
  }
  run_ = begin_[index](now);
  live_.hold_share = 0;
  live_.within_tolerance = false;
  live_.lacks.clear();
  live_.counts_as_done = run_->counts_as_done();
  live_.hints.clear();
  for (std::size_t i = 0; i < hints_taken_[index]; ++i) live_.hints.push_back(asked.hints[i].text);
  live_.hints_left = asked.hints.size() - hints_taken_[index];
  if (guided_) show_guide(now);
}

bool Runner::can_go_to(std::size_t index) const {
  const Step& other = scenario_.steps[index];
  return scenario_.order == Scenario::Order::free && !live_.finished && index != live_.step && !other.name.empty() &&
         !ended_[index] && other.counts == step().counts;
}

void Runner::go_to(const std::string& name, double now) {
  for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
    if (scenario_.steps[i].name != name || !can_go_to(i)) continue;
    step_motion_.end(now);
    left_[live_.step].motion += step_motion_.values();
    hide_guide(now);
    return begin_step(i, now);
  }
}

/// Begins to count the time for which the guide is shown, if the step asks for a view that it can lead to.
void Runner::show_guide(double now) {
  if (!meters_[live_.step]) return;
  guided_from_s_ = now;
  ++left_[live_.step].guide_times;
}

void Runner::hide_guide(double now) {
  if (guided_from_s_) left_[live_.step].guide_s += now - *guided_from_s_;
  guided_from_s_.reset();
}

void Runner::skip(std::size_t from, std::size_t to, double now) {
  for (std::size_t i = from; i < to; ++i) {
    StepResult skipped;
    skipped.title = scenario_.steps[i].title;
    skipped.kind = scenario_.steps[i].kind;
    skipped.counts = scenario_.steps[i].counts;
    skipped.view = scenario_.steps[i].view;
    skipped.outcome = StepOutcome::skipped;
    skipped.start_s = skipped.end_s = now;
    ended_[i] = std::move(skipped);
  }
}

/// Returns the step that follows the one that has just ended, or nothing if the exam is over.
std::optional<std::size_t> Runner::step_after(const StepResult& ended, double now) {
  double possible = 0;
  for (const CriterionScore& m : ended.criteria) possible += m.weight;
  const bool good = possible > 0 ? ended.earned() >= possible / 2 : is_done(ended.outcome);
  const std::string& next = good ? step().if_good : step().if_poor;
  const std::size_t after = live_.step + 1, end = scenario_.steps.size();
  if (!next.empty()) {
    std::size_t goal = after;
    while (goal < end && scenario_.steps[goal].name != next) ++goal;
    skip(after, goal, now);
    return goal < end ? std::optional(goal) : std::nullopt;
  }
  for (std::size_t i = 0; i < end; ++i)
    if (!ended_[i]) return i;
  return std::nullopt;
}

void Runner::end_step(StepOutcome outcome, double now, Then then) {
  step_motion_.end(now);
  hide_guide(now);
  const StepResult& ended = ended_[live_.step].emplace(judge(outcome, now));
  if (ended.counts) {
    for (const CriterionScore& m : ended.criteria) {
      live_.points += m.points;
      live_.points_possible += m.weight;
    }
    live_.points -= ended.lost_to_hints();
  }
  for (const auto& [what, fact] : ended.facts)
    if (what == StepResult::kMeasured) live_.measured.push_back(fact + " in '" + ended.title + "'");
  const auto next = then == Then::go_on ? step_after(ended, now) : std::nullopt;
  if (next)
    begin_step(*next, now);
  else
    finish(now);
}

void Runner::finish(double now) {
  if (live_.finished) return;
  motion_.end(now);
  live_.finished = true;
  live_.elapsed_s = now;
}

StepResult Runner::judge(StepOutcome outcome, double now) const {
  const Step& asked = step();
  StepResult result;
  result.title = asked.title;
  result.kind = asked.kind;
  result.holds_view = asked.task->holds_view();
  result.counts = asked.counts;
  result.view = asked.view;
  result.outcome = outcome;
  result.guide_times = left_[live_.step].guide_times;
  result.guide_s = left_[live_.step].guide_s;
  result.hints_taken = int(hints_taken_[live_.step]);
  for (std::size_t i = 0; i < hints_taken_[live_.step]; ++i) result.hint_cost += asked.hints[i].cost;
  result.start_s = *left_[live_.step].began_s;
  result.end_s = now;
  result.motion = left_[live_.step].motion;
  result.motion += step_motion_.values();
  run_->finish(outcome, now, result);

  for (const Criterion& criterion : asked.criteria) {
    const MetricScope scope = info(criterion.metric).scope;
    if (scope == MetricScope::motion) {
      result.criteria.push_back(score_motion(criterion, result.motion, is_done(outcome)));
      continue;
    }
    std::optional<double> value = result.value(criterion.metric);
    if (scope == MetricScope::picture && result.judged) value = result.judged->of(criterion.metric);
    result.criteria.push_back(score_criterion(criterion, value, run_->why_no_value()));
  }
  return result;
}

ExamResult Runner::result() const {
  ExamResult result;
  result.title = scenario_.title;
  result.briefing = scenario_.briefing;
  result.provenance.scenario = scenario_.file.filename().string();
  result.provenance.scenario_digest = scenario_.digest;
  result.provenance.phantom_options = scenario_.phantom_options;
  result.provenance.case_name = subject_.name;
  result.provenance.case_digest = case_digest_;
  result.provenance.seed = scenario_.seed;
  result.provenance.variant = scenario_.variant;
  result.provenance.program_version = INSONATE_VERSION;
  result.provenance.scoring_version = ExamResult::kScoringVersion;
  result.pass_mark_percent = scenario_.pass_mark_percent;
  result.complete = live_.finished;
  result.motion = motion_.values();
  for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
    if (ended_[i]) {
      result.steps.push_back(*ended_[i]);
      continue;
    }
    StepResult missed;
    missed.title = scenario_.steps[i].title;
    missed.kind = scenario_.steps[i].kind;
    missed.holds_view = scenario_.steps[i].task->holds_view();
    missed.counts = scenario_.steps[i].counts;
    missed.view = scenario_.steps[i].view;
    missed.start_s = missed.end_s = last_s_;
    for (const Criterion& criterion : scenario_.steps[i].criteria)
      missed.criteria.push_back(score_criterion(criterion, std::nullopt, "the step was not reached."));
    result.steps.push_back(std::move(missed));
  }
  const bool all_done = std::all_of(result.steps.begin(), result.steps.end(), [](const StepResult& s) {
    return !s.counts || s.outcome == StepOutcome::skipped || is_done(s.outcome);
  });
  for (const Criterion& criterion : scenario_.criteria)
    result.criteria.push_back(score_motion(criterion, result.motion, all_done));
  decide(result);
  return result;
}

void Runner::record(const ProbeSample& sample, double now) {
  if (!trace_.empty() && now - trace_.back().time_s < kTraceStep_s && trace_.back().step == live_.step) return;
  TracePoint point;
  point.time_s = now;
  point.step = live_.step;
  point.valid = sample.status == PoseStatus::ok;
  point.on_skin = live_.on_skin;
  point.within_tolerance = live_.within_tolerance;
  point.speed_mm_s = step_motion_.speed_mm_s();
  point.face = sample.patient_from_probe.translation;
  if (live_.view) point.view = *live_.view;
  trace_.push_back(point);
}

}  // namespace insonate
