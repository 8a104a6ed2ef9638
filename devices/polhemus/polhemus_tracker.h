#pragma once

#include <memory>
#include <vector>

#include "devices/live/device_source.h"
#include "devices/live/placement.h"
#include "devices/polhemus/polhemus_stream.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// One sensor of a Polhemus Patriot, Patriot HS, Liberty HS or Viper. The tracker's frame has +x forward, +y right and
/// +z down from the source; its own hemisphere setting stays as it is.
class PolhemusSource : public DeviceSource {
public:
  struct Options {
    std::uint32_t sensor = 0;  ///< from 0
    /// Readings that the device grades worse are `invalid`; its own scale, 0 to 255 for a Viper.
    std::uint32_t most_distortion = 0xffffffff;
  };

  PolhemusSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, const Options& options,
                 const Placement& placement, std::function<double()> clock_s = steady_now_s);

  std::optional<glm::dvec3> origin() const override { return placement_.origin(); }

protected:
  void start(Transport& transport, const AttachedDevice& device) override;
  void stop(Transport& transport) override;
  bool take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) override;

private:
  Options options_;
  Placement placement_;
  PolhemusStream stream_;
  std::vector<PolhemusRecord> records_;
  ReportNumbers numbers_{std::uint64_t{1} << 32};
  bool viper_ = false;
};

/// polhemus:[SERIAL][?sensor=1&distortion=20&raw=1]. Throws InputError.
std::unique_ptr<RawSource> make_polhemus(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
