#include "devices/osvr/osvr_tracker.h"

#include "devices/hid/hid_bus.h"

namespace insonate {
namespace {

constexpr DeviceKind::Model kOsvrModels[] = {
    {0x1532, 0x0b00, "OSVR HDK head tracker", "reports orientation only"},
    {0x03eb, 0x2421, "OSVR HDK head tracker", "reports orientation only"},
};

/// 180 degrees about z. The sensor's x is right and its y up; the probe's x points to the marker, on the left, and its
/// y down the beam.
const glm::dquat kProbeFromSensor(0, 0, 0, 1);

}  // namespace

const DeviceKind kOsvrDevice{.name = "OSVR head tracker", .models = kOsvrModels};

OsvrSource::OsvrSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, const Pose& start,
                       std::function<double()> clock_s)
    : DeviceSource(kOsvrDevice, std::move(bus), serial, std::move(clock_s)), start_(start) {}

void OsvrSource::start(Transport&, const AttachedDevice&) {
  numbers_.restart();
}

bool OsvrSource::take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) {
  if (bytes.empty()) return false;
  const Parsed<OsvrReport> parsed = parse_osvr(bytes);
  tally.count(parsed.fault);
  if (parsed.fault != ReportFault::none) return false;
  if (!numbers_.is_new(parsed.report.sequence, tally)) return true;
  if (!sensor_from_world_) sensor_from_world_ = glm::conjugate(parsed.report.world_from_sensor);
  const glm::dquat turned =
      kProbeFromSensor * *sensor_from_world_ * parsed.report.world_from_sensor * glm::conjugate(kProbeFromSensor);
  batch.samples.push_back(
      {time_s, PoseStatus::ok, {start_.rotation * glm::mat3_cast(glm::normalize(turned)), start_.translation}, 0});
  return true;
}

std::unique_ptr<RawSource> make_osvr(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({});
  return std::make_unique<OsvrSource>(std::make_shared<HidBus>(), uri.subject, context.start);
}

}  // namespace insonate
