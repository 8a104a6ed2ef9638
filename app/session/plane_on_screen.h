#pragma once

#include <glm/vec2.hpp>

#include "sim/probe/probe.h"

namespace insonate {

/// Between the probe's imaging plane (mm; x lateral towards the marker, y along the central beam) and the screen
/// (pixels from the top left), where a picture of that plane fills an area. The marker's side, +x, is on the left.
/// Exact for any size of area and picture: the two directions have scales of their own, as a picture that is computed
/// for fewer pixels than it is shown in may be stretched by part of one.
class PlaneOnScreen {
public:
  PlaneOnScreen(const glm::dvec2& area_top_left, const glm::dvec2& area_size, const ImageGeometry& geometry)
      : geometry_(geometry),
        top_right_(area_top_left.x + area_size.x, area_top_left.y),
        scale_(-area_size.x / geometry.width, area_size.y / geometry.height) {}

  /// A pixel's centre lies half of it from its edges.
  glm::dvec2 screen(const glm::dvec2& plane_mm) const {
    return top_right_ + scale_ * (geometry_.pixel(plane_mm) + 0.5);
  }
  glm::dvec2 plane_mm(const glm::dvec2& screen) const {
    const glm::dvec2 pixel = (screen - top_right_) / scale_ - 0.5;
    return geometry_.plane_mm(pixel.x, pixel.y);
  }
  /// Along the picture's height.
  double pixels_per_mm() const { return scale_.y / geometry_.mm_per_pixel; }

private:
  ImageGeometry geometry_;
  glm::dvec2 top_right_;
  glm::dvec2 scale_;  ///< screen pixels a picture's pixel
};

}  // namespace insonate
