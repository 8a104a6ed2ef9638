#pragma once

#include <memory>
#include <optional>

#include "devices/live/device_source.h"
#include "devices/osvr/osvr_report.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// The head tracker of an OSVR HDK as a probe that rotates on the spot: at its start, or where it is put
/// (Tracker::relative). It measures no position. The sensor is held with its y axis up and its z axis towards the user
/// when it is opened; the probe is then at its start orientation. From there the sensor's rotations are the probe's.
/// The rotation about the vertical drifts, because only gravity corrects the sensor.
class OsvrSource : public DeviceSource {
public:
  OsvrSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, const Pose& start,
             std::function<double()> clock_s = steady_now_s);

  bool relative() const override { return true; }

protected:
  void start(Transport& transport, const AttachedDevice& device) override;
  bool take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) override;

private:
  Pose start_;
  std::optional<glm::dquat> sensor_from_world_;  ///< at the first report
  ReportNumbers numbers_{256};
};

/// Its models, whose numbers the devices' public drivers and their makers' manuals give.
extern const DeviceKind kOsvrDevice;

/// Makes osvr:[SERIAL]. Throws InputError.
std::unique_ptr<RawSource> make_osvr(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
