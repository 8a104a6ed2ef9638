#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/action.h"
#include "scenarios/machine.h"
#include "scenarios/metrics/motion_meter.h"
#include "scenarios/metrics/view_meter.h"
#include "scenarios/result.h"
#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"
#include "scenarios/steps/structures.h"
#include "sim/core/probe_sample.h"
#include "sim/tissue/skin_contact.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

/// The state of a running exam that the screen shows.
struct LiveExam {
  bool started = false;   ///< a sample has arrived
  bool finished = false;  ///< further samples do not change the result
  std::size_t step = 0;   ///< index of the current or last step
  double elapsed_s = 0;
  double step_remaining_s = 0;
  double exam_remaining_s = 0;
  PoseStatus tracking = PoseStatus::unknown;  ///< of the last sample
  bool on_skin = false;
  std::optional<ViewValues> view;  ///< of the last sample; empty if it was invalid or the step names no view
  bool within_tolerance = false;   ///< the last sample's picture meets the step's requirements
  std::string lacks;               ///< the first requirement that it does not meet, as a sentence
  double hold_share = 0;           ///< share of the step that is done, such as the share of the hold, 0 to 1
  bool counts_as_done = false;     ///< ending the step now would count as done
  std::vector<std::string> hints;  ///< hints taken in this step
  std::size_t hints_left = 0;
  std::vector<std::string> measured;  ///< what steps that ended have measured: "188 ml in 'Three lengths'"
  double points = 0;                  ///< of the steps done
  double points_possible = 0;         ///< of the steps done
};

/// One point of the curves in a report, recorded about 10 times per second.
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

/// Runs an exam. It is a state machine that receives every sample of a tracker and the learner's other actions in time
/// order, live or from a log. The result depends only on the scenario, the case, the samples and the actions. It does
/// not depend on how the samples are batched or how fast they are fed.
///
/// - The clock starts with the first sample and uses the samples' own times. An action is passed with the sample that
///   follows it. It takes effect at that sample's time, before the sample is evaluated.
/// - The step's kind (scenarios/steps) defines what a step requires, when it is done and how it is judged. When the
///   step is done or the learner goes on, the next step begins with the same sample.
/// - Every sample contributes to the motion. A valid sample's picture is evaluated if the previous evaluation was at
///   least kLook_s earlier. So a tracker of 1000 Hz costs no more than one of 100 Hz.
/// - A view is held while every evaluated picture is within all tolerances of its step. A tracking loss longer than
///   MotionMeter::kBridged_s ends the hold. The score of a picture is the time-weighted mean over the hold. For a step
///   without a completed hold, it is the mean over the hold_s before its last valid sample.
/// - Warm-ups precede the start of the exam's own clock and motion.
/// - A step that names its next step skips the steps between. If the order is free, the learner may switch to any step
///   that has not ended. A step begins anew when the learner returns to it, but its limit, its time and its motion
///   cover all visits.
/// - The earliest limit ends a step at exactly that time, and the exam's limit ends the exam. A sample at the limit is
///   too late.
/// - Times are compared with a tolerance of kTimeRounding_s.
/// - The runner ignores a sample that is not later than the previous one, or whose pose is not finite. Its actions take
///   effect with the next sample.
class Runner {
public:
  static constexpr double kLook_s = 0.009;  ///< least time between evaluations: about 100 per second

  /// Keeps a reference to the case. Throws ScenarioError if the scenario does not fit the case, and InputError if the
  /// case is inconsistent.
  Runner(Scenario scenario, const Case& subject, const TissueTable& tissues);
  Runner(const Runner&) = delete;  // the prepared steps refer to this object
  Runner& operator=(const Runner&) = delete;

  /// Processes one sample.
  /// @param before  the actions since the previous sample
  void feed(const ProbeSample& sample, std::span<const Action> before = {});
  /// Processes several samples.
  /// @param actions  by the times of their samples; actions at other times are ignored
  void feed(std::span<const ProbeSample> samples, const ActionLog& actions = {});

  /// Reports that there are no more samples, and ends the current step. Does nothing if the exam is finished.
  void end();

  const Scenario& scenario() const { return scenario_; }
  const LiveExam& live() const { return live_; }
  /// Returns true if a step is over or was skipped. The learner cannot return to it.
  bool has_ended(std::size_t step) const { return ended_[step].has_value(); }
  /// Returns true if the learner may switch to a step now (ActionKind::go_to).
  bool can_go_to(std::size_t step) const;
  const std::vector<TracePoint>& trace() const { return trace_; }
  /// Returns the machine as the actions have set it.
  const Machine& machine() const { return machine_; }

  /// Returns the scores of all steps that ended. The result is complete when the exam is finished. Its provenance lacks
  /// the mode and the log.
  ExamResult result() const;

private:
  const Step& step() const { return scenario_.steps[live_.step]; }
  void pass_limits(double now);
  void act(const Action& action, double now);
  void evaluate(const ProbeSample& sample, double now);
  void show(const ProbeSample& sample, double now);
  const SkinContact& contact();
  enum class Then { go_on, finish };
  void end_step(StepOutcome outcome, double now, Then then = Then::go_on);
  void begin_step(std::size_t index, double now);
  void go_to(const std::string& name, double now);
  void show_guide(double now);
  void hide_guide(double now);
  void skip(std::size_t from, std::size_t to, double now);
  std::optional<std::size_t> step_after(const StepResult& ended, double now);
  double step_limit_s() const { return step_start_s_ + (step().time_limit_s - left_[live_.step].motion.time_s); }
  double exam_limit_s() const;
  void finish(double now);
  void record(const ProbeSample& sample, double now);
  StepResult judge(StepOutcome outcome, double now) const;

  Scenario scenario_;
  const Case& subject_;
  TissueTable tissues_;
  LabelIndex labels_;
  std::string case_digest_;
  std::vector<std::unique_ptr<ViewMeter>> meters_;  ///< one per step; null without a view
  std::vector<StepBegin> begin_;                    ///< by step
  std::map<std::string, SkinContact> contacts_;     ///< by probe
  Machine machine_;
  LiveExam live_;
  double first_s_ = 0;
  double last_s_ = 0;
  std::vector<Action> waiting_;  ///< actions that came with ignored samples
  std::optional<Pose> last_valid_;
  std::optional<double> looked_s_;  ///< time of the last evaluated picture; empty after a loss or a new step
  double step_start_s_ = 0;
  MotionMeter step_motion_;
  std::unique_ptr<StepRun> run_;                  ///< the current step
  MotionMeter motion_;                            ///< of the whole exam
  std::vector<std::optional<StepResult>> ended_;  ///< by step
  struct Left {
    std::optional<double> began_s;  ///< empty until the learner starts the step
    MotionValues motion;            ///< of the previous visits
    int guide_times = 0;            ///< how often the guide was shown, and for how long, in visits that are over
    double guide_s = 0;
  };
  std::vector<Left> left_;                ///< state of earlier visits to the step
  std::vector<std::size_t> hints_taken_;  ///< by step
  bool guided_ = false;                   ///< the guide is on, in steps that ask for a view
  std::optional<double> guided_from_s_;   ///< since when it is shown in this step
  std::optional<double> counts_from_s_;   ///< when the warm-ups ended
  std::vector<TracePoint> trace_;
};

}  // namespace insonate
