#pragma once

#include <glm/vec2.hpp>

#include "sim/probe/probe.h"

namespace insonate {

/// Converts between the probe's imaging plane (mm; x lateral towards the marker, y along the central beam) and the
/// screen (pixels from the top left), where a picture of that plane fills an area. The marker's side, +x, is on the
/// left, or on the right if asked for. Exact for any size of area and picture: each direction has its own scale,
/// because a picture that is computed for fewer pixels than it is shown in may be stretched by a fraction of a pixel.
class PlaneOnScreen {
public:
  PlaneOnScreen(const glm::dvec2& area_top_left, const glm::dvec2& area_size, const ImageGeometry& geometry,
                bool marker_on_right = false)
      : geometry_(geometry),
        first_pixel_(area_top_left.x + (marker_on_right ? 0 : area_size.x), area_top_left.y),
        scale_((marker_on_right ? 1 : -1) * area_size.x / geometry.width, area_size.y / geometry.height) {}

  /// Returns the screen position. The 0.5 is there because a pixel's centre lies half a pixel from its edges.
  glm::dvec2 screen(const glm::dvec2& plane_mm) const {
    return first_pixel_ + scale_ * (geometry_.pixel(plane_mm) + 0.5);
  }
  glm::dvec2 plane_mm(const glm::dvec2& screen) const {
    const glm::dvec2 pixel = (screen - first_pixel_) / scale_ - 0.5;
    return geometry_.plane_mm(pixel.x, pixel.y);
  }
  /// Returns the scale along the picture's height.
  double pixels_per_mm() const { return scale_.y / geometry_.mm_per_pixel; }

private:
  ImageGeometry geometry_;
  glm::dvec2 first_pixel_;  ///< the corner where the picture's pixel (0, 0) is shown
  glm::dvec2 scale_;        ///< screen pixels per picture pixel, negative where it is mirrored
};

}  // namespace insonate
