#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "devices/bytes.h"
#include "devices/live/raw_source.h"
#include "devices/live/report_tally.h"
#include "devices/live/steady_clock.h"
#include "devices/transport/transport.h"

namespace insonate {

/// Which devices on a bus a tracker can use, and what people call them.
struct DeviceKind {
  struct Model {
    std::uint16_t vendor;
    std::uint16_t product;  ///< or kAnyProduct
    Endpoints endpoints{};
  };
  std::string_view name;  ///< "Razer Hydra"
  std::span<const Model> models;
  int interface_number = -1;  ///< the HID's that sends poses; -1 for a device with one
  bool steady = true;         ///< sends without end, so that silence is a fault
};

/// The device that a tracker is to use: the first of its kind that is plugged in, or the one with the serial number.
/// Throws TransportError, `absent`, with the sentence that says what is there instead: nothing, other serial numbers,
/// or a device that waits for its firmware.
AttachedDevice find_device(const DeviceKind& kind, const std::string& serial, const AttachedDevices& attached);

/// The policy that all trackers on a bus share: find the device, start it, start it again when it says nothing, count
/// what it sends, and let go of it when it is lost. What its bytes mean is for the class that derives.
class DeviceSource : public RawSource {
public:
  /// A device that was told to send and does not is told again after so long. The Hydra needs this long.
  static constexpr double kStartS = 5;
  /// For so long after an incident people are told of it.
  static constexpr double kToldS = 2;

  /// `clock_s` is the tests' to replace.
  DeviceSource(const DeviceKind& kind, std::shared_ptr<DeviceBus> bus, std::string serial,
               std::function<double()> clock_s = steady_now_s);

  std::string name() const final { return std::string(kind_.name) + std::string(remark()); }
  void open() final;
  void read(std::chrono::milliseconds timeout, LiveBatch& batch) final;
  void close() noexcept final;
  bool replay_open(const AttachedDevice& device, double time_s) final;
  void replay_read(Bytes bytes, double time_s, LiveBatch& batch) final;

  const ReportTally& tally() const { return tally_; }

protected:
  /// What follows the device's name, for people.
  virtual std::string_view remark() const { return ""; }

  /// Sends what makes the device send poses. Called when it was opened, and again whenever it has been silent for
  /// kStartS. Throws TransportError.
  virtual void start(Transport& transport, const AttachedDevice& device) = 0;

  /// Sends what ends it. May throw: nobody minds.
  virtual void stop(Transport&) {}

  /// Takes what one read brought, which is nothing when the time ran out; `time_s` is when it came. Appends samples and
  /// counts in `tally`; what else people should know goes into the batch's note. Returns whether it was what the device
  /// sends once it has started.
  virtual bool take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) = 0;

private:
  void begin(const AttachedDevice& device, std::unique_ptr<Transport> transport, double time_s);
  std::string note(double now_s);

  DeviceKind kind_;
  std::shared_ptr<DeviceBus> bus_;
  std::string serial_;
  std::function<double()> clock_s_;
  ReportTally tally_;
  AttachedDevice device_;
  std::unique_ptr<Transport> transport_;
  std::vector<std::uint8_t> buffer_;
  double asked_s_ = 0;    ///< when it was last told to send
  double heard_s_ = 0;    ///< when it last sent what it should
  bool started_ = false;  ///< whether it ever did since it was opened
  int starts_ = 0;
  std::uint64_t incidents_ = 0;
  double incident_s_ = 0;
  std::string told_;
};

}  // namespace insonate
