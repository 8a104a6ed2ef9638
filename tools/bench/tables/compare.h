#pragma once

#include <string>
#include <vector>

#include "tools/bench/tables/table.h"

namespace insonate::bench {

/// One setting, measured in two runs.
struct Change {
  std::string setting;            ///< "case=Abdomen, lines=512, ..."
  double old_ms = 0, new_ms = 0;  ///< medians
  double ratio = 1;               ///< new_ms / old_ms
  /// The range that the quartiles allow: new first to old third, and new third to old first. A change exceeds the
  /// spread if 1 is outside this range.
  double least_ratio = 1, most_ratio = 1;

  bool slower() const { return least_ratio > 1; }
  bool faster() const { return most_ratio < 1; }

  /// Other values that grew but should not, or are missing in the new run. These are errors, which have no spread, if
  /// they grew by more than another device's rounding, and the stages run in an unchanged frame. In the order of the
  /// columns: "error_db 0.89 -> 1.34".
  std::vector<std::string> worse;
};

/// The result of comparing two runs.
struct Comparison {
  std::vector<Change> changes;             ///< rows with equal settings, in the order of the earlier run
  std::vector<std::string> gone, arrived;  ///< settings that are in only one run
};

/// Compares two runs. The settings are all columns except the device and the measured values, so that runs on two
/// devices can be compared. Throws InputError if a file has no run times, if a cell is not a number, or if no settings
/// match.
Comparison compare(const std::string& old_file, const Table& before, const std::string& new_file, const Table& after);

}  // namespace insonate::bench
