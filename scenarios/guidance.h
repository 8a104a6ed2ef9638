#pragma once

#include <string>
#include <vector>

#include "sim/core/pose.h"

namespace insonate {

/// How the probe has to be moved from where it is to a reference view, in the terms of sonography: first slid over the
/// skin, then tilted about its lateral axis, rocked about its elevation, and rotated about the beam it has by then. The
/// turn from one pose to the other, in the probe's frame, is Rx(tilt) Rz(rock) Ry(rotation), right-hand rule.
struct GuidingMove {
  glm::dvec3 slide_mm{0.0};  ///< of the face, patient; without what lies along the probe's beam, which is pressing
  double tilt_deg = 0;       ///< -180 to 180; positive: the beam moves towards the probe's +z
  double rock_deg = 0;       ///< -90 to 90; positive: the beam moves away from the marker
  double rotation_deg = 0;   ///< -180 to 180; positive: clockwise, seen from the probe's handle
};

GuidingMove move_to(const Pose& patient_from_probe, const Pose& reference);

/// What is as good as there: a teacher says nothing more of it.
inline constexpr double kGuidedSlide_mm = 5, kGuidedTurn_deg = 5;

/// The move as a teacher says it beside the bed, one sentence for each part that is worth saying, in the order in which
/// they are best done: "Slide 32 mm towards the head." Empty when the probe is there.
std::vector<std::string> in_words(const GuidingMove& move, const Pose& patient_from_probe);

}  // namespace insonate
