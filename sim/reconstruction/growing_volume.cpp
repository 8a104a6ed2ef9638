#include "sim/reconstruction/growing_volume.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sim/reconstruction/sweep_extent.h"

namespace insonate {

GrowingVolume::GrowingVolume(double voxel_mm, const ReconstructionSettings& settings, std::size_t most_voxels)
    : voxel_mm_(voxel_mm), settings_(settings), most_voxels_(most_voxels) {}

void GrowingVolume::add(TrackedPicture picture) {
  pictures_.push_back(std::move(picture));
  if (!reconstruction_ || !make_room(pictures_.back())) return rebuild();
  reconstruction_->add(pictures_.back());
}

/// Extends the grid so that it holds the picture. Returns false if it would become too large.
bool GrowingVolume::make_room(const TrackedPicture& picture) {
  // A hand moves on in the direction in which it has left the grid.
  constexpr double kAhead = 16;
  const Grid& grid = reconstruction_->grid();
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const glm::dvec2& pixel : picture.region->outline) {
    const glm::dvec3 index = grid.index_from_patient(glm::dvec3(picture.patient_from_pixel * glm::dvec4(pixel, 0, 1)));
    low = glm::min(low, index);
    high = glm::max(high, index);
  }
  glm::dvec3 before(0.0), behind(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] < 1) before[axis] = std::ceil(1 - low[axis]) + kAhead;
    if (high[axis] > grid.size[axis] - 2) behind[axis] = std::ceil(high[axis] - grid.size[axis] + 2) + kAhead;
  }
  // Compared as real numbers: the sizes of a stray pose do not fit an int.
  const glm::dvec3 size = glm::dvec3(grid.size) + before + behind;
  if (size.x * size.y * size.z > double(most_voxels_) || std::max({size.x, size.y, size.z}) > kMaxReconstructedSide)
    return false;
  if (before + behind != glm::dvec3(0.0)) reconstruction_->extend(glm::ivec3(before), glm::ivec3(behind));
  return true;
}

void GrowingVolume::rebuild() {
  GridChoice choice = choose_grid(pictures_, voxel_mm_, most_voxels_);
  reconstruction_.reset();  // before the memory for the next one is taken
  reconstruction_.emplace(choice.grid, settings_);
  remark_ = std::move(choice.remark);
  for (const TrackedPicture& picture : pictures_) reconstruction_->add(picture);
}

ReconstructedVolume GrowingVolume::finish() {
  if (pictures_.empty()) throw std::logic_error("a volume of no pictures");
  const Pose mean = extent_of(pictures_).patient_from_sweep;
  if (angle_between_deg({reconstruction_->grid().direction, {}}, {mean.rotation, {}}) > kMaxSkew_deg) rebuild();
  return reconstruction_->filled();
}

}  // namespace insonate
