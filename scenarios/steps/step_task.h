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
#include "sim/model/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

class LabelIndex;
class ViewMeter;
struct ScenarioProblem;
struct Step;

/// What the run of a step has of the world; all of it outlives the run.
struct StepWorld {
  const Step& step;
  const Case& subject;
  const LabelIndex& labels;  ///< of the case
  const TissueTable& tissues;
  const ViewMeter* meter;  ///< of the step's view; nullptr when it names none
};

/// A moment of a step: a sample, or an action just before one.
struct Moment {
  double now_s = 0;                  ///< since the exam's start
  bool valid = false;                ///< the sample's pose is usable
  Pose patient_from_probe;           ///< meaningful only when valid
  const ViewValues* view = nullptr;  ///< of a valid sample, against the step's view, when it names one
  const Machine& machine;
};

/// A step under way: fed by the runner with every action, and every sample that it looks at, in order. A new kind of
/// step is a class derived from this one, one derived from StepTask, and a line in step_kinds.cpp.
class StepRun {
public:
  virtual ~StepRun() = default;

  virtual void see(const Moment&) {}
  /// Of an action; the machine has taken it already. The moment's pose is that of the last valid sample.
  virtual void act(const Action&, const Moment&) {}

  /// Whether what was asked for is done, so that the step ends here.
  virtual bool done() const { return false; }
  /// What the step comes to when the learner ends it himself, or when its time runs out: whether what there is counts
  /// as done. The exam's economy is marked only where every step was.
  virtual bool enough() const { return false; }

  /// What the screen shows of the step: how much is done, 0 to 1, and whether the picture is as asked for.
  virtual double share_done() const { return 0; }
  virtual bool on_target() const { return false; }

  /// Fills in what is this kind's own: judged, longest_hold_s, values, facts.
  virtual void finish(StepOutcome outcome, double now_s, StepResult& result) const = 0;
};

/// Begins a step; where the order is free, perhaps more than once. It outlives the runs that it begins.
using StepBegin = std::function<std::unique_ptr<StepRun>(double now_s)>;

/// What a step of some kind asks for: the keys that only this kind has. Immutable once read.
class StepTask {
public:
  virtual ~StepTask() = default;

  /// What it takes from the learner besides the probe.
  virtual StepInput input() const { return {}; }
  /// What the screen says of it.
  virtual StepWords words() const { return {}; }
  /// Whether it is done by holding a view, so that it ends as held.
  virtual bool holds_view() const { return false; }
  /// The step metrics that it measures.
  virtual std::vector<Metric> metrics() const { return {}; }
  /// Whether a picture is judged, so that criteria may ask for picture metrics.
  virtual bool judges_picture() const { return false; }
  /// The settings of the machine that the learner is asked to change.
  virtual std::vector<ActionKind> settings() const { return {}; }
  /// What a report says of a criterion without a value.
  virtual const char* why_no_value() const { return "there was no valid pose to judge."; }
  /// Adds what does not fit the case. @param where  "step 2"
  virtual void check(const Step&, const LabelIndex&, const std::string& /*where*/,
                     std::vector<ScenarioProblem>&) const {}
  /// Searches the patient for what the step will be judged by, before the exam begins: no sample waits for that.
  virtual StepBegin prepare(const StepWorld& world) const = 0;
};

}  // namespace insonate
