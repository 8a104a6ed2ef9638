#include "devices/live/report_tally.h"

#include <utility>

namespace insonate {

void ReportTally::count(ReportFault fault) {
  switch (fault) {
    case ReportFault::none:
      ++taken;
      break;
    case ReportFault::length:
      ++cut;
      break;
    case ReportFault::header:
      ++foreign;
      break;
    case ReportFault::checksum:
      ++corrupt;
      break;
  }
}

std::string ReportTally::incidents_in_words() const {
  const std::pair<std::uint64_t, const char*> counts[] = {{cut, "cut"},         {foreign, "foreign"},
                                                          {corrupt, "corrupt"}, {repeated, "repeated"},
                                                          {late, "late"},       {missed, "missed"}};
  std::string words;
  for (const auto& [count, name] : counts) {
    if (count == 0) continue;
    if (!words.empty()) words += ", ";
    words += std::to_string(count) + " " + name;
  }
  return words;
}

bool ReportNumbers::is_new(std::uint64_t number, ReportTally& tally) {
  const std::uint64_t ahead = (number + modulus_ - last_) % modulus_;
  if (any_ && ahead == 0) {
    ++tally.repeated;
    return false;
  }
  if (any_ && ahead > modulus_ / 2 && ++late_in_a_row_ < kStubborn) {
    ++tally.late;
    return false;
  }
  // A lasting jump backwards means a device that restarted its numbering, not one that lost half of its reports.
  if (any_ && ahead <= modulus_ / 2) tally.missed += ahead - 1;
  any_ = true;
  late_in_a_row_ = 0;
  last_ = number;
  return true;
}

}  // namespace insonate
