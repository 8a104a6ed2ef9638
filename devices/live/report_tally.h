#pragma once

#include <cstdint>
#include <string>

#include "devices/report.h"

namespace insonate {

/// Counts a device's reports since its tracker was opened, by what became of them.
struct ReportTally {
  std::uint64_t taken = 0;
  std::uint64_t cut = 0;      ///< too short or too long
  std::uint64_t foreign = 0;  ///< not what such a tracker sends
  std::uint64_t corrupt = 0;
  std::uint64_t repeated = 0;
  std::uint64_t late = 0;    ///< arrived after a newer one
  std::uint64_t missed = 0;  ///< never arrived, by the device's own numbering

  void count(ReportFault fault);
  std::uint64_t incidents() const { return cut + foreign + corrupt + repeated + late + missed; }
  /// Returns "3 corrupt, 5 missed", for example; empty if there were no incidents.
  std::string incidents_in_words() const;
};

/// Follows the numbers that a device gives to its reports.
class ReportNumbers {
public:
  /// The numbers run from 0 to `modulus` - 1 and start over; `modulus` is at most 2^32.
  explicit ReportNumbers(std::uint64_t modulus) : modulus_(modulus) {}

  /// Returns whether the report with this number is new. It is not if it arrived before or is older than the newest
  /// one. A device that restarted its numbering is accepted after kStubborn reports. Counts in `tally`.
  bool is_new(std::uint64_t number, ReportTally& tally);

  /// Accepts any next number: the device was opened again.
  void restart() { any_ = false; }

private:
  static constexpr int kStubborn = 8;

  std::uint64_t modulus_;
  std::uint64_t last_ = 0;
  bool any_ = false;
  int late_in_a_row_ = 0;
};

}  // namespace insonate
