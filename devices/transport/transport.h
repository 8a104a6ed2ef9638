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
  forbidden,  ///< there, but this user may not open it
  busy,       ///< another program has it
  gone,       ///< was open and is lost; it may be there again at once
  refused,    ///< there, but it does not do what was asked
};

/// What is wrong with a device on a bus.
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

  /// Waits for bytes, no longer than `timeout` but always for a moment, and returns how many came: of a HID one report,
  /// cut to the room there is. 0 means that none came in time. Throws TransportError, `gone` also where it is only
  /// possible that it is.
  virtual std::size_t read(std::span<std::uint8_t> into, std::chrono::milliseconds timeout) = 0;

  /// Sends bytes: to a HID a feature report with its number first, to another device on its way out. Throws
  /// TransportError.
  virtual void send(std::span<const std::uint8_t> bytes) = 0;
};

/// The bulk endpoints of a device that is no HID, as its descriptors number them.
struct Endpoints {
  std::uint8_t out = 0;
  std::uint8_t in = 0;
};

/// A bus that devices are plugged into. The tests have one of their own.
class DeviceBus {
public:
  virtual ~DeviceBus() = default;
  virtual AttachedDevices devices() = 0;
  /// Throws TransportError. `endpoints` mean nothing to a HID.
  virtual std::unique_ptr<Transport> open(const AttachedDevice& device, Endpoints endpoints) = 0;
};

/// The sentence for a device that this user may not open, with the rule that allows it.
TransportError forbidden(const AttachedDevice& device);
/// The sentence for a device that another program has.
TransportError busy(const AttachedDevice& device);
/// The sentence for a device that was lost, with what the system says of it.
TransportError gone(const AttachedDevice& device, const std::string& why);
/// The sentence for a device that does not do what was asked.
TransportError refused(const AttachedDevice& device, const std::string& why);

}  // namespace insonate
