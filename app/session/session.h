#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/session/left_place.h"
#include "app/session/loaded_case.h"
#include "app/session/probe_hand.h"
#include "devices/mouse/mouse_tracker.h"
#include "devices/pose_history.h"
#include "devices/tracker.h"
#include "scenarios/runner.h"
#include "sim/core/button_presses.h"
#include "sim/probe/probe.h"

namespace insonate {

enum class Holder { tracker, learner };
enum class Activity { exam, practice };
/// Whether an exam may be left, begun again and helped with, or is taken once and as it is.
enum class ExamRules { open, strict };

/// Throws InputError where no session can take its samples from a tracker: a sensor's poses without a calibration, and
/// for an exam a log that loops.
void check_source(const Tracker& tracker, bool exam);

/// One person's time with one patient: where poses come from, the attempt at the exam that they make, and the machine.
/// Knows no window and no graphics, so that a run looks the same with and without. Time is passed in.
///
/// An attempt at the exam is scored from one source only, from the first sample to the last. Who takes the probe out of
/// a running exam practises from there on: nothing is scored, because what the tracker has found so far is not his own.
/// An exam of the learner's own starts with the probe on the belly. Giving the probe back starts the exam, and a
/// replayed log, from the beginning; a live tracker just goes on, and what it said while the learner had the probe is
/// past; one that tells no place (Tracker::relative) goes on from where the learner has left the probe. Every sample of
/// the source in charge is fed to the runner, in order, whatever the frame rate, with what the learner did before it:
/// set() and act(). A log that keeps such actions sets the machine itself.
///
/// Under strict rules an exam is not left for practice, its probe does not change hands, it is not begun again once its
/// first sample has come, there are no hints, and what the scenario locks of the machine stays as it is: what asks for
/// any of that does nothing.
///
/// The probe's buttons (probe_buttons.h) act when they are pressed, once however long they are held: freeze freezes the
/// picture or thaws it, mark marks the moment, and go on is handed on to whoever shows the session.
class Session {
public:
  using OpenTracker = std::function<std::unique_ptr<Tracker>()>;

  /// Keeps the loaded_case. `open` is called at once, and again when a log is to start over; what it throws passes
  /// through. Throws ScenarioError or InputError when the scenario does not fit the case, and InputError when there is
  /// an exam and the tracker repeats itself: nobody could score such a log again.
  /// @param predict_s  how far a live tracker's pose is carried on to the time of the picture, at most
  Session(std::shared_ptr<const LoadedCase> loaded_case, OpenTracker open, double predict_s = PoseHistory::kPredictS,
          ExamRules rules = ExamRules::open);

  /// Takes what has come from the source in charge up to `now_s` (s, steady_now_s() when the tracker is live).
  void advance(double now_s);

  // The exam
  Activity activity() const { return activity_; }
  /// Whether the exam is taken under strict rules.
  bool strict() const { return rules_ == ExamRules::strict; }
  /// Whether a knob of the machine cannot be set: in an exam under strict rules that locks it, until it is finished.
  /// The lock of the gain covers dynamic range and time gain too.
  bool locks(ActionKind setting) const;
  /// Whether the CT and the patient's inside may be seen: not in an exam under strict rules, which asks what the
  /// learner sees in the ultrasound, until it is finished.
  bool shows_anatomy() const { return !strict() || !runner_ || result_; }
  /// Starts the exam from its beginning with whoever holds the probe, or without a scenario just the scan.
  void start_over();
  /// Ends the exam without a score: whoever holds the probe goes on with it.
  void practise();
  /// Ends the exam under way here, as a scan that ends does: what there is of it is scored. Nothing without one, and
  /// before its first sample.
  void hand_in();
  /// Counts from 1 each time that the exam or practice starts from its beginning.
  int attempt() const { return attempt_; }
  /// The runner of the exam; nullptr in free practice.
  const Runner* runner() const { return runner_.get(); }
  /// What the runner has been fed with.
  const std::vector<PoseSample>& exam_samples() const { return exam_samples_; }
  /// Does something besides moving the probe and setting the machine: a caliper, an answer. Nothing happens when the
  /// source is a log, which brings its own actions.
  void act(const Action& action);
  /// All that the exam under way has been handed, for whoever keeps it with the samples.
  const ActionLog& actions() const { return actions_; }
  /// What was done before the samples of the last advance(), in practice too.
  const ActionLog& latest_actions() const { return latest_actions_; }
  /// The actions that bring an untouched machine to machine(), for a recording that begins in the middle.
  std::vector<Action> settings() const { return actions_between(Machine(), shown_); }
  /// Complete marks with their provenance; empty until the exam is finished.
  const std::optional<ExamResult>& result() const { return result_; }

  // The probe
  Holder holder() const { return holder_; }
  /// Whether the learner's own hand is the source that was asked for: there is nothing to give back to then.
  bool only_learner() const { return only_learner_; }
  /// Puts the probe into the learner's hand where it is, and ends the exam of the tracker.
  void take_probe();
  /// Throws what opening the tracker throws; the learner keeps the probe then.
  void give_back_probe();
  /// Moves the probe to where a motion leads from where it is; takes it first if need be.
  void move_probe(const std::function<Pose(const ProbeHand&, const Pose&)>& motion);

  /// Where the picture is taken: of a live tracker the pose at the very time of the picture, of others the newest
  /// usable one, so that what is replayed looks the same every time; an older one while the picture is frozen. Empty
  /// until the first usable pose came.
  const std::optional<Pose>& shown_pose() const { return shown_pose_; }
  /// The newest usable pose, which a frozen picture does not show.
  const std::optional<Pose>& newest_pose() const { return newest_pose_; }
  /// The pose of the frozen picture that is shown, as whoever judges calipers in it knows it: once a sample has told
  /// him of the freezing.
  std::optional<Pose> frozen_picture() const;
  /// How the pose was found that would be shown if the picture were not frozen; empty unless a live tracker is in
  /// charge.
  const std::optional<PoseEstimate>& answer() const { return answer_; }
  /// How long no usable pose has come (s), once that is longer than kStale_s; the picture stands still then.
  std::optional<double> lost_for_s() const;
  static constexpr double kStale_s = 0.25;

  /// What came with the last advance(), from the source that was in charge then.
  const std::vector<PoseSample>& latest_samples() const { return samples_; }
  /// Whether they are the first of this attempt.
  bool latest_begin_attempt() const { return samples_begin_attempt_; }

  /// Moments that were marked during this attempt, in seconds since it began.
  const std::vector<double>& event_markers_s() const { return event_markers_s_; }
  /// As if these buttons (ProbeButton) were pressed on the probe: the next sample has them.
  void press(std::uint32_t buttons) { pressed_ |= buttons; }
  /// Whether to go on was asked for since the last call.
  bool take_go_on() { return std::exchange(go_on_, false); }
  /// How long this attempt has lasted (s).
  double attempt_for_s() const { return now_s_ - attempt_began_s_; }

  const Tracker& source() const;
  /// The tracker, for whoever records its bytes from its beginning; nullptr when only the learner's hand is there.
  Tracker* tracker() { return tracker_.get(); }
  TrackerState tracker_state() const { return source().state(); }

  // The machine
  /// As it is set now. It always has a probe.
  const Machine& machine() const { return shown_; }
  /// Takes a probe, sets a knob, freezes or unfreezes, unless the exam locks it. While the source is a log, this
  /// changes the picture that the viewer sees, and no score.
  void set(const Action& action);
  void set(ActionKind knob, double value) { set(Action{knob, {value}}); }
  void choose_probe(const std::string& name) { set({ActionKind::probe, {}, name}); }
  void freeze(bool frozen) { set({frozen ? ActionKind::freeze : ActionKind::unfreeze}); }

  const LoadedCase& loaded_case() const { return *loaded_case_; }
  double now_s() const { return now_s_; }

private:
  std::unique_ptr<Tracker> open_fresh() const;
  Machine first_machine() const;
  void restart_tracker();
  void begin_attempt();
  void hold(Holder holder);
  void keep_result();
  void take(const PoseSample& sample);
  void find_pose();
  std::vector<Action> actions_before(const PoseSample& sample);
  Tracker& source();

  std::shared_ptr<const LoadedCase> loaded_case_;
  OpenTracker open_;
  double predict_s_;
  ExamRules rules_;
  int attempt_ = 0;
  std::unique_ptr<Tracker> tracker_;
  LeftPlace left_place_;
  std::unique_ptr<MouseTracker> learner_;
  bool only_learner_ = false;
  ProbeHand hand_;
  Holder holder_ = Holder::tracker;
  Activity activity_ = Activity::practice;
  std::unique_ptr<Runner> runner_;
  std::vector<PoseSample> exam_samples_;
  std::optional<ExamResult> result_;
  Machine shown_;  ///< with what was set since the last sample
  std::optional<Pose> shown_pose_, newest_pose_;
  PoseHistory history_;  ///< of a live tracker
  std::optional<PoseEstimate> answer_;
  double now_s_ = 0;
  double last_usable_s_ = 0, attempt_began_s_ = 0;
  ButtonPresses presses_;
  std::uint32_t pressed_ = 0;  ///< for the next sample
  bool go_on_ = false;
  std::vector<double> event_markers_s_;
  ActionLog log_actions_;     ///< of the log that is replayed
  std::vector<Action> acts_;  ///< the learner's own, until the next sample
  Machine machine_;           ///< as it was at the last sample
  ActionLog actions_;         ///< of this attempt
  bool advanced_ = false;
  std::vector<PoseSample> samples_;
  ActionLog latest_actions_;  ///< by the times of samples_
  bool samples_begin_attempt_ = false, attempt_is_fresh_ = true;
};

}  // namespace insonate
