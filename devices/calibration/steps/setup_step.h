#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/calibration/calibration.h"
#include "devices/calibration/given.h"
#include "sim/core/button_presses.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// What a step of the set-up shows at any moment, in words for whoever holds the probe.
struct SetupView {
  std::string title;     ///< "Probe tip"
  std::string task;      ///< what to do now
  std::string feedback;  ///< what comes of it, as it goes
  std::string refusal;   ///< why the last try did not count; empty when it did
  std::string result;    ///< what was found, once done
  double share = 0;      ///< of the step, from 0 to 1
  std::size_t part = 0;  ///< which of its moves, touches or blows is the next, from 0; where it has such
  bool reading = false;  ///< samples are being taken: hold still, or pivot
  bool done = false;
};

/// A step of the set-up as it is being made, told to people by whoever shows its view: a terminal or a window. It is
/// fed every sample of the tracker, in order, and told when its person says "now": by a key, a click, or a button of
/// the tracker, which it sees by itself. Time is the samples'. Steps keep a copy of the calibration they build upon.
class SetupStep {
public:
  virtual ~SetupStep() = default;
  SetupStep(const SetupStep&) = delete;
  SetupStep& operator=(const SetupStep&) = delete;

  /// The tracker's own pose is in the sample's patient_from_probe: tracker_from_sensor.
  void feed(const PoseSample& sample);
  /// "Now", on the tracker's clock.
  virtual void mark(double time_s) = 0;
  /// Takes the last mark back, or begins the step again when it is done.
  virtual void undo() = 0;
  virtual SetupView view() const = 0;
  /// Puts what was found into a calibration, once done. @param now_s  seconds since 1970
  virtual void store(Calibration& calibration, std::int64_t now_s) const = 0;

protected:
  explicit SetupStep(const Calibration& base) : base_(base) {}
  virtual void take(const PoseSample& sample) = 0;

  const Calibration base_;

private:
  ButtonPresses presses_{0};  // a step may begin with a mark
};

/// What the steps may need beside the tracker.
struct SetupGiven {
  std::optional<LandmarkList> landmarks{};
  std::optional<ProbeDrawing> drawing{};  ///< with it the face is not touched
  bool moved = false;                     ///< only the tracker's base or the mannequin was moved since the last time
};

/// The steps by name, in the order in which they are made: "axes", "pivot", "face", "landmarks", "lag".
inline constexpr std::array<std::string_view, 5> kSetupSteps{"axes", "pivot", "face", "landmarks", "lag"};

/// What a step has to be made after and is missing, as a sentence; empty when it can begin.
std::string why_not_yet(std::string_view step, const Calibration& base, const SetupGiven& given);

/// Begins a step that why_not_yet() lets begin. Throws std::invalid_argument for a name that is none.
std::unique_ptr<SetupStep> begin_setup_step(std::string_view step, const Calibration& base, const SetupGiven& given);

}  // namespace insonate
