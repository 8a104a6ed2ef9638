#include <cmath>
#include <cstdio>

#include "sim/gl/filter_error.h"
#include "sim/gl/headless_context.h"
#include "tools/bench/commands.h"

namespace insonate::bench {

Table measure_filter() {
  const gl::HeadlessContext context;
  tell_device();
  const gl::FilterError error = gl::measure_filter();
  std::printf(
      "The device's own trilinear filter is off by at most %.2g of the difference between neighbouring voxels (RMS "
      "%.2g), as weights of %.0f bits would be.\n%s\n",
      error.largest, error.rms, std::round(-std::log2(error.largest / 3)) - 1,
      error.is_coarse() ? "Coarse: exact_filter = true in a settings file weighs voxels in single precision; "
                          "insonate-bench front measures what that costs and gains."
                        : "Fine: exact_filter = true in a settings file would gain nothing.");
  Table table{{"device", "largest_error", "rms_error", "coarse"}, {}};
  table.rows.push_back(
      {gl::device_description(), cell_of(error.largest, 9), cell_of(error.rms, 9), error.is_coarse() ? "1" : "0"});
  return table;
}

}  // namespace insonate::bench
