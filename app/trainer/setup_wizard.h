#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "devices/calibration/steps/setup_step.h"
#include "devices/sensor_tracker.h"

namespace insonate {

/// Sets up a tracker step by step, for a window to show. It owns the tracker meanwhile, so no session can use it. It
/// writes the calibration after every step, so that closing it loses nothing. Time is passed in.
class SetupWizard {
public:
  /// Begins with the first step that has not been made.
  /// @param base    the calibration so far; its steps are kept until they are made again
  /// @param given   landmarks, and the probe's drawing if there is one
  /// @param file    where the calibration is written
  SetupWizard(SensorTracker sensor, Calibration base, SetupInput given, std::filesystem::path file);

  /// Processes the tracker's samples up to `now_s`. Throws InputError if the file cannot be written.
  void update(double now_s);

  /// Marks the pose at `now_s`; if the step is done, goes on to the next. A button of the tracker does the same.
  void mark(double now_s);
  /// Removes the last mark; if the step is done, begins it again.
  void undo();
  /// Leaves the step as it was and goes to another. Does nothing if why_not() gives a reason.
  /// @param step  index into kSetupSteps
  void go_to(std::size_t step);
  std::string why_not(std::size_t step) const;

  /// Returns whether landmarks that were touched before can be found again after the base or the mannequin was moved.
  bool can_be_moved() const { return calibration_.mannequin.has_value(); }
  bool moved() const { return given_.moved; }
  /// Begins the landmarks again: those that were touched last (`moved`), or the patient's.
  void set_moved(bool moved);

  struct Row {
    std::string_view name;  ///< of kSetupSteps
    std::string title;
    std::string figure;  ///< the step's result in short; empty if it has not been made
  };
  std::vector<Row> rows() const;
  /// Returns the title of a step of kSetupSteps; empty for any other name.
  std::string title_of(std::string_view name) const;
  std::size_t current() const { return current_; }
  SetupView view() const { return step_->view(); }
  /// Returns what the made-up hand of a rehearsal does, a sentence; empty with any other tracker.
  const std::string& rehearsal() const { return rehearsal_; }
  /// Returns the places of the body that the step `landmarks` asks for, in its order.
  std::vector<LandmarkPair> landmarks() const;

  TrackerState tracker_state() const { return sensor_.tracker().state(); }
  const Calibration& calibration() const { return calibration_; }
  const std::filesystem::path& file() const { return file_; }
  /// Returns whether blows may still come after the last step's end. They do not go on, so that the page can be read.
  bool strikes_on() const;
  /// Returns whether the last step has been made and left.
  bool finished() const { return finished_; }

private:
  void begin(std::size_t step);
  void keep_if_done();
  void go_on();

  SensorTracker sensor_;
  Calibration calibration_;
  SetupInput given_;
  std::filesystem::path file_;
  std::unique_ptr<SetupStep> step_;
  std::size_t current_ = 0;
  bool kept_ = false, finished_ = false;
  double now_s_ = 0, kept_s_ = 0;  ///< of update(), and when the step was done or a blow came after it
  ButtonPresses presses_;
  std::vector<SensorSample> samples_;
  std::string rehearsal_;
};

}  // namespace insonate
