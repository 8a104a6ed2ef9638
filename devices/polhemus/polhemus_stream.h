#pragma once

#include <cstdint>
#include <vector>

#include "devices/report.h"

namespace insonate {

/// As many as a Viper has, more than the others.
inline constexpr std::uint32_t kMaxPolhemusSensors = 16;

/// A sensor's pose as a Polhemus Patriot, Liberty or Viper sends it.
struct PolhemusRecord {
  std::uint32_t frame = 0;  ///< numbered by the device: one more with each frame; all sensors of a frame share it
  SensorReading reading;
};

/// Extracts the records from the bytes that a Polhemus tracker sends, however they are split into reads.
///
/// Liberty and Patriot send a header of 8 bytes and, after the output list `O*,8,9,11,3,7` and with `U1`, 40 bytes per
/// sensor in centimetres. These records have no checksum, so a flipped bit can pass as a wrong pose. A Viper sends a
/// frame of up to 16 sensors that states its own units, with CRC-16/ARC. Bytes that are not such a record (replies to
/// commands, text, damage) are skipped one by one until a record begins again. The layouts follow the maker's manuals
/// and headers; not tested on hardware.
class PolhemusStream {
public:
  /// Appends the records that `bytes` complete. Stores fewer than 600 bytes between calls.
  void add(Bytes bytes, std::vector<PolhemusRecord>& records);

  /// Returns the number of frames that began correctly and then failed their checksum, or held numbers that are not a
  /// pose.
  std::uint64_t corrupt() const { return corrupt_; }
  /// Returns the number of byte sequences that followed a record and belonged to none: replies, text, noise. Not
  /// counted: those of a corrupt frame, and those before the first record.
  std::uint64_t foreign() const { return foreign_; }
  /// Discards a partial record, because the connection was made anew.
  void restart() {
    kept_.clear();
    in_order_ = false;
  }

private:
  std::vector<std::uint8_t> kept_;
  std::uint64_t corrupt_ = 0;
  std::uint64_t foreign_ = 0;
  bool in_order_ = false;  ///< the last bytes were a record
};

/// Commands for a Viper: a command number, an action, and a payload if the command takes one.
namespace viper {
enum Command : std::uint32_t { kUnits = 7, kContinuous = 19 };
enum Action : std::uint32_t { kSet = 0, kReset = 2 };
std::vector<std::uint8_t> command(Command command, Action action, const std::vector<std::uint32_t>& payload = {});
}  // namespace viper

}  // namespace insonate
