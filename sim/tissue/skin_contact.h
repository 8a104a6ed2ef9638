#pragma once

#include <optional>

#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The density of the body's surface: half way between air (-1000 HU) and fat (about -100 HU).
inline constexpr double kSkin_hu = -500;

/// Returns how far a point moves along a unit direction (patient, mm) until it meets the body, to 0.01 mm. Returns
/// nothing if it does not within `reach_mm`, and 0 if it starts inside.
std::optional<double> distance_to_skin(const Volume<std::int16_t>& ct, const glm::dvec3& point,
                                       const glm::dvec3& direction, double reach_mm);

/// Returns how far a point in the body moves along a unit direction (patient, mm) until it leaves the body, to 0.01 mm.
/// Returns nothing if it does not within `reach_mm`, and 0 if it starts outside.
std::optional<double> distance_out_of_body(const Volume<std::int16_t>& ct, const glm::dvec3& point,
                                           const glm::dvec3& direction, double reach_mm);

/// Detects whether a probe's face is on the skin. It tests evenly spaced places across the face. The face is on the
/// skin if at half of the places or more there is body along the beam within the thickness of coupling gel. A face
/// deeper than the skin counts as on it.
class SkinContact {
public:
  static constexpr int kPlaces = 5;

  /// @param ct  must outlive this object
  SkinContact(const Volume<std::int16_t>& ct, const Probe& probe);
  /// Returns whether the face is on the skin at this pose.
  bool at(const Pose& patient_from_probe) const;

private:
  const Volume<std::int16_t>* ct_;
  ScanLines places_;
};

}  // namespace insonate
