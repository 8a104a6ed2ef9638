#pragma once

#include <cstdint>
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

enum class Bus { hid, usb };

/// A USB product number that stands for all of a vendor's.
inline constexpr std::uint16_t kAnyProduct = 0;

/// Which devices on a bus a tracker can use, and what users call them. Each tracker's folder has one.
struct DeviceKind {
  struct Model {
    std::uint16_t vendor;
    std::uint16_t product;    ///< or kAnyProduct; particular models come before it
    std::string_view name;    ///< "Polhemus Viper"
    std::string_view note{};  ///< what a user should know about it; may be empty
    Endpoints endpoints{};
    bool usable = true;  ///< false: the device has to be made ready first, as the note says
  };
  std::string_view name;  ///< "Razer Hydra"
  Bus bus = Bus::hid;
  std::span<const Model> models;
  int interface_number = -1;  ///< number of the HID interface that sends poses; -1 for a device with a single interface
  bool steady = true;         ///< true: the device sends continuously, so silence is a fault

  /// Returns the model of a device on this bus, usable or not; nullptr if it is another kind's.
  const Model* find(std::uint16_t vendor, std::uint16_t product) const;
};

/// Returns the device that a tracker uses: the first of its kind that is plugged in, or the one with serial number
/// `serial`. Throws TransportError with fault `absent` if there is none. Its sentence states what is there instead:
/// nothing, other serial numbers, or a device that waits for its firmware.
AttachedDevice find_device(const DeviceKind& kind, const std::string& serial, const AttachedDevices& attached);

/// The behaviour that all trackers on a bus share: find the device, start it, start it again when it is silent, count
/// its reports, and release it when it is lost. The derived class interprets the bytes.
class DeviceSource : public RawSource {
public:
  /// A device that was asked to send and is silent for this long is asked again. The Hydra needs this long to start.
  static constexpr double kStart_s = 5;
  /// Users are informed of an incident for this long.
  static constexpr double kIncidentShown_s = 2;

  /// `clock_s` is replaced by the tests.
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
  /// Text that follows the device's name, for users.
  virtual std::string_view remark() const { return ""; }

  /// Sends the commands that make the device send poses. Called after the device was opened, and again whenever it has
  /// been silent for kStart_s. Throws TransportError.
  virtual void start(Transport& transport, const AttachedDevice& device) = 0;

  /// Sends the commands that stop it. May throw: errors are ignored.
  virtual void stop(Transport&) {}

  /// Parses the bytes of one read, which are empty if the read timed out. `time_s` is their time of arrival. Appends
  /// samples, and counts reports in `tally`. Other facts that users should know go into the batch's note. Returns
  /// whether the bytes are what the device sends once it has started.
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
  double asked_s_ = 0;    ///< when the device was last asked to send
  double heard_s_ = 0;    ///< when it last sent what it should
  bool started_ = false;  ///< whether it has done so since it was opened
  int starts_ = 0;
  std::uint64_t incidents_ = 0;
  double incident_s_ = 0;
  std::string problem_;
};

}  // namespace insonate
