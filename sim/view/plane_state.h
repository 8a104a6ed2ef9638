#pragma once

#include <glm/vec2.hpp>

#include "sim/view/ultrasound_plane.h"

namespace insonate::view {

/// Compares two planes without reading their pixels.
struct PlaneState {
  const gl::Texture* image = nullptr;
  long image_version = 0;
  int width = 0, height = 0;
  double mm_per_pixel = 0;
  glm::dvec2 top_left_mm{0.0};
  ProbeKind kind{};
  double face_mm[3] = {};  // radius, field of view, width
  Pose patient_from_probe;

  explicit PlaneState(const UltrasoundPlane& plane)
      : image(plane.image),
        image_version(plane.image_version),
        width(plane.geometry.width),
        height(plane.geometry.height),
        mm_per_pixel(plane.geometry.mm_per_pixel),
        top_left_mm(plane.geometry.top_left_mm),
        kind(plane.probe.kind),
        face_mm{plane.probe.radius_mm, plane.probe.field_of_view_deg, plane.probe.width_mm},
        patient_from_probe(plane.patient_from_probe) {}
  bool operator==(const PlaneState&) const = default;
};

}  // namespace insonate::view
