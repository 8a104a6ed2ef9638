#pragma once

#include <optional>

#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Body begins here on the way in from the air: half way between air (-1000 HU) and fat (about -100).
inline constexpr double kSkinHu = -500;

/// How far a point moves along a unit direction (patient, mm) until it meets the body, found to 0.01 mm; empty when it
/// does not within `reach_mm`. 0 when it starts inside.
std::optional<double> distance_to_skin(const Volume<std::int16_t>& ct, const glm::dvec3& point,
                                       const glm::dvec3& direction, double reach_mm);

/// Whether the face of a probe is on the skin: along the beam there is body within the thickness of coupling gel at
/// half of the places or more that are looked at, evenly spread across the face. Deeper than the skin counts as on it.
class SkinContact {
public:
  static constexpr double kGel_mm = 6;
  static constexpr int kPlaces = 5;

  SkinContact(const Volume<std::int16_t>& ct, const Probe& probe);
  bool at(const Pose& patient_from_probe) const;

private:
  const Volume<std::int16_t>* ct_;
  ScanLines places_;
};

}  // namespace insonate
