#pragma once

#include <string>
#include <vector>

#include "sim/core/pose.h"

namespace insonate {

/// The movements from the probe's current pose to a reference view, in the terms of sonography and in their order:
/// slide, rotate about the beam, tilt about the lateral axis, rock about the elevation axis. Each turn is about the
/// probe's own axes as the turns before it left them. So the rotation between the two poses, in the probe's frame, is
/// Ry(rotation) Rx(tilt) Rz(rock), right-hand rule, and a part of one movement leaves the amounts of the next as they
/// are.
///
/// These are not the angles of ViewValues, which lead from the reference to the probe in another order. Where only one
/// angle differs from 0, both have it with opposite signs.
struct GuidingMove {
  glm::dvec3 slide_mm{0.0};  ///< displacement of the face in patient coordinates, without the component along the
                             ///< reference's beam, which is pressing
  double rotation_deg = 0;   ///< -180 to 180; positive: clockwise, seen from the probe's handle
  double tilt_deg = 0;       ///< -180 to 180; positive: the beam moves towards the probe's +z
  double rock_deg = 0;       ///< -90 to 90; positive: the beam moves away from the marker
};

/// Returns the movement from the probe's pose to a reference pose.
GuidingMove move_to(const Pose& patient_from_probe, const Pose& reference);

/// Movements up to these limits count as no difference: in_words() does not mention them.
struct GuidingLimits {
  double slide_mm = 5, turn_deg = 5;
};

/// Returns the movement as a teacher gives it at the bedside, one sentence for each part above its limit, in the
/// order of execution: "Slide 32 mm towards the head." Returns nothing if the probe is in place.
std::vector<std::string> in_words(const GuidingMove& move, const Pose& patient_from_probe,
                                  const GuidingLimits& limits = {});

}  // namespace insonate
