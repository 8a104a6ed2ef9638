#include "devices/calibration/face.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace insonate {

Outcome<FaceFit> fit_face(const FacePoints& points) {
  const glm::dvec3 along = points.marker_end - points.other_end, ahead = points.middle - points.tail;
  if (!(glm::length(along) >= kMinFace_mm))
    return Refusal{"The ends of the face lie in one place; give the end at the marker and the one across from it."};
  if (!(glm::length(ahead) >= kMinHandle_mm))
    return Refusal{
        "The probe's tail lies too near to its face; give the far end of the handle, where the cable leaves."};
  FaceFit fit;
  const glm::dvec3 y = glm::normalize(ahead), across = glm::normalize(along);
  fit.skew_deg = glm::degrees(std::asin(std::clamp(std::abs(glm::dot(across, y)), 0.0, 1.0)));
  fit.off_middle_mm = std::abs(glm::dot(points.middle - (points.marker_end + points.other_end) / 2.0, across));
  char text[200];
  if (fit.skew_deg > kMaxSkew_deg) {
    std::snprintf(text, sizeof text,
                  "Face and handle are %.0f degrees off a right angle; give the ends of the face and the tail again.",
                  fit.skew_deg);
    return Refusal{text};
  }
  if (fit.off_middle_mm > kMaxOffMiddle_mm) {
    std::snprintf(text, sizeof text,
                  "The face's middle lies %.1f mm away from between its ends; give middle and ends again.",
                  fit.off_middle_mm);
    return Refusal{text};
  }
  const glm::dvec3 x = glm::normalize(across - glm::dot(across, y) * y);
  fit.sensor_from_face = {glm::dmat3(x, y, glm::cross(x, y)), points.middle};
  return fit;
}

}  // namespace insonate
