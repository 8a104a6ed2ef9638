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
/// Rules of an exam. Open: the learner may leave it, restart it and use help. Strict: the exam is taken once, as it is.
enum class ExamRules { open, strict };

/// Throws InputError if no session can use the tracker's samples: sensor poses without a calibration, or, for an exam,
/// a log that loops.
void check_source(const Tracker& tracker, bool exam);

/// Runs one learner's time with one patient: the source of poses, the attempt at the exam and the state of the machine.
/// Does not depend on window or graphics, so that a run is the same with and without them. The caller passes in the
/// time.
///
/// An attempt at the exam is scored from one source only, from the first sample to the last. A learner who takes the
/// probe out of a running exam continues in practice. Practice is not scored, because the tracker, not the learner, has
/// found the view so far. An exam that the learner takes by hand starts with the probe on the belly. Giving the probe
/// back starts the exam, and a replayed log, from the beginning. A live tracker continues; its samples from the time
/// when the learner had the probe are dropped. A tracker without an absolute position (Tracker::relative) continues
/// from where the learner left the probe. The runner is fed every sample of the active source, in order and at any
/// frame rate, with what the learner did before it through set() and act(). A log that contains such actions sets the
/// machine itself.
///
/// Under strict rules the learner cannot leave the exam for practice, take the probe, take hints, or restart the exam
/// after its first sample. The settings that the scenario locks stay as they are. Calls that ask for any of this do
/// nothing.
///
/// The probe's buttons (probe_buttons.h) act once per press, however long they are held. Freeze freezes or unfreezes
/// the picture, mark stores an event marker, and go on sets the flag that take_go_on() returns.
class Session {
public:
  using OpenTracker = std::function<std::unique_ptr<Tracker>()>;

  /// Shares ownership of `loaded_case`. Calls `open` at once, and again when a log starts over; what `open` throws
  /// passes through. Throws ScenarioError or InputError if the scenario does not fit the case. Throws InputError if
  /// there is an exam and the tracker loops, because the score of such a log cannot be reproduced.
  /// @param predict_s  the longest time by which a live tracker's pose is extrapolated to the time of the picture
  Session(std::shared_ptr<const LoadedCase> loaded_case, OpenTracker open, double predict_s = PoseHistory::kPredict_s,
          ExamRules rules = ExamRules::open);

  /// Processes the samples of the active source up to `now_s` (s, steady_now_s() with a live tracker).
  void advance(double now_s);

  // The exam
  Activity activity() const { return activity_; }
  /// Returns whether there are steps that can begin: the patient has a scenario, and the probe is not in the made-up
  /// hand of a rehearsal, whose scan would be scored as the learner's.
  bool can_take_steps() const;
  /// Returns whether the exam is taken under strict rules.
  bool strict() const { return rules_ == ExamRules::strict; }
  /// Returns whether a setting of the machine is locked: in an exam under strict rules whose scenario locks it, until
  /// it is finished. The lock of the gain covers dynamic range and time gain too.
  bool locks(ActionKind setting) const;
  /// Returns, as a sentence for the learner, why a setting of the machine cannot be changed now: the exam locks it, or
  /// the picture is frozen (Machine::refuses). Empty if it can.
  std::string why_not(ActionKind setting) const;
  /// Returns whether the CT and the patient's inside may be shown. False in an exam under strict rules until it is
  /// finished, because it tests what the learner sees in the ultrasound.
  bool shows_anatomy() const { return !strict() || !runner_ || result_; }
  /// Starts the exam from its beginning, or practice: without a scenario there is no exam. The holder of the probe
  /// stays, and the probe goes back to where it started.
  void start_over(Activity activity = Activity::exam);
  /// Ends the exam without a score and starts practice. The holder of the probe stays.
  void practise();
  /// Ends the current exam now and scores it, as when a scan ends. Does nothing without an exam or before its first
  /// sample.
  void hand_in();
  /// Returns a counter, from 1, of how often the exam or practice has started from its beginning.
  int attempt() const { return attempt_; }
  /// Returns the patient in words (LoadedCase::patient).
  const std::string& patient() const { return loaded_case().patient; }
  /// Returns the exam's runner; nullptr in free practice.
  const Runner* runner() const { return runner_.get(); }
  /// Returns the samples that the runner was fed.
  const std::vector<ProbeSample>& exam_samples() const { return exam_samples_; }
  /// Adds an action other than moving the probe and setting the machine, such as a caliper or an answer. Does nothing
  /// if the source is a log, which brings its own actions.
  void act(const Action& action);
  /// Returns all actions of the current exam, to be stored with its samples.
  const ActionLog& actions() const { return actions_; }
  /// Returns the actions before the samples of the last advance(), in practice too.
  const ActionLog& latest_actions() const { return latest_actions_; }
  /// Returns the actions that bring an untouched machine to machine(), for a recording that begins in the middle of a
  /// run.
  std::vector<Action> settings() const { return actions_between(Machine(), shown_); }
  /// Returns the complete result with its provenance; empty until the exam is finished.
  const std::optional<ExamResult>& result() const { return result_; }

  // The probe
  Holder holder() const { return holder_; }
  /// Returns whether the learner's hand is the only source, so that the probe cannot be given back.
  bool only_learner() const { return only_learner_; }
  /// Gives the probe to the learner where it is, and ends the tracker's exam.
  void take_probe();
  /// Gives the probe back to the tracker. Its exam begins anew if the probe was taken in one or the learner's own steps
  /// run; else practice goes on. Throws what opening the tracker throws; the learner keeps the probe then.
  void give_back_probe();
  /// Why the probe stays where it is: the skin ends, as at the end of the CT, or it would lie on the body.
  enum class Stop { none, at_edge, tilted };
  /// Moves the probe by a motion from its current pose. Takes the probe first if needed. A motion that returns no pose
  /// leaves the probe where it is, and stop() is Stop::at_edge for a moment.
  void move_probe(const std::function<std::optional<Pose>(const ProbeHand&, const Pose&)>& motion);
  /// Turns the probe about the middle of its face (ProbeHand::turn_on_skin()). Takes it first if needed. If nothing is
  /// left of the turn, stop() is Stop::tilted for a moment.
  void turn_probe(double tilt_deg, double rotation_deg, double rock_deg);
  /// Returns what has just stopped the probe.
  Stop stop() const { return now_s_ < stop_shown_until_s_ ? stop_ : Stop::none; }
  /// Returns whether more than a quarter of the picture's central beam lies where the CT ends towards head or feet, so
  /// that the picture is dark there.
  bool looks_past_ct() const;

  /// Returns the pose of the picture. With a live tracker this is the pose at the time of the picture. With other
  /// sources it is the newest usable pose, so that a replay looks the same every time. While the picture is frozen it
  /// is an older pose. Empty before the first usable pose.
  const std::optional<Pose>& shown_pose() const { return shown_pose_; }
  /// Returns the newest usable pose, also while the picture is frozen.
  const std::optional<Pose>& newest_pose() const { return newest_pose_; }
  /// Returns the pose of the frozen picture as the scoring of calipers knows it. Empty until a sample has carried the
  /// freeze action.
  std::optional<Pose> frozen_picture() const;
  /// Returns the live estimate of the pose and how it was determined, also while the picture is frozen. Empty unless a
  /// live tracker is the active source.
  const std::optional<PoseEstimate>& pose_estimate() const { return pose_estimate_; }
  /// Returns the time since the last usable pose (s) once it exceeds kStale_s; empty before. The picture stands still
  /// then.
  std::optional<double> lost_for_s() const;
  static constexpr double kStale_s = PoseHistory::kStale_s;

  /// Returns the samples of the last advance(), from the source that was active then.
  const std::vector<ProbeSample>& latest_samples() const { return samples_; }
  /// Returns whether latest_samples() are the first of this attempt.
  bool latest_begin_attempt() const { return samples_begin_attempt_; }

  /// Returns the event markers of this attempt, in seconds since it began.
  const std::vector<double>& event_markers_s() const { return event_markers_s_; }
  /// Acts as if these buttons (ProbeButton) were pressed on the probe: the next sample carries them.
  void press(std::uint32_t buttons) { pressed_ |= buttons; }
  /// Returns whether "go on" was pressed since the last call.
  bool take_go_on() { return std::exchange(go_on_, false); }
  /// Returns whether an exam is under way whose time can stand still, as while a page covers the screen: the rules are
  /// not strict, and no device measures on. Then the caller may leave advance() out and go on later as if no time had
  /// passed.
  bool can_stand_still() const { return runner_ && !result_ && !strict() && !(tracker_ && tracker_->live()); }
  /// Returns how long this attempt has lasted (s).
  double attempt_for_s() const { return now_s_ - attempt_began_s_; }

  const Tracker& source() const;
  /// Returns the tracker, so that its raw bytes can be recorded from the start; nullptr if the learner's hand is the
  /// only source.
  Tracker* tracker() { return tracker_.get(); }
  TrackerState tracker_state() const { return source().state(); }

  // The machine
  /// Returns the current settings. They always include a probe.
  const Machine& machine() const { return shown_; }
  /// Selects a probe, changes a setting, freezes or unfreezes, unless why_not() has a reason against it. While the
  /// source is a log, this changes the displayed picture only, not the score.
  void set(const Action& action);
  void set(ActionKind knob, double value) { set(Action{knob, {value}}); }
  void choose_probe(const std::string& name) { set({ActionKind::probe, {}, name}); }
  void freeze(bool frozen) { set({frozen ? ActionKind::freeze : ActionKind::unfreeze}); }

  const LoadedCase& loaded_case() const { return *loaded_case_; }
  double now_s() const { return now_s_; }

private:
  void follow(const Pose& from, const std::optional<Pose>& to, Stop otherwise);
  std::unique_ptr<Tracker> open_fresh() const;
  Machine first_machine() const;
  void restart_tracker();
  void begin_attempt();
  void hold(Holder holder);
  void keep_result();
  void take(const ProbeSample& sample);
  void show_of_log(const Action& action);
  void catch_up();
  void find_pose();
  std::vector<Action> actions_before(const ProbeSample& sample);
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
  Activity taken_in_ = Activity::practice;  ///< what the learner took the probe in
  std::unique_ptr<Runner> runner_;
  std::vector<ProbeSample> exam_samples_;
  std::optional<ExamResult> result_;
  Machine shown_;  ///< includes settings made since the last sample
  std::optional<Pose> shown_pose_, newest_pose_;
  PoseHistory history_;  ///< of a live tracker
  std::optional<PoseEstimate> pose_estimate_;
  double now_s_ = 0;
  double last_usable_s_ = 0, attempt_began_s_ = 0, stop_shown_until_s_ = 0;
  Stop stop_ = Stop::none;
  ButtonPresses presses_;
  std::uint32_t pressed_ = 0;  ///< for the next sample
  bool go_on_ = false;
  std::vector<double> event_markers_s_;
  ActionLog log_actions_;          ///< of the log being replayed
  std::vector<Action> held_back_;  ///< the log's settings since the viewer froze the picture
  std::vector<Action> acts_;       ///< the learner's own, held until the next sample
  Machine machine_;                ///< as it was at the last sample
  ActionLog actions_;              ///< of this attempt
  bool advanced_ = false;
  std::vector<ProbeSample> samples_;
  ActionLog latest_actions_;  ///< keyed by the times of samples_
  bool samples_begin_attempt_ = false, attempt_is_fresh_ = true;
};

}  // namespace insonate
