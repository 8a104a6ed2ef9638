#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>

#include "sim/core/grid.h"
#include "sim/core/pose.h"

namespace insonate {

/// How a probe moves when it is led by mouse and keyboard: as a hand would, over the skin. Poses are
/// patient_from_probe. Keeps a reference to the CT.
class ProbeHand {
public:
  explicit ProbeHand(const Volume<std::int16_t>& ct) : ct_(&ct) {}

  /// Along the skin by `mm` laterally (x, towards the marker) and in elevation (y): the face keeps its distance from
  /// the skin and its angle to it. Stays where it is when there is no skin there.
  Pose slide(const Pose& from, const glm::dvec2& mm) const;

  /// Along the beam by `mm`, positive into the body; never deeper than kDeepest_mm or farther off than kFarthest_mm.
  Pose press(const Pose& from, double mm) const;

  /// About the middle of the face, in the probe's frame: tilt (about x, sweeps the plane), rotation (about the beam)
  /// and rock (about z, in the plane), degrees.
  static Pose turn(const Pose& from, double tilt_deg, double rotation_deg, double rock_deg);

  /// To where a line of sight (patient, mm; unit direction) meets the skin, turned with the skin. Stays where it is
  /// when it meets none.
  Pose put(const Pose& from, const glm::dvec3& eye, const glm::dvec3& direction) const;

  static constexpr double kDeepest_mm = 15;
  static constexpr double kFarthest_mm = 30;

private:
  struct Contact {
    glm::dvec3 point;   ///< on the skin, where the beam enters
    glm::dvec3 inward;  ///< the skin's normal there, unit
  };
  std::optional<Contact> contact(const Pose& pose) const;
  /// The pose that meets the skin elsewhere as it met it before.
  static Pose settle(const Pose& from, const Contact& old, const Contact& reached);

  const Volume<std::int16_t>* ct_;
};

}  // namespace insonate
