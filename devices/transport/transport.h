#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "devices/transport/attached_device.h"
#include "devices/transport/source_gone.h"

namespace insonate {

enum class TransportFault {
  absent,     ///< not plugged in
  forbidden,  ///< plugged in, but this user may not open it
  busy,       ///< another program uses it
  gone,       ///< was open and is lost; it may be available again at once
  refused,    ///< plugged in, but it does not do what was asked
};

/// An error of a device on a bus.
class TransportError : public SourceGone {
public:
  TransportError(TransportFault fault, const std::string& sentence) : SourceGone(sentence), fault_(fault) {}
  TransportFault fault() const { return fault_; }

private:
  TransportFault fault_;
};

/// An open device, closed when it is destroyed. Used by one thread.
class Transport {
public:
  virtual ~Transport() = default;

  /// Waits for bytes and returns how many it wrote to `into`. It waits at most `timeout`, but always for a short time.
  /// From a HID device it reads one report, cut to the size of `into`. Returns 0 if no bytes arrived in time. Throws
  /// TransportError, with fault `gone` also where the device is only possibly gone.
  virtual std::size_t read(std::span<std::uint8_t> into, std::chrono::milliseconds timeout) = 0;

  /// Sends bytes: to a HID device as a feature report whose first byte is its number, to another device through its OUT
  /// endpoint. Throws TransportError.
  virtual void send(std::span<const std::uint8_t> bytes) = 0;
};

/// The bulk endpoints of a device that is not a HID device, as its descriptors number them.
struct Endpoints {
  std::uint8_t out = 0;
  std::uint8_t in = 0;
};

/// A bus that devices are plugged into. The tests have their own implementation.
class DeviceBus {
public:
  virtual ~DeviceBus() = default;
  virtual AttachedDevices devices() = 0;
  /// Opens a device. Throws TransportError. A HID device ignores `endpoints`.
  virtual std::unique_ptr<Transport> open(const AttachedDevice& device, Endpoints endpoints) = 0;
};

/// Returns the error for a device that this user may not open, with the udev rule that allows it.
TransportError forbidden(const AttachedDevice& device);
/// Returns the error for a device that another program uses.
TransportError busy(const AttachedDevice& device);
/// Returns the error for a device that was lost; `why` is the operating system's reason.
TransportError gone(const AttachedDevice& device, const std::string& why);
/// Returns the error for a device that does not do what was asked.
TransportError refused(const AttachedDevice& device, const std::string& why);

}  // namespace insonate
