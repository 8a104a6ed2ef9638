#include "sim/tissue/structure/voxel_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonate {

void blur(VoxelField& field, const glm::dvec3& spacing_mm, double sigma_mm) {
  for (int axis = 0; axis < 3; ++axis) {
    const int reach = int(std::ceil(3 * sigma_mm / spacing_mm[axis]));
    std::vector<float> weights;
    for (int i = -reach; i <= reach; ++i)
      weights.push_back(float(std::exp(-0.5 * std::pow(i * spacing_mm[axis] / sigma_mm, 2))));
    field.along(axis, [&](std::vector<float>& line) {
      const std::vector<float> before = line;
      const int n = int(line.size());
      for (int i = 0; i < n; ++i) {
        float sum = 0, weight = 0;
        for (int j = std::max(0, i - reach); j <= std::min(n - 1, i + reach); ++j) {
          const float w = weights[std::size_t(j - i + reach)];
          sum += w * before[std::size_t(j)];
          weight += w;
        }
        line[std::size_t(i)] = sum / weight;
      }
    });
  }
}

// Exactly, axis by axis, as the lower envelope of parabolas (Felzenszwalb and Huttenlocher, Theory of Computing 8,
// 2012).
VoxelField distances_to(const VoxelField& mask, const glm::dvec3& spacing_mm) {
  constexpr float kFar = 1e8f;
  VoxelField squared(mask.size);
  for (std::size_t v = 0; v < mask.values.size(); ++v) squared.values[v] = mask.values[v] > 0 ? 0 : kFar;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = float(spacing_mm[axis]);
    squared.along(axis, [&](std::vector<float>& line) {
      const std::vector<float> f = line;
      std::vector<int> lowest(f.size());
      std::vector<float> from(f.size() + 1);
      std::size_t last = 0;
      from[0] = -std::numeric_limits<float>::max();
      from[1] = std::numeric_limits<float>::max();
      const auto meet = [&](int q, int v) {
        const float a = float(q) * step, b = float(v) * step;
        return ((f[std::size_t(q)] + a * a) - (f[std::size_t(v)] + b * b)) / (2 * (a - b));
      };
      for (int q = 1; q < int(f.size()); ++q) {
        while (last > 0 && meet(q, lowest[last]) <= from[last]) --last;
        const float s = meet(q, lowest[last]);
        if (last > 0 || s > from[0]) ++last;
        lowest[last] = q;
        from[last] = s;
        from[last + 1] = std::numeric_limits<float>::max();
      }
      std::size_t k = 0;
      for (std::size_t q = 0; q < f.size(); ++q) {
        while (from[k + 1] < float(q) * step) ++k;
        const float away = (float(q) - float(lowest[k])) * step;
        line[q] = away * away + f[std::size_t(lowest[k])];
      }
    });
  }
  for (float& value : squared.values) value = std::sqrt(std::min(value, kFar));
  return squared;
}

}  // namespace insonate
