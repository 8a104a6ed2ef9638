#pragma once

#include <vector>

namespace insonate {

/// How values spread: half of them lie between the quartiles.
struct Spread {
  double first_quartile = 0, median = 0, third_quartile = 0;
};

/// Returns the median and the quartiles; zeros for no values. A quartile between two values is interpolated, as Hyndman
/// and Fan's definition 7 does it (American Statistician 50, 1996), which spreadsheets use.
Spread spread_of(std::vector<double> values);

}  // namespace insonate
