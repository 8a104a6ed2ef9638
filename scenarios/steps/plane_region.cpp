#include "scenarios/steps/plane_region.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

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
  // Off the longest direction by half a step of 2 degrees, an extent is short by 1 - cos(1 degree), 0.15 thousandths.
  constexpr int kDirections = 90;
  double longest = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = kPi * i / kDirections;
    longest = std::max(longest, extent_mm({std::cos(angle), std::sin(angle)}));
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

  PlaneRegion all{pitch_mm, {}};
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
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
