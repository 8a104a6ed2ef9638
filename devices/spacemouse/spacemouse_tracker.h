#pragma once

#include <glm/gtc/quaternion.hpp>

#include <memory>

#include "devices/live/device_source.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A SpaceMouse as a probe. It measures no position: the displacement of its cap sets the probe's velocity. As seen on
/// the screen with the marker on the left: the cap pushed right moves the probe right, pushed down presses it in, and
/// pushed towards the user moves it out of the picture. Rotations correspond likewise. The probe begins at the
/// context's start.
class SpaceMouseSource : public DeviceSource {
public:
  /// Speeds at full travel, chosen so that the probe crosses the trunk in a few seconds.
  static constexpr double kMmPerS = 60, kRadPerS = 1;
  /// A displaced cap reports about every 8 ms. After this long without a report it counts as released: the probe must
  /// not run away because a report was lost.
  static constexpr double kLetGo_s = 0.1;
  /// Largest distance from the start, so that a cap that is held down does not lose the probe: more than a patient's
  /// length.
  static constexpr double kRange_mm = 2000;

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
  double reported_s_ = 0;  ///< time of the cap's last report
};

/// Its models, whose numbers the devices' public drivers and their makers' manuals give.
extern const DeviceKind kSpaceMouseDevice;

/// Makes spacemouse:[SERIAL][?speed=1], with a speed factor from 0.1 to 10. Throws InputError.
std::unique_ptr<RawSource> make_spacemouse(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
