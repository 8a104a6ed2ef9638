#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/live/magnetic_source.h"
#include "devices/polhemus/polhemus_stream.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// One sensor of a Polhemus Patriot, Patriot HS, Liberty HS or Viper. The tracker's frame has +x forward, +y right and
/// +z down from the source. The device's own hemisphere setting is not changed.
class PolhemusSource : public MagneticSource {
public:
  /// Users are informed if the sensor has been missing for this long while others arrive.
  static constexpr double kSensorMissing_s = 2;

  /// `sensor` counts from 0.
  PolhemusSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, std::uint32_t sensor,
                 const Placement& placement, std::function<double()> clock_s = steady_now_s);

protected:
  void start(Transport& transport, const AttachedDevice& device) override;
  void stop(Transport& transport) override;
  bool take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) override;

private:
  std::string missing_sensor() const;

  std::uint32_t sensor_;
  PolhemusStream stream_;
  std::vector<PolhemusRecord> records_;
  ReportNumbers numbers_{std::uint64_t{1} << 32};
  bool viper_ = false;
  std::uint32_t others_ = 0;        ///< other sensors that arrived, one bit each
  std::optional<double> sensor_s_;  ///< when the sensor last arrived, or else when another sensor first did
};

/// Its models, whose numbers the devices' public drivers and their makers' manuals give.
extern const DeviceKind kPolhemusDevice;

/// Makes polhemus:[SERIAL][?sensor=1&raw=1]. Throws InputError.
std::unique_ptr<RawSource> make_polhemus(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
