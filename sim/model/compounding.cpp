#include "sim/model/compounding.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace insonate {

std::vector<double> look_angles(const Probe& probe, const Settings& settings) {
  if (!settings.waves || probe.kind == ProbeKind::phased) return {0.0};
  std::vector<double> angles;
  const int half = settings.steering_angles / 2;
  for (int i = -half; i <= half; ++i) angles.push_back(i == 0 ? 0 : glm::radians(settings.steering_deg) * i / half);
  return angles;
}

std::array<std::uint32_t, 3> phase_steps(const glm::dmat4& probe_from_cells, const Settings& settings,
                                         double steering) {
  constexpr double kPlacesPerCell = 1024, kTurn = 0x1p32;
  const glm::dvec3 difference(std::sin(steering), std::cos(steering) - 1, 0);
  const double turns_per_mm = 2 * settings.frequency_mhz / 1.54;
  std::array<std::uint32_t, 3> steps{};
  for (int axis = 0; axis < 3; ++axis) {
    const double turns = turns_per_mm * glm::dot(difference, glm::dvec3(probe_from_cells[axis])) / kPlacesPerCell;
    steps[std::size_t(axis)] = std::uint32_t(std::int64_t(std::llround(turns * kTurn)));
  }
  return steps;
}

}  // namespace insonate
