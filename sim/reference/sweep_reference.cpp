#include "sim/reference/sweep_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonate {
namespace {

// The outer lines and samples hold up to the fan's edges, half a step beyond them.
double bilinear(const SweepValues& values, int plane, double line, double sample) {
  line = std::clamp(line, 0.0, values.lines - 1.0);
  sample = std::clamp(sample, 0.0, values.samples - 1.0);
  const auto at = [&](double i, double k) {
    const std::size_t row = std::size_t(plane) * std::size_t(values.lines) + std::size_t(i);
    return double(values.values[row * std::size_t(values.samples) + std::size_t(k)]);
  };
  const double i = std::floor(line), k = std::floor(sample), fi = line - i, fk = sample - k;
  const double next_i = std::min(i + 1, values.lines - 1.0), next_k = std::min(k + 1, values.samples - 1.0);
  return (1 - fi) * ((1 - fk) * at(i, k) + fk * at(i, next_k)) +
         fi * ((1 - fk) * at(next_i, k) + fk * at(next_i, next_k));
}

}  // namespace

Volume<double> convert_sweep_reference(const Sweep& sweep, const SweepValues& values, const Grid& grid) {
  const double dr = sweep.depth_mm / values.samples;
  Volume<double> volume{grid, std::vector<double>(grid.count(), std::numeric_limits<double>::quiet_NaN())};
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const auto position = sweep_position(sweep, grid.patient_from_index({i, j, k}));
        if (!position) continue;
        const auto in = [&](int plane, const LinePosition& at) {
          return bilinear(values, plane, at.line, at.r_mm / dr - 0.5);
        };
        volume.at({i, j, k}) = (1 - position->share) * in(position->plane, position->in_this) +
                               position->share * in(position->plane + 1, position->in_next);
      }
  return volume;
}

}  // namespace insonate
