#pragma once

#include <memory>

#include "devices/live/magnetic_source.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// One handset of a Razer Hydra. The magnetic field looks the same on two sides. So the handset must lie in its dock
/// when the device is started, and a handset that later comes close to the base can come back mirrored.
class HydraSource : public MagneticSource {
public:
  HydraSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, std::size_t handset,
              const Placement& placement, std::function<double()> clock_s = steady_now_s);

protected:
  void start(Transport& transport, const AttachedDevice& device) override;
  void stop(Transport& transport) override;
  bool take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) override;

private:
  std::size_t handset_;  ///< 0 or 1
  ReportNumbers numbers_{256};
};

/// Its models, whose numbers the devices' public drivers and their makers' manuals give.
extern const DeviceKind kHydraDevice;

/// Makes hydra:[SERIAL][?handset=2&raw=1]. Throws InputError.
std::unique_ptr<RawSource> make_hydra(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
