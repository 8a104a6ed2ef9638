#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>

#include "sim/core/grid.h"
#include "sim/core/pose.h"

namespace insonate {

/// Computes how mouse and keyboard move a probe: over the skin, as a hand would. Poses are patient_from_probe. The
/// faces at which the CT cuts the body towards head and feet are not skin, and the probe stops where these ends begin
/// to absorb sound (end_slices()): farther on its picture would be black. Keeps a reference to the CT.
class ProbeHand {
public:
  explicit ProbeHand(const Volume<std::int16_t>& ct) : ct_(&ct) {}

  /// Returns the pose moved along the skin by `mm` laterally (x, towards the marker) and in elevation (y). The face
  /// keeps its distance and its angle to the skin. Empty if there is no skin there, as at the end of the CT.
  std::optional<Pose> slide(const Pose& from, const glm::dvec2& mm) const;

  /// A slide over the skin.
  struct Slide {
    Pose pose;               ///< after it: the face has kept its distance and its angle to the skin
    glm::dvec3 way_mm{0.0};  ///< from the place on the skin to the one that was reached, patient
  };
  /// Returns the slide to where the beam of `to` enters the skin. Empty if either beam faces no skin.
  std::optional<Slide> slide_to(const Pose& from, const Pose& to) const;

  /// Returns the slide (for slide(), mm) that moves the face by `mm` around the body and towards the head. Around the
  /// body is to the patient's left on their front, on over the left flank to the back, and so on. Where the beam runs
  /// nearly along the body's axis, no direction along the face leads to the head: that part is zero, and the other one
  /// is to the patient's left.
  static glm::dvec2 slide_in_patient(const Pose& from, const glm::dvec2& mm);

  /// Returns the pose moved along the beam by `mm`, positive into the body. It never gets deeper than kDeepest_mm or
  /// farther away than kFarthest_mm.
  Pose press(const Pose& from, double mm) const;

  /// Returns the pose rotated about the middle of the face, in the probe's frame, degrees: tilt (about x, sweeps the
  /// plane), rotation (about the beam) and rock (about z, in the plane).
  static Pose turn(const Pose& from, double tilt_deg, double rotation_deg, double rock_deg);
  /// Returns turn(), with as much of tilt and rock as keeps the beam within kMostTilted_deg of straight into the skin:
  /// farther, the handle would come to lie on the body. Empty if nothing is left of the turn.
  std::optional<Pose> turn_on_skin(const Pose& from, double tilt_deg, double rotation_deg, double rock_deg) const;

  /// Returns the pose where a line of sight (patient, mm; unit direction) meets the skin, oriented to the skin there as
  /// it was before. A lifted probe is put down, and one that faced no skin, or was tilted farther than kMostTilted_deg,
  /// is put straight onto it. Empty if the line meets no skin.
  std::optional<Pose> put(const Pose& from, const glm::dvec3& eye, const glm::dvec3& direction) const;

  static constexpr double kDeepest_mm = 15;
  static constexpr double kFarthest_mm = 30;
  static constexpr double kMostTilted_deg = 60;

private:
  struct Contact {
    glm::dvec3 point;   ///< on the skin, where the beam enters
    glm::dvec3 inward;  ///< the skin's normal there, unit
  };
  std::optional<glm::dvec3> skin(const glm::dvec3& from, const glm::dvec3& direction, double farthest_mm) const;
  std::optional<glm::dvec3> inward(const glm::dvec3& point) const;
  std::optional<Contact> contact(const Pose& pose) const;
  std::optional<glm::dvec3> inward_at_face(const Pose& pose) const;
  /// Returns the pose that relates to the skin at `reached` as `from` relates to it at `old`.
  static Pose settle(const Pose& from, const Contact& old, const Contact& reached);

  const Volume<std::int16_t>* ct_;
};

}  // namespace insonate
