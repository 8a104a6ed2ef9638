#pragma once

#include <string>
#include <vector>

#include "tools/bench_table.h"

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
};

/// Rows of the same setting, in the order of `before`. Settings are all columns but the device and what was measured,
/// so that runs on two devices compare too. Throws InputError when a file holds no run times or nothing matches.
std::vector<Change> changes(const std::string& old_file, const Table& before, const std::string& new_file,
                            const Table& after);

}  // namespace insonate::bench
