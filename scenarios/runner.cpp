#include "scenarios/runner.h"

#include <algorithm>
#include <cmath>

#include "scenarios/case_digest.h"
#include "scenarios/marking.h"
#include "scenarios/words.h"

namespace insonate {
namespace {

constexpr double kTraceStep_s = 0.1;

constexpr char kNothingValid[] = "there was no valid pose to judge.";

Mark mark_motion(const Criterion& criterion, const MotionValues& motion, bool task_done) {
  Mark m = mark(criterion, motion.of(criterion.metric), kNothingValid);
  if (info(criterion.metric).economy && !task_done && m.value) {
    m.points = 0;
    m.why = in_words(criterion.metric, *m.value) + ": nothing, because the task was not done.";
  }
  return m;
}

bool usable(const PoseSample& sample) {
  if (sample.status != PoseStatus::ok) return true;
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) sum += sample.patient_from_probe.rotation[c][r];
  for (int r = 0; r < 3; ++r) sum += sample.patient_from_probe.translation[r];
  return std::isfinite(sum);
}

ViewValues all_zero() {
  ViewValues values;
  values.off_centre_percent = 0;
  return values;
}

/// Adds a picture's values, without their signs, times a weight.
void add(ViewValues& sum, const ViewValues& view, double weight) {
  for (const auto& [metric, value] : ViewValues::fields()) sum.*value += weight * std::abs(view.*value);
}

}  // namespace

Runner::Runner(Scenario scenario, const Case& subject, const TissueTable& tissues)
    : scenario_(std::move(scenario)), case_name_(subject.name) {
  check_against_case(scenario_, subject);
  case_digest_ = digest_of(subject);
  for (const Step& step : scenario_.steps) {
    const ReferenceView& view = *subject.find_view(step.view);
    meters_.push_back(std::make_unique<ViewMeter>(subject, view, tissues));
    contacts_.emplace_back(subject.ct, *find_probe(view.probe));
  }
  live_.step_remaining_s = scenario_.steps.front().time_limit_s;
  live_.exam_remaining_s = scenario_.time_limit_s;
}

void Runner::feed(std::span<const PoseSample> samples) {
  for (const PoseSample& sample : samples) feed(sample);
}

void Runner::feed(const PoseSample& sample) {
  if (live_.finished || !std::isfinite(sample.time_s) || !usable(sample)) return;
  if (!live_.started) {
    live_.started = true;
    first_s_ = sample.time_s;
    begin_step(0);
  } else if (sample.time_s - first_s_ <= last_s_) {
    return;
  }
  double now = sample.time_s - first_s_;
  pass_limits(now);
  if (live_.finished) return;
  now = std::max(now, run_.start_s);  // a step may have begun at a limit that lies a rounding later
  last_s_ = now;
  look(sample, now);
}

void Runner::end() {
  if (live_.finished || !live_.started) return;
  end_step(StepOutcome::scan_ended, last_s_);
  finish(last_s_);
}

/// Ends whatever had to end by `now`.
void Runner::pass_limits(double now) {
  while (!live_.finished) {
    const double step_limit = run_.start_s + step().time_limit_s;
    const double limit = std::min(step_limit, scenario_.time_limit_s);
    if (now < limit - kTimeRounding_s) return;
    end_step(StepOutcome::timed_out, limit);
    if (scenario_.time_limit_s <= limit) finish(limit);
  }
}

void Runner::look(const PoseSample& raw, double now) {
  PoseSample sample = raw;
  sample.time_s = now;
  const bool valid = sample.status == PoseStatus::ok;
  live_.tracking = sample.status;
  live_.elapsed_s = now;
  live_.on_skin = valid && contacts_[live_.step].at(sample.patient_from_probe);
  live_.within_tolerance = false;
  live_.view.reset();
  motion_.feed(sample, live_.on_skin);
  run_.motion.feed(sample, live_.on_skin);

  if (valid) see(sample.patient_from_probe, now);
  const bool held = update_hold(valid, now);
  record(sample, now);
  if (held) {
    end_step(StepOutcome::held, now);
    if (!live_.finished) {
      see(sample.patient_from_probe, now);
      update_hold(true, now);
    }
  }
  live_.step_remaining_s = std::max(0.0, run_.start_s + step().time_limit_s - now);
  live_.exam_remaining_s = std::max(0.0, scenario_.time_limit_s - now);
}

/// Measures the picture of a valid sample and keeps it as long as it may be judged.
void Runner::see(const Pose& patient_from_probe, double now) {
  const bool bridged = !run_.recent.empty() && MotionMeter::bridges(now - run_.recent.back().time_s);
  if (!bridged) run_.holding_from.reset();
  live_.view = meters_[live_.step]->measure(patient_from_probe);
  live_.within_tolerance = within_tolerance(*live_.view);
  run_.recent.push_back({now, *live_.view});
  while (run_.recent.front().time_s < now - step().hold_s - MotionMeter::kBridged_s) run_.recent.pop_front();
}

/// Whether the view has now been held for as long as the step asks.
bool Runner::update_hold(bool valid, double now) {
  const bool lost = run_.recent.empty() || !MotionMeter::bridges(now - run_.recent.back().time_s);
  if (lost || (valid && !live_.within_tolerance))
    run_.holding_from.reset();
  else if (valid && !run_.holding_from)
    run_.holding_from = now;

  const double holding_s = run_.holding_from ? now - *run_.holding_from : 0;
  const bool held = valid && holding_s >= step().hold_s - kTimeRounding_s;
  if (valid) run_.longest_hold_s = std::max(run_.longest_hold_s, held ? step().hold_s : holding_s);
  live_.hold_share = std::min(1.0, holding_s / step().hold_s);
  return held;
}

bool Runner::within_tolerance(const ViewValues& view) const {
  return std::all_of(step().tolerance.begin(), step().tolerance.end(), [&](const Tolerance& t) {
    const double value = view.of(t.metric);
    return info(t.metric).less_is_better ? value <= t.limit : value >= t.limit;
  });
}

void Runner::begin_step(double now) {
  StepRun next;
  next.start_s = now;
  next.motion = run_.motion.following(now);
  run_ = std::move(next);
  live_.hold_share = 0;
}

void Runner::end_step(StepOutcome outcome, double now) {
  run_.motion.end(now);
  done_.push_back(judge(outcome, now));
  for (const Mark& m : done_.back().marks) {
    live_.points += m.points;
    live_.points_possible += m.weight;
  }
  if (done_.size() == scenario_.steps.size()) {
    finish(now);
  } else {
    live_.step = done_.size();
    begin_step(now);
  }
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
  result.view = asked.view;
  result.outcome = outcome;
  result.start_s = run_.start_s;
  result.end_s = now;
  result.longest_hold_s = run_.longest_hold_s;
  result.motion = run_.motion.values();

  if (!run_.recent.empty()) {
    const double to = run_.recent.back().time_s;
    const double from = outcome == StepOutcome::held ? *run_.holding_from : to - asked.hold_s;
    ViewValues integral = all_zero(), mean = all_zero();
    double weight = 0;
    const Seen* before = nullptr;
    for (const Seen& seen : run_.recent) {
      if (seen.time_s < from - kTimeRounding_s) continue;
      if (!result.judged_from_s) result.judged_from_s = seen.time_s;
      if (before && MotionMeter::bridges(seen.time_s - before->time_s)) {
        const double dt = seen.time_s - before->time_s;
        add(integral, before->view, dt / 2);
        add(integral, seen.view, dt / 2);
        weight += dt;
      }
      before = &seen;
    }
    result.judged_to_s = to;
    if (weight > 0)
      add(mean, integral, 1 / weight);
    else
      add(mean, run_.recent.back().view, 1);
    result.judged = mean;
  }

  for (const Criterion& criterion : asked.criteria) {
    std::optional<double> value;
    if (info(criterion.metric).scope == MetricScope::motion) {
      result.marks.push_back(mark_motion(criterion, result.motion, outcome == StepOutcome::held));
      continue;
    }
    if (criterion.metric == Metric::longest_hold_s)
      value = result.longest_hold_s;
    else if (result.judged)
      value = result.judged->of(criterion.metric);
    result.marks.push_back(mark(criterion, value, kNothingValid));
  }
  return result;
}

ExamResult Runner::result() const {
  ExamResult result;
  result.title = scenario_.title;
  result.provenance.scenario = scenario_.file.filename().string();
  result.provenance.scenario_digest = scenario_.digest;
  result.provenance.phantom_options = scenario_.phantom_options;
  result.provenance.case_name = case_name_;
  result.provenance.case_digest = case_digest_;
  result.provenance.program_version = INSONATE_VERSION;
  result.provenance.scoring_version = ExamResult::kScoringVersion;
  result.pass_mark_percent = scenario_.pass_mark_percent;
  result.complete = live_.finished;
  result.motion = motion_.values();
  result.steps = done_;
  for (std::size_t i = done_.size(); i < scenario_.steps.size(); ++i) {
    StepResult missed;
    missed.title = scenario_.steps[i].title;
    missed.view = scenario_.steps[i].view;
    missed.start_s = missed.end_s = last_s_;
    for (const Criterion& criterion : scenario_.steps[i].criteria)
      missed.marks.push_back(mark(criterion, std::nullopt, "the step was not reached."));
    result.steps.push_back(std::move(missed));
  }
  const bool all_held = std::all_of(result.steps.begin(), result.steps.end(),
                                    [](const StepResult& s) { return s.outcome == StepOutcome::held; });
  for (const Criterion& criterion : scenario_.criteria)
    result.marks.push_back(mark_motion(criterion, result.motion, all_held));
  decide(result);
  return result;
}

void Runner::record(const PoseSample& sample, double now) {
  if (!trace_.empty() && now - trace_.back().time_s < kTraceStep_s && trace_.back().step == live_.step) return;
  TracePoint point;
  point.time_s = now;
  point.step = live_.step;
  point.valid = sample.status == PoseStatus::ok;
  point.on_skin = live_.on_skin;
  point.within_tolerance = live_.within_tolerance;
  point.speed_mm_s = run_.motion.speed_mm_s();
  point.face = sample.patient_from_probe.translation;
  if (live_.view) point.view = *live_.view;
  trace_.push_back(point);
}

}  // namespace insonate
