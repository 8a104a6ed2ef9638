#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/action.h"
#include "scenarios/machine.h"
#include "scenarios/metrics/metric.h"
#include "scenarios/result.h"
#include "scenarios/steps/step_input.h"
#include "sim/core/pose.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

class LabelIndex;
class ViewMeter;
struct Mistake;
struct Step;

/// The environment of a running step. Everything in it outlives the run.
struct StepWorld {
  const Step& step;
  const Case& subject;
  const LabelIndex& labels;  ///< of the case
  const TissueTable& tissues;
  const ViewMeter* meter;  ///< of the step's view; nullptr if the step names none
};

/// One moment of a step: a sample, or an action just before a sample.
struct Moment {
  double now_s = 0;                  ///< since the exam's start
  bool valid = false;                ///< the sample's pose is usable
  Pose patient_from_probe;           ///< meaningful only when valid
  const ViewValues* view = nullptr;  ///< of a valid sample, compared with the step's view, if the step names one
  const Machine& machine;
};

/// A running step. The runner passes it every action and every evaluated sample, in order. To add a new kind of step,
/// derive one class from this one and one from StepTask, and add a line to step_kinds.cpp.
class StepRun {
public:
  virtual ~StepRun() = default;

  virtual void see(const Moment&) {}
  /// Receives an action after the machine has applied it. The moment's pose is that of the last valid sample.
  virtual void act(const Action&, const Moment&) {}

  /// Returns true if the task is done; this ends the step.
  virtual bool done() const { return false; }
  /// Returns true if the step counts as done when the learner ends it or its time runs out. The exam's economy metrics
  /// earn points only if every step was done.
  virtual bool counts_as_done() const { return false; }

  /// The share of the step that is done, 0 to 1, and whether the picture meets the requirements; shown on the screen.
  virtual double share_done() const { return 0; }
  virtual bool on_target() const { return false; }
  /// Returns the first requirement that the last picture does not meet, as a sentence; empty if there is none.
  virtual std::string lacks() const { return ""; }

  /// Returns the reason that a report gives for a criterion without a value.
  virtual std::string why_no_value() const { return "there was no valid pose to judge."; }

  /// Fills the fields that depend on the kind: judged, longest_hold_s, values, facts.
  virtual void finish(StepOutcome outcome, double now_s, StepResult& result) const = 0;
};

/// Begins a step, more than once if the order is free and the learner returns. It outlives the runs that it begins.
using StepBegin = std::function<std::unique_ptr<StepRun>(double now_s)>;

/// The task of a step: the keys that only its kind has. Immutable after reading.
class StepTask {
public:
  virtual ~StepTask() = default;

  /// Returns what the step takes from the learner besides the probe.
  virtual StepInput input() const { return {}; }
  /// Returns the texts that the screen shows for this kind.
  virtual StepWords words() const { return {}; }
  /// Returns true if holding a view completes the step. Its outcome is then `held`.
  virtual bool holds_view() const { return false; }
  /// Returns the step metrics that this task measures.
  virtual std::vector<Metric> metrics() const { return {}; }
  /// Returns true if a picture is judged, so that criteria may use picture metrics.
  virtual bool judges_picture() const { return false; }
  /// Returns the machine settings that the task asks the learner to change.
  virtual std::vector<ActionKind> settings() const { return {}; }
  /// Adds problems for everything that does not fit the case.
  /// @param where  "step 2"
  virtual void check(const Step&, const LabelIndex&, const std::string& /*where*/, std::vector<Mistake>&) const {}
  /// Computes what the step will be judged by from the patient. This happens before the exam begins, so that no sample
  /// waits for it.
  virtual StepBegin prepare(const StepWorld& world) const = 0;
};

}  // namespace insonate
