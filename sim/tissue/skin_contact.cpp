#include "sim/tissue/skin_contact.h"

#include "sim/tissue/coupling.h"

namespace insonate {
namespace {

constexpr double kMarch_mm = 0.5;  // below any voxel's size, so no skin is missed
constexpr double kPrecision_mm = 0.01;

ScanLines face_of(const Probe& probe) {
  Probe sparse = probe;
  sparse.lines = SkinContact::kPlaces;
  return scan_lines(sparse, kUsualGel_mm, 1);
}

/// Returns how far a point moves until it is in the body, or, for `body` false, outside.
std::optional<double> distance_until(bool body, const Volume<std::int16_t>& ct, const glm::dvec3& point,
                                     const glm::dvec3& direction, double reach_mm) {
  const glm::dvec3 start = ct.grid.index_from_patient(point);
  const glm::dvec3 per_mm = ct.grid.index_from_patient(point + direction) - start;
  const auto reached = [&](double mm) { return (sample_trilinear(ct, start + per_mm * mm) > kSkin_hu) == body; };
  if (reached(0)) return 0.0;
  for (int k = 1; k * kMarch_mm <= reach_mm; ++k) {
    if (!reached(k * kMarch_mm)) continue;
    double before = (k - 1) * kMarch_mm;
    double behind = k * kMarch_mm;
    while (behind - before > kPrecision_mm) {
      const double middle = (before + behind) / 2;
      (reached(middle) ? behind : before) = middle;
    }
    return behind;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> distance_to_skin(const Volume<std::int16_t>& ct, const glm::dvec3& point,
                                       const glm::dvec3& direction, double reach_mm) {
  return distance_until(true, ct, point, direction, reach_mm);
}

std::optional<double> distance_out_of_body(const Volume<std::int16_t>& ct, const glm::dvec3& point,
                                           const glm::dvec3& direction, double reach_mm) {
  return distance_until(false, ct, point, direction, reach_mm);
}

SkinContact::SkinContact(const Volume<std::int16_t>& ct, const Probe& probe) : ct_(&ct), places_(face_of(probe)) {}

bool SkinContact::at(const Pose& patient_from_probe) const {
  int touching = 0;
  for (const ScanLine& place : places_.lines)
    touching += distance_to_skin(*ct_, patient_from_probe.point(place.start),
                                 patient_from_probe.direction(place.direction), kUsualGel_mm)
                    .has_value();
  return 2 * touching >= kPlaces;
}

}  // namespace insonate
