#pragma once

#include <cstdint>
#include <vector>

#include "devices/report.h"

namespace insonate {

/// A sensor's pose as a Polhemus Patriot, Liberty or Viper sends it.
struct PolhemusRecord {
  std::uint32_t frame = 0;  ///< of the device, one more with each frame; sensors of a frame share it
  SensorReading reading;
};

/// Takes the records out of the bytes that a Polhemus tracker sends, however they are cut into portions.
///
/// Liberty and Patriot: a header of 8 bytes and, after the output list `O*,8,9,11,3,7` and with `U1`, 40 bytes a sensor
/// in centimetres. They have no checksum, so that a flipped bit can pass as a wrong pose. Viper: a frame of up to 16
/// sensors that tells its own units, with CRC-16/ARC. What is no such record (replies to commands, text, damage) is
/// passed over byte by byte until a record begins again. Layouts as the maker's manuals and headers give them; not
/// tried on hardware.
class PolhemusStream {
public:
  /// Appends the records that `bytes` complete. Keeps fewer than 600 bytes between calls.
  void add(Bytes bytes, std::vector<PolhemusRecord>& records);

  /// Frames that began as one and then failed their checksum, or held no pose where only a pose can be.
  std::uint64_t corrupt() const { return corrupt_; }
  /// Stretches of bytes behind a record that belonged to none: replies, text, noise. Not those of a corrupt frame, nor
  /// those that come before the first record.
  std::uint64_t foreign() const { return foreign_; }
  /// Forgets a record begun: the connection was made anew.
  void restart() {
    kept_.clear();
    in_order_ = false;
  }

private:
  std::vector<std::uint8_t> kept_;
  std::uint64_t corrupt_ = 0;
  std::uint64_t foreign_ = 0;
  bool in_order_ = false;  ///< what came last was a record
};

/// What is sent to a Viper: its command's number, an action, and a payload if it takes one.
namespace viper {
enum Command : std::uint32_t { kUnits = 7, kContinuous = 19 };
enum Action : std::uint32_t { kSet = 0, kReset = 2 };
std::vector<std::uint8_t> command(Command command, Action action, const std::vector<std::uint32_t>& payload = {});
}  // namespace viper

}  // namespace insonate
