#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scenarios/motion_meter.h"
#include "scenarios/result.h"
#include "scenarios/scenario.h"
#include "scenarios/skin_contact.h"
#include "scenarios/view_meter.h"
#include "sim/core/pose_sample.h"
#include "sim/model/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

/// What the screen shows of a running exam.
struct LiveExam {
  bool started = false;   ///< a sample has come
  bool finished = false;  ///< nothing fed from now on changes the result
  std::size_t step = 0;   ///< the one under way, or the last one
  double elapsed_s = 0;
  double step_remaining_s = 0;
  double exam_remaining_s = 0;
  PoseStatus tracking = PoseStatus::unknown;  ///< of the last sample
  bool on_skin = false;
  std::optional<ViewValues> view;  ///< of the last sample, when it was valid
  bool within_tolerance = false;   ///< of the last sample
  double hold_share = 0;           ///< 0 to 1: how much of the hold is done
  double points = 0;               ///< of the steps done
  double points_possible = 0;      ///< of the steps done
};

/// What a report draws of a run, about ten times a second.
struct TracePoint {
  double time_s = 0;
  std::size_t step = 0;
  bool valid = false;
  bool on_skin = false;
  bool within_tolerance = false;
  double speed_mm_s = 0;
  glm::dvec3 face{0.0};  ///< patient, mm
  ViewValues view;
};

/// Runs an exam: a state machine fed with every sample of a tracker in the order of time, live or from a log. What
/// comes out is a function of the scenario, the case and the samples alone, whatever the batches they come in and
/// however fast.
///
/// - The clock starts with the first sample and runs on the samples' own times.
/// - A view is held while every tolerance of its step is kept by every valid sample. A loss of tracking longer than
///   MotionMeter::kBridged_s ends the hold. When the view was held for hold_s, the step is done and the next one
///   begins with the same sample.
/// - The picture of a step is judged by the mean over the hold, weighted by time; of a step that ended without one, by
///   the mean over the hold_s before its last valid sample.
/// - Whichever limit comes first ends a step at that very time, and the exam's limit ends the exam. A sample at the
///   limit comes too late.
/// - Times are compared to kTimeRounding_s.
/// - A sample that does not come later than the one before it, or whose pose is not finite, is passed over.
class Runner {
public:
  /// Keeps references to the case. Throws ScenarioError when the scenario does not fit the case, and InputError when
  /// the case does not fit itself.
  Runner(Scenario scenario, const Case& subject, const TissueTable& tissues);

  void feed(const PoseSample& sample);
  void feed(std::span<const PoseSample> samples);

  /// There are no more samples: the step under way ends here. Nothing happens when the exam is finished.
  void end();

  const Scenario& scenario() const { return scenario_; }
  const LiveExam& live() const { return live_; }
  const std::vector<TracePoint>& trace() const { return trace_; }

  /// The marks of all steps that ended; complete when the exam is finished. Provenance lacks the log.
  ExamResult result() const;

private:
  struct Seen {
    double time_s;
    ViewValues view;
  };
  /// The step under way.
  struct StepRun {
    double start_s = 0;
    MotionMeter motion;
    std::deque<Seen> recent;             ///< valid samples, as far back as judging may ask for
    std::optional<double> holding_from;  ///< since when all tolerances are kept
    double longest_hold_s = 0;
  };
  const Step& step() const { return scenario_.steps[live_.step]; }
  void pass_limits(double now);
  void look(const PoseSample& sample, double now);
  void see(const Pose& patient_from_probe, double now);
  bool within_tolerance(const ViewValues& view) const;
  bool update_hold(bool valid, double now);
  void end_step(StepOutcome outcome, double now);
  void begin_step(double now);
  void finish(double now);
  void record(const PoseSample& sample, double now);
  StepResult judge(StepOutcome outcome, double now) const;

  Scenario scenario_;
  std::string case_name_;
  std::string case_digest_;
  std::vector<std::unique_ptr<ViewMeter>> meters_;  ///< one a step
  std::vector<SkinContact> contacts_;               ///< one a step
  LiveExam live_;
  double first_s_ = 0;
  double last_s_ = 0;
  StepRun run_;
  MotionMeter motion_;  ///< of the whole exam
  std::vector<StepResult> done_;
  std::vector<TracePoint> trace_;
};

}  // namespace insonate
