#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/calibration/calibration.h"
#include "devices/calibration/sensor_sample.h"
#include "devices/calibration/setup_input.h"
#include "sim/core/button_presses.h"

namespace insonate {

/// What a step of the set-up shows at one moment, in words for the person who holds the probe.
struct SetupView {
  std::string title;     ///< "Probe tip"
  std::string task;      ///< what to do now
  std::string feedback;  ///< the progress of the task
  std::string refusal;   ///< why the last attempt did not count; empty if it did
  std::string result;    ///< what was found, when done
  double share = 0;      ///< fraction of the step that is done, from 0 to 1
  std::size_t part = 0;  ///< index of the next move, touch or knock, from 0, if the step has several
  bool reading = false;  ///< samples are being read: hold still, or pivot
  bool done = false;
  std::optional<glm::dvec3> landmark_mm;  ///< the landmark to touch, patient mm, if the step asks for one
};

/// A step of the set-up while it is being made. A terminal or a window shows its view to the user. It receives every
/// sample of the tracker, in order. The user sets marks with a key, a click or a button of the tracker; the step
/// detects that button itself. Times are those of the samples. A step stores a copy of the calibration that it builds
/// on.
class SetupStep {
public:
  virtual ~SetupStep() = default;
  SetupStep(const SetupStep&) = delete;
  SetupStep& operator=(const SetupStep&) = delete;

  /// Takes the next sample.
  void feed(const SensorSample& sample);
  /// Sets a mark, at a time on the tracker's clock.
  virtual void mark(double time_s) = 0;
  /// Removes the last mark, or restarts the step if it is done.
  virtual void undo() = 0;
  virtual SetupView view() const = 0;
  /// Stores the result in a calibration, once done.
  /// @param now_s  seconds since 1970
  virtual void store(Calibration& calibration, std::int64_t now_s) const = 0;

protected:
  explicit SetupStep(const Calibration& base) : base_(base) {}
  virtual void take(const SensorSample& sample) = 0;

  const Calibration base_;

private:
  ButtonPresses presses_{0};  // a step may begin with a mark
};

/// Input that the steps may need besides the tracker.
struct SetupInput {
  std::optional<LandmarkList> landmarks{};
  std::optional<ProbeDrawing> drawing{};  ///< with it the face does not have to be touched
  bool moved = false;                     ///< only the tracker's base or the mannequin was moved since the last set-up
};

/// The names of the steps in the order in which they are made.
inline constexpr std::array<std::string_view, 5> kSetupSteps{"axes", "pivot", "face", "landmarks", "lag"};

/// Returns which earlier step is missing for a step to begin, as a sentence; empty if it can begin.
std::string why_not_yet(std::string_view step, const Calibration& base, const SetupInput& given);

/// Begins a step for which why_not_yet() is empty. Throws std::invalid_argument for an unknown name.
std::unique_ptr<SetupStep> begin_setup_step(std::string_view step, const Calibration& base, const SetupInput& given);

}  // namespace insonate
