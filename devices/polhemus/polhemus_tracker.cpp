#include "devices/polhemus/polhemus_tracker.h"

#include <string_view>

#include "devices/live/probe_buttons.h"
#include "devices/usb/usb_bus.h"

namespace insonate {
namespace {

constexpr std::uint16_t kVendor = 0x0f44, kViper = 0xbf01;
constexpr std::string_view kWaits = "waits for its firmware: load it with the maker's software, then plug in again";
constexpr DeviceKind::Model kPolhemusModels[] = {
    {kVendor, 0xef12, "Polhemus Patriot", "", {0x02, 0x82}},
    {kVendor, 0xef20, "Polhemus Patriot HS", "", {0x04, 0x88}},
    {kVendor, 0xff20, "Polhemus Liberty HS", "", {0x04, 0x88}},
    {kVendor, kViper, "Polhemus Viper", "", {0x02, 0x81}},
    {kVendor, 0xef11, "Polhemus tracker", kWaits, {}, false},
    {kVendor, 0xef21, "Polhemus tracker", kWaits, {}, false},
    {kVendor, 0xff11, "Polhemus tracker", kWaits, {}, false},
    {kVendor, 0xff21, "Polhemus tracker", kWaits, {}, false},
    {kVendor, 0x0001, "Polhemus tracker", kWaits, {}, false},
};
constexpr ButtonMeaning kPolhemusButtons[] = {{0, kFreezeButton},
                                              {1, kEventMarkerButton}};  // a stylus has one button or two

void send(Transport& transport, std::string_view text) {
  transport.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

const DeviceKind kPolhemusDevice{.name = "Polhemus tracker", .bus = Bus::usb, .models = kPolhemusModels};

PolhemusSource::PolhemusSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, std::uint32_t sensor,
                               const Placement& placement, std::function<double()> clock_s)
    : MagneticSource(kPolhemusDevice, std::move(bus), serial, placement, std::move(clock_s)), sensor_(sensor) {}

void PolhemusSource::start(Transport& transport, const AttachedDevice& device) {
  viper_ = device.product == kViper;
  if (viper_) {
    constexpr std::uint32_t kCentimetres = 2, kQuaternions = 2;
    transport.send(viper::command(viper::kUnits, viper::kSet, {kCentimetres, kQuaternions}));
    transport.send(viper::command(viper::kContinuous, viper::kSet));
  } else {
    // Stop any output; binary; centimetres; output list: header, time, frame, distortion, position and quaternion; do
    // not wait for full USB buffers; then send continuously.
    for (const char* command : {"P\r", "F1\r", "U1\r", "O*,8,9,11,3,7\r", "@B0\r", "C\r"}) send(transport, command);
  }
  stream_.restart();
  numbers_.restart();
  others_ = 0;
  sensor_s_.reset();
}

void PolhemusSource::stop(Transport& transport) {
  if (viper_)
    transport.send(viper::command(viper::kContinuous, viper::kReset));
  else
    send(transport, "P\r");
}

bool PolhemusSource::take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) {
  records_.clear();
  const std::uint64_t corrupt = stream_.corrupt(), foreign = stream_.foreign();
  stream_.add(bytes, records_);
  tally.corrupt += stream_.corrupt() - corrupt;
  tally.foreign += stream_.foreign() - foreign;
  tally.taken += records_.size();
  for (const PolhemusRecord& record : records_) {
    const SensorReading& reading = record.reading;
    if (reading.sensor == sensor_ || !sensor_s_) sensor_s_ = time_s;
    if (reading.sensor != sensor_) {
      if (reading.sensor < kMaxPolhemusSensors) others_ |= 1u << reading.sensor;
      continue;
    }
    if (!numbers_.is_new(record.frame, tally)) continue;
    ProbeSample sample{
        time_s, reading.status, {}, probe_buttons(kPolhemusButtons, reading.buttons), reading.distortion};
    if (sample.status == PoseStatus::ok)
      sample.patient_from_probe = placement_.patient_from_probe(reading.tracker_from_sensor);
    batch.samples.push_back(sample);
  }
  if (others_ != 0 && time_s - sensor_s_.value_or(time_s) > kSensorMissing_s) batch.note = missing_sensor();
  return !records_.empty();
}

std::string PolhemusSource::missing_sensor() const {
  std::string others;
  for (std::uint32_t i = 0; i < kMaxPolhemusSensors; ++i)
    if ((others_ >> i & 1) != 0) others += (others.empty() ? "" : ", ") + std::to_string(i + 1);
  const std::string wanted = std::to_string(sensor_ + 1);
  return "The Polhemus tracker sends sensor " + others + " but not sensor " + wanted +
         ": plug that in, or follow another, as in 'polhemus:?sensor=" + others.substr(0, others.find(',')) + "'.";
}

std::unique_ptr<RawSource> make_polhemus(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({"sensor", "raw"});
  const auto sensor = std::uint32_t(uri.number("sensor", 1, 1, kMaxPolhemusSensors)) - 1;
  return std::make_unique<PolhemusSource>(std::make_shared<UsbBus>(), uri.subject, sensor,
                                          Placement(context.start, uri.flag("raw", false)));
}

}  // namespace insonate
