#include "devices/hydra/hydra_tracker.h"

#include "devices/hid/hid_bus.h"
#include "devices/hydra/hydra_report.h"
#include "devices/live/probe_buttons.h"

namespace insonate {
namespace {

constexpr DeviceKind::Model kHydraModels[] = {{0x1532, 0x0300, "Razer Hydra"}};
// The bumper, and the buttons 1 and 2.
constexpr ButtonMeaning kHydraButtons[] = {{0, kFreezeButton}, {2, kEventMarkerButton}, {3, kContinueButton}};

}  // namespace

const DeviceKind kHydraDevice{.name = "Razer Hydra", .models = kHydraModels, .interface_number = 0};

HydraSource::HydraSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, std::size_t handset,
                         const Placement& placement, std::function<double()> clock_s)
    : MagneticSource(kHydraDevice, std::move(bus), serial, placement, std::move(clock_s)), handset_(handset) {}

void HydraSource::start(Transport& transport, const AttachedDevice&) {
  transport.send(hydra_mode(true));
  numbers_.restart();
}

void HydraSource::stop(Transport& transport) {
  transport.send(hydra_mode(false));
}

bool HydraSource::take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) {
  if (bytes.empty()) return false;
  const Parsed<HydraReport> parsed = parse_hydra(bytes);
  tally.count(parsed.fault);
  if (parsed.fault != ReportFault::none) return false;
  if (!numbers_.is_new(parsed.report.sequence, tally)) return true;
  const SensorReading& reading = parsed.report.handsets[handset_].reading;
  ProbeSample sample{time_s, reading.status, {}, probe_buttons(kHydraButtons, reading.buttons)};
  if (reading.status == PoseStatus::ok)
    sample.patient_from_probe = placement_.patient_from_probe(reading.tracker_from_sensor);
  batch.samples.push_back(sample);
  return true;
}

std::unique_ptr<RawSource> make_hydra(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({"handset", "raw"});
  const auto handset = std::size_t(uri.number("handset", 1, 1, 2)) - 1;
  return std::make_unique<HydraSource>(std::make_shared<HidBus>(), uri.subject, handset,
                                       Placement(context.start, uri.flag("raw", false)));
}

}  // namespace insonate
