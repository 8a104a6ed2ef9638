#pragma once

#include <glm/vec3.hpp>

#include "sim/core/pose.h"

namespace insonate {

/// What a tracker may need to know of the patient, in the patient's frame (LPS, mm).
struct TrackerContext {
  glm::dvec3 body_min{-160, -110, -150};  ///< corners of the body's bounding box: an adult's trunk unless told
  glm::dvec3 body_max{160, 110, 150};
  Pose start;  ///< patient_from_probe where a tracker begins that has no place of its own
};

}  // namespace insonate
