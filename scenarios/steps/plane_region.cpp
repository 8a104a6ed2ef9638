#include "scenarios/steps/plane_region.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace insonate {

double PlaneRegion::extent_mm(const glm::dvec2& along) const {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const glm::dvec2& pixel : pixels) {
    const double at = glm::dot(pixel, along);
    least = std::min(least, at);
    most = std::max(most, at);
  }
  return pixels.empty() ? 0 : most - least + pitch_mm;
}

double PlaneRegion::longest_extent_mm() const {
  constexpr double kPi = 3.14159265358979323846;
  // At most half a step of 2 degrees off the longest direction, an extent is short by 1 - cos(1 degree), 0.015 %.
  constexpr int kDirections = 90;
  // In every direction, the outermost pixel is the first or last of its row.
  std::map<double, std::pair<double, double>> rows;
  for (const glm::dvec2& pixel : pixels) {
    auto& [first, last] = rows.try_emplace(pixel.y, pixel.x, pixel.x).first->second;
    first = std::min(first, pixel.x);
    last = std::max(last, pixel.x);
  }
  PlaneRegion ends{pitch_mm, {}};
  for (const auto& [y, row] : rows) ends.pixels.insert(ends.pixels.end(), {{row.first, y}, {row.second, y}});
  double longest = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = kPi * i / kDirections;
    longest = std::max(longest, ends.extent_mm({std::cos(angle), std::sin(angle)}));
  }
  return longest;
}

glm::dvec2 PlaneRegion::middle() const {
  glm::dvec2 sum(0.0);
  for (const glm::dvec2& pixel : pixels) sum += pixel;
  return pixels.empty() ? sum : sum / double(pixels.size());
}

std::optional<PlaneRegion> plane_region(const StructureSet& structures, const Pose& patient_from_plane,
                                        const std::optional<glm::dvec2>& near, double half_size_mm, double pitch_mm) {
  const glm::dvec2 centre = near.value_or(glm::dvec2(0, half_size_mm));
  const int half = int(std::ceil(half_size_mm / pitch_mm));
  const int side = 2 * half + 1;
  const auto place = [&](int i, int j) { return centre + pitch_mm * glm::dvec2(i - half, j - half); };
  std::vector<char> inside(std::size_t(side) * std::size_t(side));
  const auto at = [&](int i, int j) -> char& { return inside[std::size_t(j) * std::size_t(side) + std::size_t(i)]; };

  if (!structures.any_voxel()) return std::nullopt;
  // Restricts the search to where the bounding box of the structures can meet the plane.
  const Pose plane_from_patient = patient_from_plane.inverse();
  glm::dvec2 least(std::numeric_limits<double>::infinity()), most = -least;
  for (const glm::dvec3& corner : structures.corners()) {
    const glm::dvec2 in_plane(plane_from_patient.point(corner));
    least = glm::min(least, in_plane);
    most = glm::max(most, in_plane);
  }
  const auto pixel = [&](double mm, double middle) {
    return std::clamp((mm - middle) / pitch_mm + half, -1.0, side + 0.0);
  };
  const glm::ivec2 first(std::max(int(pixel(least.x, centre.x)) - 1, 0),
                         std::max(int(pixel(least.y, centre.y)) - 1, 0));
  const glm::ivec2 last(std::min(int(pixel(most.x, centre.x)) + 2, side - 1),
                        std::min(int(pixel(most.y, centre.y)) + 2, side - 1));

  PlaneRegion all{pitch_mm, {}};
  for (int j = first.y; j <= last.y; ++j)
    for (int i = first.x; i <= last.x; ++i)
      if ((at(i, j) = structures.holds(patient_from_plane.point(glm::dvec3(place(i, j), 0)))))
        all.pixels.push_back(place(i, j));
  if (all.pixels.empty()) return std::nullopt;

  const glm::dvec2 goal = near.value_or(all.middle());
  glm::ivec2 seed(0);
  double nearest = std::numeric_limits<double>::infinity();
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      if (at(i, j) && glm::distance(place(i, j), goal) < nearest) {
        nearest = glm::distance(place(i, j), goal);
        seed = {i, j};
      }
  PlaneRegion region{pitch_mm, {}};
  std::vector<glm::ivec2> open{seed};
  at(seed.x, seed.y) = 0;
  while (!open.empty()) {
    const glm::ivec2 here = open.back();
    open.pop_back();
    region.pixels.push_back(place(here.x, here.y));
    for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
      const glm::ivec2 next = here + step;
      if (next.x < 0 || next.y < 0 || next.x >= side || next.y >= side || !at(next.x, next.y)) continue;
      at(next.x, next.y) = 0;
      open.push_back(next);
    }
  }
  return region;
}

}  // namespace insonate
