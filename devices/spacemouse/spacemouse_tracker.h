#pragma once

#include <glm/gtc/quaternion.hpp>

#include <memory>

#include "devices/live/device_source.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A SpaceMouse, which tells no place: how far its cap is pushed is how fast the probe moves. As seen on the screen,
/// with the marker on the left: the cap pushed right moves the probe right, down presses it in, and towards the user
/// moves it out of the picture; turning goes likewise. Begins at the context's start.
class SpaceMouseSource : public DeviceSource {
public:
  /// At full travel; chosen so that the trunk is crossed in a few seconds.
  static constexpr double kMmPerS = 60, kRadPerS = 1;
  /// A cap that is held away from rest reports every 8 ms or so. After so long without a word it counts as let go:
  /// the probe must not run away on a report that was lost.
  static constexpr double kLetGoS = 0.1;
  /// From where it began, so that a cap that is held down loses no probe: more than a patient is long.
  static constexpr double kReachMm = 2000;

  SpaceMouseSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, const Pose& start, double speed,
                   std::function<double()> clock_s = steady_now_s);

  bool relative() const override { return true; }

protected:
  void start(Transport& transport, const AttachedDevice& device) override;
  bool take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) override;

private:
  void move(double elapsed_s);

  double speed_;
  glm::dquat rotation_;
  glm::dvec3 began_, translation_;
  glm::dvec3 push_{0}, turn_{0};  ///< in the probe's frame
  std::uint32_t buttons_ = 0;
  double now_s_ = 0;
  double told_s_ = 0;  ///< of the last report of the cap
};

/// spacemouse:[SERIAL][?speed=1], with speeds from 0.1 to 10. Throws InputError.
std::unique_ptr<RawSource> make_spacemouse(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
