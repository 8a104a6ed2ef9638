#pragma once

#include <memory>
#include <optional>

#include "devices/live/device_source.h"
#include "devices/osvr/osvr_report.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// The head tracker of an OSVR HDK as a probe that turns on the spot, the start's or where it is put
/// (Tracker::relative): it tells no place. Held with its y
/// axis up and its z axis towards the user when it is opened, it is the probe at its start; from there its turns are
/// the probe's. About the vertical it drifts, as nothing but gravity corrects it.
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

/// osvr:[SERIAL]. Throws InputError.
std::unique_ptr<RawSource> make_osvr(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
