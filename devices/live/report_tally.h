#pragma once

#include <cstdint>
#include <string>

#include "devices/report.h"

namespace insonate {

/// What became of a device's reports since its tracker was opened.
struct ReportTally {
  std::uint64_t taken = 0;
  std::uint64_t cut = 0;      ///< too short or too long
  std::uint64_t foreign = 0;  ///< not what such a tracker sends
  std::uint64_t corrupt = 0;
  std::uint64_t repeated = 0;
  std::uint64_t late = 0;    ///< came after a newer one
  std::uint64_t missed = 0;  ///< never came, by the device's own numbering

  void count(ReportFault fault);
  std::uint64_t incidents() const { return cut + foreign + corrupt + repeated + late + missed; }
  /// "3 corrupt, 5 missed"; empty without incidents.
  std::string incidents_in_words() const;
};

/// Follows the number that a device gives to each report.
class ReportNumbers {
public:
  /// The numbers run from 0 to `modulus` - 1 and begin again; at most 2^32.
  explicit ReportNumbers(std::uint64_t modulus) : modulus_(modulus) {}

  /// Whether the report with this number is to be used: not one that has come before or comes after a newer one. A
  /// device that began to count anew is followed after kStubborn reports. Counts in `tally`.
  bool is_news(std::uint64_t number, ReportTally& tally);

  /// The next number is taken as it comes: the device was opened again.
  void restart() { any_ = false; }

private:
  static constexpr int kStubborn = 8;

  std::uint64_t modulus_;
  std::uint64_t last_ = 0;
  bool any_ = false;
  int late_in_a_row_ = 0;
};

}  // namespace insonate
