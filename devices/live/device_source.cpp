#include "devices/live/device_source.h"

#include <algorithm>
#include <utility>

namespace insonate {
namespace {

/// More than any report: a HID report has 64 bytes, a Viper's largest frame 540.
constexpr std::size_t kRoom = 4096;

/// Returns the model of a device that can be used; nullptr if it is not of this kind or not ready.
const DeviceKind::Model* model_of(const DeviceKind& kind, const AttachedDevice& device) {
  const DeviceKind::Model* model = kind.find(device.vendor, device.product);
  return model && model->usable ? model : nullptr;
}

/// Returns a sentence about a device of this kind that is plugged in but not ready; empty if there is none.
std::string waiting_device(const DeviceKind& kind, const AttachedDevices& attached) {
  for (const AttachedDevice& device : attached.devices) {
    const DeviceKind::Model* model = kind.find(device.vendor, device.product);
    if (model && !model->usable)
      return "The " + std::string(model->name) + " at " + device.path + " " + std::string(model->note) + ".";
  }
  return "";
}

/// The transport of a recorded device: sends and reads nothing.
class NoTransport : public Transport {
public:
  std::size_t read(std::span<std::uint8_t>, std::chrono::milliseconds) override { return 0; }
  void send(std::span<const std::uint8_t>) override {}
};

}  // namespace

const DeviceKind::Model* DeviceKind::find(std::uint16_t vendor, std::uint16_t product) const {
  for (const Model& model : models)
    if (model.vendor == vendor && (model.product == kAnyProduct || model.product == product)) return &model;
  return nullptr;
}

AttachedDevice find_device(const DeviceKind& kind, const std::string& serial, const AttachedDevices& attached) {
  const std::string name(kind.name);
  std::string others;
  for (const AttachedDevice& device : attached.devices) {
    if (!model_of(kind, device)) continue;
    const bool other_interface =
        kind.interface_number >= 0 && device.interface_number >= 0 && device.interface_number != kind.interface_number;
    if (other_interface) continue;
    if (serial.empty() || device.serial == serial) return device;
    others += (others.empty() ? "" : ", ") + (device.serial.empty() ? "one without a number" : device.serial);
  }
  std::string sentence = waiting_device(kind, attached);
  if (!others.empty())
    sentence = "No " + name + " has the serial number " + serial + ": plugged in is " + others + ".";
  else if (!attached.problem.empty())
    sentence = "The " + name + " cannot be looked for: " + attached.problem + ".";
  else if (sentence.empty())
    sentence = "The " + name + " is not plugged in.";
  throw TransportError(TransportFault::absent, sentence);
}

DeviceSource::DeviceSource(const DeviceKind& kind, std::shared_ptr<DeviceBus> bus, std::string serial,
                           std::function<double()> clock_s)
    : kind_(kind), bus_(std::move(bus)), serial_(std::move(serial)), clock_s_(std::move(clock_s)), buffer_(kRoom) {}

void DeviceSource::open() {
  const AttachedDevice device = find_device(kind_, serial_, bus_->devices());
  std::unique_ptr<Transport> transport = bus_->open(device, model_of(kind_, device)->endpoints);
  start(*transport, device);
  const double now_s = clock_s_();
  if (tap()) tap()->opened(device, now_s);
  begin(device, std::move(transport), now_s);
}

void DeviceSource::begin(const AttachedDevice& device, std::unique_ptr<Transport> transport, double time_s) {
  device_ = device;
  transport_ = std::move(transport);
  asked_s_ = heard_s_ = time_s;
  started_ = false;
  starts_ = 1;
  problem_.clear();
}

bool DeviceSource::replay_open(const AttachedDevice& device, double time_s) {
  if (!model_of(kind_, device)) return false;
  auto transport = std::make_unique<NoTransport>();
  start(*transport, device);
  begin(device, std::move(transport), time_s);
  return true;
}

void DeviceSource::read(std::chrono::milliseconds timeout, LiveBatch& batch) {
  const std::size_t got = transport_->read(buffer_, timeout);
  const double now_s = clock_s_();
  const Bytes bytes = Bytes(buffer_).first(got);
  if (tap()) tap()->came(bytes, now_s);
  replay_read(bytes, now_s, batch);
}

void DeviceSource::replay_read(Bytes bytes, double time_s, LiveBatch& batch) {
  if (take(bytes, time_s, batch, tally_)) {
    started_ = true;
    heard_s_ = time_s;
  }
  if (kind_.steady && time_s - std::max(asked_s_, heard_s_) >= kStart_s) {
    asked_s_ = time_s;
    ++starts_;
    start(*transport_, device_);
  }
  if (const std::string message = note(time_s); !message.empty()) batch.note = message;
}

std::string DeviceSource::note(double now_s) {
  const std::string name(kind_.name);
  if (kind_.steady && now_s - heard_s_ >= kStart_s)
    return "The " + name + " is plugged in but sends no poses, and was started " + std::to_string(starts_) +
           " times: unplug it and plug it in again.";
  // Each change would be a new message. So the counts are updated only with the first incident after a pause.
  if (started_ && tally_.incidents() != incidents_) {
    if (problem_.empty())
      problem_ = "Reports of the " + name + " were damaged or lost: " + tally_.incidents_in_words() + " so far.";
    incident_s_ = now_s;
  } else if (now_s - incident_s_ >= kIncidentShown_s) {
    problem_.clear();
  }
  incidents_ = tally_.incidents();
  return problem_;
}

void DeviceSource::close() noexcept {
  try {
    stop(*transport_);
  } catch (const std::exception&) {
    // The device is gone, or keeps its mode. The next start handles both.
  }
  transport_.reset();
}

}  // namespace insonate
