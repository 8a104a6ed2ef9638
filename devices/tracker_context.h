#pragma once

#include <glm/vec3.hpp>

#include "sim/core/pose.h"

namespace insonate {

/// What a tracker may need to know about the patient, in the patient's frame (LPS, mm).
struct TrackerContext {
  glm::dvec3 body_min{-160, -110, -150};  ///< corners of the body's bounding box; the default is an adult's trunk
  glm::dvec3 body_max{160, 110, 150};
  Pose start;  ///< patient_from_probe at which a tracker without an absolute position begins
};

}  // namespace insonate
