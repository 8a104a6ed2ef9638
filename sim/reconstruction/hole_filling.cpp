#include "sim/reconstruction/hole_filling.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace insonate {
namespace {

constexpr auto kMeasured = std::uint8_t(VoxelKnown::measured);

struct Line {
  glm::ivec3 step{0};
  double step_mm = 0;
  int most_steps = 0;  ///< from one measured voxel to the other
};

std::array<Line, 13> lines_of(const Grid& grid, double radius_mm) {
  constexpr double kRounding = 1e-9;
  std::array<Line, 13> lines;
  std::size_t count = 0;
  for (int z = 0; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        // One of each two opposite directions.
        if (z == 0 && (y < 0 || (y == 0 && x <= 0))) continue;
        Line& line = lines[count++];
        line.step = {x, y, z};
        line.step_mm = glm::length(glm::dvec3(line.step) * grid.spacing);
        line.most_steps = int(2 * radius_mm / line.step_mm + kRounding);
      }
  return lines;
}

/// Which parts of a volume have measured voxels, so that empty space is passed over.
class Neighbourhood {
public:
  Neighbourhood(const Volume<std::uint8_t>& known, double radius_mm) : known_(known) {
    // No line between two measured voxels is longer than a block.
    side_ = glm::max(glm::ivec3(glm::ceil(radius_mm / known.grid.spacing)), glm::ivec3(4));
    blocks_.size = (known.grid.size + side_ - 1) / side_;
    measured_.resize(blocks_.count());
    tbb::parallel_for(0, blocks_.size.z, [&](int bz) {
      for (int by = 0; by < blocks_.size.y; ++by)
        for (int bx = 0; bx < blocks_.size.x; ++bx) measured_[blocks_.offset({bx, by, bz})] = any_in({bx, by, bz});
    });
  }

  const glm::ivec3& side() const { return side_; }
  const glm::ivec3& blocks() const { return blocks_.size; }

  /// Returns whether a block or one beside it has measured voxels.
  bool any_near(const glm::ivec3& block) const {
    const glm::ivec3 low = glm::max(block - 1, glm::ivec3(0)), high = glm::min(block + 1, blocks_.size - 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          if (measured_[blocks_.offset({x, y, z})]) return true;
    return false;
  }

private:
  bool any_in(const glm::ivec3& block) const {
    const glm::ivec3 from = block * side_, to = glm::min(from + side_, known_.grid.size);
    for (int k = from.z; k < to.z; ++k)
      for (int j = from.y; j < to.y; ++j) {
        const auto row = known_.voxels.begin() + std::ptrdiff_t(known_.grid.offset({0, j, k}));
        if (std::find(row + from.x, row + to.x, kMeasured) != row + to.x) return true;
      }
    return false;
  }

  const Volume<std::uint8_t>& known_;
  glm::ivec3 side_{1};
  Grid blocks_;
  std::vector<std::uint8_t> measured_;
};

/// Returns the steps to the first measured voxel on one side; 0 if there is none within `most`.
int steps_to_measured(const Volume<std::uint8_t>& known, const glm::ivec3& voxel, const glm::ivec3& step, int most) {
  glm::ivec3 at = voxel;
  for (int n = 1; n <= most; ++n) {
    at += step;
    if (!known.grid.contains(at)) return 0;
    if (known.at(at) == kMeasured) return n;
  }
  return 0;
}

struct FilledVoxel {
  std::uint32_t offset;
  std::uint8_t grey;
};

std::optional<std::uint8_t> value_between(const ReconstructedVolume& volume, const glm::ivec3& voxel,
                                          const std::array<Line, 13>& lines) {
  double sum = 0, weights = 0;
  for (const Line& line : lines) {
    const int before = steps_to_measured(volume.known, voxel, -line.step, line.most_steps - 1);
    if (before == 0) continue;
    const int behind = steps_to_measured(volume.known, voxel, line.step, line.most_steps - before);
    if (behind == 0) continue;
    const double apart_mm = (before + behind) * line.step_mm, weight = 1 / (apart_mm * apart_mm);
    const double first = volume.grey.at(voxel - before * line.step), last = volume.grey.at(voxel + behind * line.step);
    sum += weight * (behind * first + before * last) / (before + behind);
    weights += weight;
  }
  if (weights <= 0) return std::nullopt;
  return std::uint8_t(std::lround(sum / weights));
}

}  // namespace

void fill_holes(ReconstructedVolume& volume, double radius_mm) {
  const std::array<Line, 13> lines = lines_of(volume.grey.grid, radius_mm);
  const Neighbourhood near(volume.known, 2 * radius_mm);
  // Written only when all threads have finished reading.
  std::vector<std::vector<FilledVoxel>> filled(std::size_t(near.blocks().z));
  tbb::parallel_for(0, near.blocks().z, [&](int bz) {
    for (int by = 0; by < near.blocks().y; ++by)
      for (int bx = 0; bx < near.blocks().x; ++bx) {
        const glm::ivec3 block(bx, by, bz);
        if (!near.any_near(block)) continue;
        const glm::ivec3 from = block * near.side(), to = glm::min(from + near.side(), volume.grey.grid.size);
        for (int k = from.z; k < to.z; ++k)
          for (int j = from.y; j < to.y; ++j)
            for (int i = from.x; i < to.x; ++i) {
              const std::size_t offset = volume.grey.grid.offset({i, j, k});
              if (volume.known.voxels[offset] == kMeasured) continue;
              if (const auto grey = value_between(volume, {i, j, k}, lines))
                filled[std::size_t(bz)].push_back({std::uint32_t(offset), *grey});
            }
      }
  });
  for (const std::vector<FilledVoxel>& part : filled)
    for (const FilledVoxel& voxel : part) {
      volume.grey.voxels[voxel.offset] = voxel.grey;
      volume.known.voxels[voxel.offset] = std::uint8_t(VoxelKnown::filled);
    }
}

}  // namespace insonate
