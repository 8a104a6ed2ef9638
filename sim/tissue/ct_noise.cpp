#include "sim/tissue/ct_noise.h"

#include <glm/common.hpp>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace insonate {
namespace {

constexpr double kStep_hu = 0.5;
constexpr int kSteps = 200;  ///< up to 100 HU, more than any scanner's noise
constexpr int kSoftMin_hu = 0, kSoftMax_hu = 100, kFar_hu = 200;
constexpr int kAround = 27;
constexpr int kMaxApart_hu = 1000;  ///< so that 27 differences fit in 16 bits; more counts as that
constexpr int kLanes = 16;  ///< voxels that the compiler computes at once; rows are padded to whole numbers of them

using Ct = Volume<std::int16_t>;
using Lanes = std::array<std::int16_t, kLanes>;

glm::ivec3 step_of(const Grid& grid) {
  glm::ivec3 step;
  for (int axis = 0; axis < 3; ++axis) step[axis] = std::max(1, int(std::lround(kNoiseStep_mm / grid.spacing[axis])));
  return step;
}

/// The nine rows through the voxels around those of one row, with the border's voxels repeated beyond both ends.
class RowsAround {
public:
  explicit RowsAround(const Ct& ct) : ct_(ct), step_(step_of(ct.grid)) {
    for (auto& row : rows_) row.resize(std::size_t(ct.grid.size.x + 2 * step_.x + kLanes));
  }

  void move_to(int y, int z) {
    const glm::ivec3 size = ct_.grid.size;
    std::size_t n = 0;
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy) {
        const int there_y = std::clamp(y + dy * step_.y, 0, size.y - 1);
        const int there_z = std::clamp(z + dz * step_.z, 0, size.z - 1);
        const std::int16_t* from = ct_.voxels.data() + ct_.grid.offset({0, there_y, there_z});
        std::vector<std::int16_t>& row = rows_[n++];
        std::fill_n(row.begin(), step_.x, from[0]);
        std::copy_n(from, size.x, row.begin() + step_.x);
        std::fill(row.begin() + step_.x + size.x, row.end(), from[size.x - 1]);
      }
  }

  /// Returns a row whose entry x is the voxel at dx, dy, dz steps from voxel x.
  const std::int16_t* at(int dx, int dy, int dz) const {
    return rows_[std::size_t(3 * (dz + 1) + dy + 1)].data() + (dx + 1) * step_.x;
  }

private:
  const Ct& ct_;
  glm::ivec3 step_;
  std::array<std::vector<std::int16_t>, 9> rows_;
};

/// Calls use(y, z) for each row of the volume, on all cores; make() makes what the rows of a part share.
template <typename Make>
void each_row(const Grid& grid, Make make) {
  tbb::parallel_for(tbb::blocked_range<int>(0, grid.size.z), [&](const auto& slices) {
    auto use = make();
    for (int z = slices.begin(); z != slices.end(); ++z)
      for (int y = 0; y < grid.size.y; ++y) use(y, z);
  });
}

/// Writes a row of means, rounded to the nearest, from sums of differences from `base`.
template <typename Mean>
void put_row(Ct& to, int y, int z, Mean mean) {
  std::int16_t* row = to.voxels.data() + to.grid.offset({0, y, z});
  for (int first = 0; first < to.grid.size.x; first += kLanes) {
    Lanes means;
    mean(first, means);
    std::copy_n(means.begin(), std::min(kLanes, to.grid.size.x - first), row + first);
  }
}

Ct guide_of(const Ct& ct) {
  Ct guide{ct.grid, std::vector<std::int16_t>(ct.voxels.size())};
  each_row(ct.grid, [&] {
    return [&, rows = RowsAround(ct)](int y, int z) mutable {
      rows.move_to(y, z);
      const std::array<const std::int16_t*, 7> seven = {rows.at(0, 0, 0),  rows.at(-1, 0, 0), rows.at(1, 0, 0),
                                                        rows.at(0, -1, 0), rows.at(0, 1, 0),  rows.at(0, 0, -1),
                                                        rows.at(0, 0, 1)};
      put_row(guide, y, z, [&](int first, Lanes& means) {
        std::array<std::int32_t, kLanes> sum{};
        for (const std::int16_t* row : seven)
          for (int x = 0; x < kLanes; ++x) sum[std::size_t(x)] += row[first + x];
        for (std::size_t x = 0; x < kLanes; ++x) means[x] = std::int16_t(std::floor(float(sum[x]) / 7 + 0.5f));
      });
    };
  });
  return guide;
}

Ct mean_of_alike(const Ct& ct, const Ct& guide, int most_apart) {
  Ct result{ct.grid, std::vector<std::int16_t>(ct.voxels.size())};
  each_row(ct.grid, [&] {
    return [&, of_ct = RowsAround(ct), of_guide = RowsAround(guide)](int y, int z) mutable {
      of_ct.move_to(y, z);
      of_guide.move_to(y, z);
      const std::int16_t* here = of_guide.at(0, 0, 0);
      const std::int16_t* base = of_ct.at(0, 0, 0);
      const auto most = std::int16_t(most_apart);
      put_row(result, y, z, [&](int first, Lanes& means) {
        std::copy_n(base + first, kLanes, means.begin());
        if (*std::max_element(here + first, here + first + kLanes) <= kFiltered_hu) return;  // half of most CTs
        // Everything in 16 bits, which the compiler computes eight at a time. A difference of guides that does not fit
        // wraps to one that is still too large.
        Lanes sum{}, count{};
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
              const std::int16_t* there = of_guide.at(dx, dy, dz) + first;
              const std::int16_t* value = of_ct.at(dx, dy, dz) + first;
              for (std::size_t x = 0; x < kLanes; ++x) {
                const auto apart = std::int16_t(there[x] - here[std::size_t(first) + x]);
                const std::int16_t alike = std::int16_t(-(apart <= most)) & std::int16_t(-(apart >= -most));
                const std::int16_t more = std::clamp(std::int16_t(value[x] - base[std::size_t(first) + x]),
                                                     std::int16_t(-kMaxApart_hu), std::int16_t(kMaxApart_hu));
                sum[x] = std::int16_t(sum[x] + (more & alike));
                count[x] = std::int16_t(count[x] - alike);
              }
            }
        for (std::size_t x = 0; x < kLanes; ++x) {
          const float mean = std::floor(float(sum[x]) / float(count[x]) + 0.5f);
          if (here[std::size_t(first) + x] > kFiltered_hu) means[x] = std::int16_t(means[x] + mean);
        }
      });
    };
  });
  return result;
}

}  // namespace

double ct_noise_hu(const Ct& ct) {
  using Counts = std::array<std::int64_t, kSteps>;
  tbb::enumerable_thread_specific<Counts> parts(Counts{});
  const glm::ivec3 step = step_of(ct.grid);
  each_row(ct.grid, [&] {
    return [&, rows = RowsAround(ct)](int y, int z) mutable {
      if (y % step.y != 0 || z % step.z != 0) return;  // its noise is that of its neighbours
      rows.move_to(y, z);
      Counts& counts = parts.local();
      for (int first = 0; first < ct.grid.size.x; first += kLanes) {
        std::array<std::int32_t, kLanes> sum{}, squares{}, least, most;
        least.fill(32767);
        most.fill(-32768);
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
              for (std::size_t x = 0; x < kLanes; ++x) {
                // Clamped so that 27 squares fit in 32 bits; soft tissue is never clamped.
                const std::int32_t hu =
                    std::clamp<std::int32_t>(rows.at(dx, dy, dz)[std::size_t(first) + x], -2000, 2000);
                sum[x] += hu;
                squares[x] += hu * hu;
                least[x] = std::min(least[x], hu);
                most[x] = std::max(most[x], hu);
              }
        for (std::size_t x = 0; x < kLanes && first + int(x) < ct.grid.size.x; ++x) {
          const double mean = double(sum[x]) / kAround;
          if (mean < kSoftMin_hu || mean > kSoftMax_hu || least[x] < mean - kFar_hu || most[x] > mean + kFar_hu)
            continue;
          const double variance = std::max(0.0, (squares[x] - kAround * mean * mean) / (kAround - 1));
          ++counts[std::size_t(std::min(int(std::lround(std::sqrt(variance) / kStep_hu)), kSteps - 1))];
        }
      }
    };
  });
  Counts counts{};
  std::int64_t tissue = 0;
  for (const Counts& part : parts)
    for (std::size_t n = 0; n < counts.size(); ++n) {
      counts[n] += part[n];
      tissue += part[n];
    }
  const glm::dvec3 spacing = ct.grid.spacing;
  if (double(tissue * step.y * step.z) * spacing.x * spacing.y * spacing.z < kMinTissue_ml * 1000)
    return kUsualNoise_hu;
  return std::max(kUsualNoise_hu, kStep_hu * double(std::max_element(counts.begin(), counts.end()) - counts.begin()));
}

Ct without_noise(const Ct& ct, double noise_hu) {
  const Ct once = mean_of_alike(ct, guide_of(ct), int(std::lround(kAlikeInGuide * noise_hu)));
  return mean_of_alike(once, once, int(std::lround(kAlikeInResult * noise_hu)));
}

}  // namespace insonate
