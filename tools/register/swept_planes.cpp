#include "tools/register/swept_planes.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace insonate {
namespace {

constexpr double kMinOpening = glm::radians(3.0), kMaxSlope = 3.7;  // of a side: 75 degrees
// Of the way from the wedge's top to its widest row: the sides are fitted there.
constexpr double kTop = 0.1, kDeep = 0.95;
constexpr double kMinSides = 1.0 / 3;  // of the rows that lie above the widest; sides that are shorter say little
constexpr int kMinRows = 8;
constexpr double kMaxOff = 1;  // voxels that a side may lie off its line, root mean square: sides are steps of voxels
constexpr int kFewVoxels = 3;  // that may be known beside the wedge, such as specks

/// z = at + slope y.
struct Side {
  double at, slope;
};

/// Returns the line through points (y, z) by least squares, nothing where they do not lie on one.
std::optional<Side> side_of(const std::vector<glm::dvec2>& points, double voxel_mm) {
  if (int(points.size()) < kMinRows) return std::nullopt;
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& point : points) mean += point / double(points.size());
  double yy = 0, yz = 0;
  for (const glm::dvec2& point : points) {
    yy += (point.x - mean.x) * (point.x - mean.x);
    yz += (point.x - mean.x) * (point.y - mean.y);
  }
  const Side side{mean.y - yz / yy * mean.x, yz / yy};
  double squares = 0;
  for (const glm::dvec2& point : points) squares += std::pow(point.y - side.at - side.slope * point.x, 2);
  if (!(std::sqrt(squares / double(points.size())) < kMaxOff * voxel_mm) || std::abs(side.slope) > kMaxSlope)
    return std::nullopt;
  return side;
}

}  // namespace

Pose SweptPlanes::plane(const PlaneBox& box, double share) const {
  const double at = glm::mix(first, last, share);
  if (!tilted) return {box.axes, box.axes[2] * at};
  const glm::dvec3 beam = std::cos(at) * box.axes[1] + std::sin(at) * box.axes[2];
  const glm::dvec3 across = std::cos(at) * box.axes[2] - std::sin(at) * box.axes[1];
  return {glm::dmat3(box.axes[0], beam, across), axis_y * box.axes[1] + axis_z * box.axes[2]};
}

glm::dvec2 SweptPlanes::depths(const PlaneBox& box) const {
  if (!tilted) return {box.low.y, box.high.y};
  return {std::max(box.low.y - axis_y, 0.0),
          std::hypot(box.high.y - axis_y, std::max(box.high.z - axis_z, axis_z - box.low.z))};
}

SweptPlanes find_swept_planes(const Grid& grid, const PlaneBox& box,
                              const std::function<bool(const glm::ivec3&)>& known) {
  SweptPlanes planes{box.low.z, box.high.z};
  // Known voxels per row of the wedge and per place across it.
  const double voxel_mm = std::max({grid.spacing.x, grid.spacing.y, grid.spacing.z}), row_mm = 1.5 * voxel_mm;
  Image<int> counts(int((box.high.z - box.low.z) / voxel_mm) + 2, int((box.high.y - box.low.y) / row_mm) + 1);
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const glm::ivec3 index(x, y, z);
        if (!known(index)) continue;
        const glm::dvec3 at = glm::transpose(box.axes) * grid.patient_from_index(glm::dvec3(index)) - box.low;
        ++counts.at(std::clamp(int(std::lround(at.z / voxel_mm)), 0, counts.width - 1),
                    std::clamp(int(at.y / row_mm), 0, counts.height - 1));
      }
  std::vector<glm::ivec2> extents;  // of each row: its first and last place; first > last in an empty one
  for (int row = 0; row < counts.height; ++row) {
    glm::ivec2 extent(counts.width, -1);
    for (int place = 0; place < counts.width; ++place)
      if (counts.at(place, row) > kFewVoxels) extent = {std::min(extent.x, place), place};
    extents.push_back(extent);
  }
  const auto filled = [](const glm::ivec2& extent) { return extent.x <= extent.y; };
  const auto top = std::ranges::find_if(extents, filled);
  const auto widest =
      std::ranges::max_element(extents, {}, [](const glm::ivec2& extent) { return extent.y - extent.x; });
  if (top == extents.end() || double(widest - top) < kMinSides * double(std::ranges::count_if(extents, filled)))
    return planes;
  std::vector<glm::dvec2> low, high;
  for (auto extent = top + std::ptrdiff_t(kTop * double(widest - top));
       extent < top + std::ptrdiff_t(kDeep * double(widest - top)); ++extent) {
    if (!filled(*extent)) continue;
    const double y = box.low.y + (double(extent - extents.begin()) + 0.5) * row_mm;
    low.emplace_back(y, box.low.z + extent->x * voxel_mm);
    high.emplace_back(y, box.low.z + extent->y * voxel_mm);
  }
  const std::optional<Side> lower = side_of(low, voxel_mm), upper = side_of(high, voxel_mm);
  if (!lower || !upper) return planes;
  const double from = std::atan(lower->slope), to = std::atan(upper->slope);
  if (to - from < kMinOpening) return planes;
  planes.tilted = true;
  planes.first = from;
  planes.last = to;
  planes.axis_y = (lower->at - upper->at) / (upper->slope - lower->slope);
  planes.axis_z = lower->at + lower->slope * planes.axis_y;
  return planes;
}

Image<std::uint8_t> known_in_planes(const Grid& grid, const PlaneBox& box, const SweptPlanes& planes, double mm,
                                    const std::function<bool(const glm::ivec3&)>& known) {
  // A single plane may reach up to a voxel further than the fan at any of its edges.
  constexpr int kPlanes = 48, kMinPlanes = 5;
  const glm::dvec2 depths = planes.depths(box);
  Image<std::uint8_t> seen(std::max(1, int((box.high.x - box.low.x) / mm) + 1),
                           std::max(1, int((depths.y - depths.x) / mm) + 1));
  for (int i = 0; i < kPlanes; ++i) {
    const Pose plane = planes.plane(box, (i + 0.5) / kPlanes);
    for (int y = 0; y < seen.height; ++y)
      for (int x = 0; x < seen.width; ++x) {
        const glm::dvec3 at = plane.point({box.low.x + x * mm, depths.x + y * mm, 0});
        const glm::ivec3 nearest(glm::round(grid.index_from_patient(at)));
        seen.at(x, y) += grid.contains(nearest) && known(nearest);
      }
  }
  for (std::uint8_t& pixel : seen.pixels) pixel = pixel >= kMinPlanes;
  return seen;
}

}  // namespace insonate
