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
#include "sim/core/pose_sample.h"
#include "sim/model/skin_contact.h"
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
  std::optional<ViewValues> view;  ///< of the last sample, when it was valid and the step names a view
  bool within_tolerance = false;   ///< the last sample's picture is as the step asks for
  double hold_share = 0;           ///< 0 to 1: how much of the step, as of a hold, is done
  bool enough = false;             ///< going on now would end the step as done
  std::vector<std::string> hints;  ///< that the learner has taken in this step
  std::size_t hints_left = 0;
  double points = 0;           ///< of the steps done
  double points_possible = 0;  ///< of the steps done
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

/// Runs an exam: a state machine fed with every sample of a tracker, and with what the learner does besides, in the
/// order of time, live or from a log. What comes out is a function of the scenario, the case, the samples and the
/// actions alone, whatever the batches they come in and however fast.
///
/// - The clock starts with the first sample and runs on the samples' own times. An action is handed over with the
///   sample that follows it; it is done at that sample's time and before the sample is looked at.
/// - What a step asks for, when it is done and how it is judged is its kind's business (scenarios/steps). When it is
///   done, or the learner goes on, the next one begins with the same sample.
/// - Motion is taken from every sample, the picture from every valid one that comes kLook_s or more after the one
///   before: a tracker of 1000 Hz costs no more than one of 100 Hz.
/// - A view is held while every tolerance of its step is kept whenever the picture is looked at. A loss of tracking
///   longer than MotionMeter::kBridged_s ends the hold. The picture of a step is judged by the mean over the hold,
///   weighted by time; of a step that ended without one, by the mean over the hold_s before its last valid sample.
/// - Warm-ups come before the exam's own clock and motion begin.
/// - A step that names where to go on skips what lies between. Where the order is free, the learner may turn to any
///   step that is not ended. One that he comes back to begins anew, but its limit, its time and its motion are those of
///   all his visits.
/// - Whichever limit comes first ends a step at that very time, and the exam's limit ends the exam. A sample at the
///   limit comes too late.
/// - Times are compared to kTimeRounding_s.
/// - A sample that does not come later than the one before it, or whose pose is not finite, is passed over; its actions
///   are done with the next one.
class Runner {
public:
  static constexpr double kLook_s = 0.009;  ///< at 60 frames a second no more than two a frame

  /// Keeps references to the case. Throws ScenarioError when the scenario does not fit the case, and InputError when
  /// the case does not fit itself.
  Runner(Scenario scenario, const Case& subject, const TissueTable& tissues);
  Runner(const Runner&) = delete;  // what is prepared for its steps refers to it
  Runner& operator=(const Runner&) = delete;

  /// @param before  what was done since the sample before
  void feed(const PoseSample& sample, std::span<const Action> before = {});
  /// @param actions  by the times of the samples that they go with; others are passed over
  void feed(std::span<const PoseSample> samples, const ActionLog& actions = {});

  /// There are no more samples: the step under way ends here. Nothing happens when the exam is finished.
  void end();

  const Scenario& scenario() const { return scenario_; }
  const LiveExam& live() const { return live_; }
  /// Whether a step is over, or was skipped: nobody turns to it any more.
  bool has_ended(std::size_t step) const { return ended_[step].has_value(); }
  /// Whether the learner may turn to a step now (ActionKind::go_to).
  bool can_go_to(std::size_t step) const;
  const std::vector<TracePoint>& trace() const { return trace_; }
  /// As the actions have set it.
  const Machine& machine() const { return machine_; }

  /// The marks of all steps that ended; complete when the exam is finished. Provenance lacks the mode and the log.
  ExamResult result() const;

private:
  const Step& step() const { return scenario_.steps[live_.step]; }
  void pass_limits(double now);
  void act(const Action& action, double now);
  void look(const PoseSample& sample, double now);
  void show(const PoseSample& sample, double now);
  const SkinContact& contact();
  enum class Then { go_on, finish };
  void end_step(StepOutcome outcome, double now, Then then = Then::go_on);
  void begin_step(std::size_t index, double now);
  void go_to(const std::string& name, double now);
  void skip(std::size_t from, std::size_t to, double now);
  std::optional<std::size_t> step_after(const StepResult& ended, double now);
  double step_limit_s() const { return step_start_s_ + (step().time_limit_s - left_[live_.step].motion.time_s); }
  double exam_limit_s() const;
  void finish(double now);
  void record(const PoseSample& sample, double now);
  StepResult judge(StepOutcome outcome, double now) const;

  Scenario scenario_;
  const Case& subject_;
  TissueTable tissues_;
  LabelIndex labels_;
  std::string case_digest_;
  std::vector<std::unique_ptr<ViewMeter>> meters_;  ///< one a step; null without a view
  std::vector<StepBegin> begin_;                    ///< by step
  std::map<std::string, SkinContact> contacts_;     ///< by probe
  Machine machine_;
  LiveExam live_;
  double first_s_ = 0;
  double last_s_ = 0;
  std::vector<Action> waiting_;  ///< handed over with samples that were passed over
  std::optional<Pose> last_valid_;
  std::optional<double> looked_s_;  ///< when the picture was looked at; empty after a loss or where a step begins
  double step_start_s_ = 0;
  MotionMeter step_motion_;
  std::unique_ptr<StepRun> run_;                  ///< the step under way
  MotionMeter motion_;                            ///< of the whole exam
  std::vector<std::optional<StepResult>> ended_;  ///< by step
  struct Left {
    std::optional<double> began_s;  ///< empty as long as nobody has turned to the step
    MotionValues motion;            ///< of the visits before this one
  };
  std::vector<Left> left_;                ///< by step: what the learner left behind when he turned away
  std::vector<std::size_t> hints_taken_;  ///< by step
  std::optional<double> counts_from_s_;   ///< when the warm-ups were over
  std::vector<TracePoint> trace_;
};

}  // namespace insonate
