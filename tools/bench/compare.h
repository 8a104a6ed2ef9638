#pragma once

#include <string>
#include <vector>

#include "tools/bench/table.h"

namespace insonate::bench {

/// One setting in two runs.
struct Change {
  std::string setting;            ///< "case=Abdomen, lines=512, ..."
  double old_ms = 0, new_ms = 0;  ///< medians
  double ratio = 1;               ///< new to old
  /// What the quartiles allow: new first to old third, and new third to old first. A change is beyond the spread when 1
  /// does not lie between them.
  double least_ratio = 1, most_ratio = 1;

  bool slower() const { return least_ratio > 1; }
  bool faster() const { return most_ratio < 1; }

  /// What else has grown that should not, or is not told any more: errors, which have no spread, by more than another
  /// device's rounding does, and what an unchanged frame runs. "error_db 0.89 -> 1.34", in the order of the columns.
  std::vector<std::string> worse;
};

struct Comparison {
  std::vector<Change> changes;             ///< rows of the same setting, in the order of the earlier run
  std::vector<std::string> gone, arrived;  ///< settings of one run alone
};

/// Settings are all columns but the device and what was measured, so that runs on two devices compare too. Throws
/// InputError when a file holds no run times, when a cell holds no number, or when nothing matches.
Comparison compare(const std::string& old_file, const Table& before, const std::string& new_file, const Table& after);

}  // namespace insonate::bench
