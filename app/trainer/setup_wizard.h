#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "devices/calibration/steps/setup_step.h"
#include "devices/tracker.h"

namespace insonate {

/// The set-up of a tracker, step by step, for a window to show. Holds the tracker meanwhile: no session may have it.
/// What is found is written after every step, so that a set-up that is closed loses nothing. Time is passed in.
class SetupWizard {
public:
  /// @param sensor  whose samples are its sensor's poses
  /// @param base    what is there of the tracker's calibration; its steps are kept until they are made again
  /// @param file    where it is kept
  /// Begins with the first step that is still to be made.
  SetupWizard(std::unique_ptr<Tracker> sensor, Calibration base, SetupInput given, std::filesystem::path file);

  /// Takes what has come from the tracker up to `now_s`. Throws InputError when the file cannot be written.
  void update(double now_s);

  /// "Now", said at `now_s`; or, when the step is done, on to the next. A button of the tracker does the same.
  void mark(double now_s);
  /// Takes the last mark back, or begins the step again when it is done.
  void undo();
  /// Leaves the step as it was and goes to another, by its place in kSetupSteps; nothing where why_not() has a reason.
  void go_to(std::size_t step);
  std::string why_not(std::size_t step) const;

  /// Whether landmarks that were touched before can be found again, when only the base or the mannequin was moved.
  bool can_be_moved() const { return calibration_.mannequin.has_value(); }
  bool moved() const { return given_.moved; }
  /// Begins the landmarks again, as those of the last time or as the patient's.
  void set_moved(bool moved);

  struct Row {
    std::string_view name;  ///< of kSetupSteps
    std::string title;
    std::string figure;  ///< what its last making says of itself, in short; empty when it was not made
  };
  std::vector<Row> rows() const;
  std::size_t current() const { return current_; }
  SetupView view() const { return step_->view(); }
  /// The places of the body that the step `landmarks` asks for, in its order.
  std::vector<LandmarkPair> landmarks() const;

  TrackerState tracker_state() const { return sensor_->state(); }
  const Calibration& calibration() const { return calibration_; }
  const std::filesystem::path& file() const { return file_; }
  /// The last step was made and left: nothing more is to be done.
  bool finished() const { return finished_; }

private:
  void begin(std::size_t step);
  void keep_if_done();
  void go_on();

  std::unique_ptr<Tracker> sensor_;
  Calibration calibration_;
  SetupInput given_;
  std::filesystem::path file_;
  std::unique_ptr<SetupStep> step_;
  std::size_t current_ = 0;
  bool kept_ = false, finished_ = false;
  ButtonPresses presses_;
  std::vector<PoseSample> samples_;
};

}  // namespace insonate
