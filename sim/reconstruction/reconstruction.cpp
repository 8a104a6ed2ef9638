#include "sim/reconstruction/reconstruction.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/reconstruction/hole_filling.h"

namespace insonate {
namespace {

constexpr float kMaxSamples = 16384;
/// Rounding alone decides whether a pixel that lies on a voxel's middle has such weights at the voxels beside it.
constexpr float kMinWeight = 1e-3f;
/// Slabs along j that threads take. Their number does not affect results.
constexpr int kSlabs = 16;

/// Returns the x of [begin, end) at which a + b x may lie in [low, high), and some beside them.
std::pair<int, int> span_between(double a, double b, double low, double high, int begin, int end) {
  constexpr double kFlat = 1e-12;
  if (std::abs(b) < kFlat) return a < low - 1 || a > high + 1 ? std::pair(0, 0) : std::pair(begin, end);
  double from = (low - a) / b, to = (high - a) / b;
  if (from > to) std::swap(from, to);
  from = std::clamp(std::floor(from), double(begin), double(end));
  to = std::clamp(std::ceil(to) + 1, double(begin), double(end));
  return {int(from), int(to)};
}

}  // namespace

Reconstruction::Reconstruction(const Grid& grid, const ReconstructionSettings& settings)
    : grid_(grid), settings_(settings), sums_(grid.count()) {
  if (settings_.compounding == Compounding::mean) return;
  before_.resize(grid.count());
  touched_by_.resize(grid.count());
}

void Reconstruction::add(const TrackedPicture& picture) {
  ++pictures_;
  tbb::parallel_for(0, kSlabs, [&](int slab) {
    const auto end_of = [&](int n) { return int(std::int64_t(grid_.size.y) * n / kSlabs); };
    if (end_of(slab) < end_of(slab + 1)) insert_slab(picture, end_of(slab), end_of(slab + 1));
  });
}

/// Inserts what of a picture lies in the voxels first_j to end_j - 1 along j. Each voxel takes the pixels in the
/// picture's order, whatever the slabs are.
void Reconstruction::insert_slab(const TrackedPicture& picture, int first_j, int end_j) {
  const glm::dmat4 index_from_pixel = glm::inverse(grid_.matrix()) * picture.patient_from_pixel;
  const glm::dvec3 step(index_from_pixel[0]), row_step(index_from_pixel[1]), origin(index_from_pixel[3]);
  const bool nearest = settings_.insertion == Insertion::nearest;
  const glm::ivec3 size = grid_.size;
  const std::size_t row_length = std::size_t(size.x), slice_length = row_length * std::size_t(size.y);
  for (int y = 0; y < picture.grey.height; ++y) {
    const PictureRegion::Span& span = picture.region->spans[std::size_t(y)];
    const glm::dvec3 first = origin + double(y) * row_step;
    const auto [from, to] = span_between(first.y, step.y, first_j - 1.0, end_j, span.begin, span.end);
    const std::uint8_t* grey = &picture.grey.pixels[std::size_t(y) * std::size_t(picture.grey.width)];
    const std::uint8_t* inside = &picture.region->inside.pixels[std::size_t(y) * std::size_t(picture.grey.width)];
    for (int x = from; x < to; ++x) {
      if (!inside[x]) continue;
      const glm::dvec3 at = first + double(x) * step;
      if (!(at.x > -1 && at.y > -1 && at.z > -1 && at.x < size.x && at.y < size.y && at.z < size.z)) continue;
      const float value = grey[x];
      if (nearest) {
        const glm::ivec3 voxel(floor_of(at.x + 0.5), floor_of(at.y + 0.5), floor_of(at.z + 0.5));
        if (voxel.y >= first_j && voxel.y < end_j && grid_.contains(voxel)) insert(grid_.offset(voxel), value, 1);
        continue;
      }
      const glm::ivec3 base(floor_of(at.x), floor_of(at.y), floor_of(at.z));
      const glm::vec3 share(at - glm::dvec3(base)), rest = 1.0f - share;
      const bool within = base.x >= 0 && base.x + 1 < size.x && base.z >= 0 && base.z + 1 < size.z;
      for (int dy = 0; dy < 2; ++dy) {
        const int j = base.y + dy;
        if (j < first_j || j >= end_j) continue;
        const float weight_y = dy ? share.y : rest.y;
        for (int dz = 0; dz < 2; ++dz) {
          const int k = base.z + dz;
          if (!within && (k < 0 || k >= size.z)) continue;
          const float weight = weight_y * (dz ? share.z : rest.z);
          const std::size_t row = std::size_t(k) * slice_length + std::size_t(j) * row_length;
          if (within || base.x >= 0) insert(row + std::size_t(base.x), value, weight * rest.x);
          if (within || base.x + 1 < size.x) insert(row + std::size_t(base.x + 1), value, weight * share.x);
        }
      }
    }
  }
}

inline void Reconstruction::insert(std::size_t at, float value, float weight) {
  if (weight < kMinWeight) return;
  Sum& sum = sums_[at];
  if (settings_.compounding != Compounding::mean && touched_by_[at] != pictures_) {
    if (touched_by_[at] != 0) before_[at] = value_at(at);
    touched_by_[at] = std::uint32_t(pictures_);
    sum = {};
  }
  if (sum.weight >= kMaxSamples) return;
  sum.value += weight * value;
  sum.weight += weight;
}

std::uint8_t Reconstruction::mean_of(const Sum& sum) const {
  return std::uint8_t(std::clamp(std::lround(sum.value / sum.weight), 0L, 255L));
}

std::uint8_t Reconstruction::value_at(std::size_t at) const {
  const std::uint8_t mean = mean_of(sums_[at]);
  return settings_.compounding == Compounding::maximum ? std::max(mean, before_[at]) : mean;
}

void Reconstruction::extend(const glm::ivec3& before, const glm::ivec3& behind) {
  Grid larger = grid_;
  larger.size += before + behind;
  larger.origin = grid_.patient_from_index(-glm::dvec3(before));
  const auto moved = [&](auto& values) {
    if (values.empty()) return;
    std::remove_reference_t<decltype(values)> copies(larger.count());
    for (int k = 0; k < grid_.size.z; ++k)
      for (int j = 0; j < grid_.size.y; ++j) {
        const auto row = values.begin() + std::ptrdiff_t(grid_.offset({0, j, k}));
        std::copy(row, row + grid_.size.x,
                  copies.begin() + std::ptrdiff_t(larger.offset(glm::ivec3(0, j, k) + before)));
      }
    values = std::move(copies);
  };
  moved(sums_);
  moved(before_);
  moved(touched_by_);
  grid_ = larger;
}

ReconstructedVolume Reconstruction::measured() const {
  ReconstructedVolume volume;
  volume.grey.grid = volume.known.grid = grid_;
  volume.grey.voxels.resize(grid_.count());
  volume.known.voxels.resize(grid_.count());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid_.count(), 1u << 16), [&](const auto& range) {
    for (std::size_t at = range.begin(); at < range.end(); ++at) {
      if (sums_[at].weight <= 0) continue;
      volume.grey.voxels[at] = value_at(at);
      volume.known.voxels[at] = std::uint8_t(VoxelKnown::measured);
    }
  });
  return volume;
}

ReconstructedVolume Reconstruction::filled() const {
  ReconstructedVolume volume = measured();
  fill_holes(volume, settings_.hole_radius_mm);
  return volume;
}

std::string_view to_string(Insertion insertion) {
  return insertion == Insertion::nearest ? "nearest" : "trilinear";
}

std::string_view to_string(Compounding compounding) {
  switch (compounding) {
    case Compounding::mean:
      return "mean";
    case Compounding::maximum:
      return "maximum";
    case Compounding::latest:
      break;
  }
  return "latest";
}

}  // namespace insonate
