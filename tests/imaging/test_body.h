#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

#include "sim/core/hash.h"
#include "sim/core/pose.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate::test {

/// Returns a body with all the kinds of interface that a patient has, small enough for the reference: skin, fat, a
/// parenchyma with grain, a cyst, a vessel, a rib and a bubble of gas. The axes are x to the left, y into the body, z
/// to the head, mm, with the skin at y = 0. Its grid is anisotropic, rotated and reflected, so that code that ignores
/// the direction matrix fails.
inline AcousticVolume test_body() {
  struct Point {
    double hu, echogenicity_db;
  };
  const auto at = [](const glm::dvec3& p, double grain) -> Point {
    if (p.y < -4) return {-1000, -60};  // nothing scatters in air
    if (p.y < 0) return {-1000, 0};
    if (p.y < 2) return {40, -3};
    if (p.y < 12 + 2 * std::sin(p.x / 15)) return {-100, -4};
    if (std::hypot(p.y - 20, p.z - 2) < 5 && p.x < -12) return {600, 0};  // a rib along x, over one side
    if (glm::distance(p, glm::dvec3(10, 50, 0)) < 14) return {5, -55};    // a cyst
    if (std::hypot(p.x - 25, p.y - 75) < 5) return {45, -30};             // a vessel
    if (glm::distance(p, glm::dvec3(18, 95, 3)) < 9) return {-990, 0};    // gas
    if (p.y > 80 + 0.2 * p.x) return {35 + 8 * grain, -3 + grain};        // another organ, tilted surface
    return {58 + 8 * grain, grain};
  };

  AcousticVolume volume;
  volume.grid.size = {90, 75, 50};
  volume.grid.spacing = {1.6, 2.1, 1.3};
  const glm::dmat3 turned(glm::rotate(glm::dmat4(1.0), 0.3, glm::normalize(glm::dvec3(0.3, 1, -0.5))));
  volume.grid.direction = glm::dmat3(-turned[0], turned[1], turned[2]);
  volume.grid.origin = glm::dvec3(0, 60, 0) - volume.grid.direction * (volume.grid.spacing * glm::dvec3(45, 37, 25));
  volume.voxels.resize(volume.grid.count());
  for (int k = 0; k < volume.grid.size.z; ++k)
    for (int j = 0; j < volume.grid.size.y; ++j)
      for (int i = 0; i < volume.grid.size.x; ++i) {
        const std::size_t v = volume.grid.offset({i, j, k});
        const double grain = 2 * unit_float(hash(std::uint32_t(v))) - 1;
        const Point point = at(volume.grid.patient_from_index({i, j, k}), grain);
        volume.voxels[v] = {std::int16_t(std::lround(point.hu)),
                            std::int16_t(std::lround(point.echogenicity_db * 100))};
      }
  return volume;
}

inline const TissueTable& tissues() {
  static const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  return table;
}

/// Returns the pose of a probe on the body's skin, pressed in by `press_mm`, pointing along +y, tilted by `tilt_deg`
/// about x.
inline Pose on_the_skin(double x_mm, double press_mm, double tilt_deg) {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(tilt_deg), glm::dvec3(1, 0.2, 0));
  return {glm::dmat3(turn), {x_mm, press_mm, 1.0}};
}

}  // namespace insonate::test
