#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The part of a picture that shows tissue. Pictures of one probe at one depth share it.
struct PictureRegion {
  /// The pixels [begin, end) of a row that may be inside.
  struct Span {
    int begin = 0, end = 0;
  };

  Image<std::uint8_t> inside;       ///< 1 for each pixel that shows tissue, else 0
  std::vector<Span> spans;          ///< per row; empty where begin equals end
  std::vector<glm::dvec2> outline;  ///< points around the part, pixels; all of it lies in their convex hull

  int width() const { return inside.width; }
  int height() const { return inside.height; }
};

/// Returns the fan of a probe in a picture of that geometry: the pixels whose centres lie among the lines.
/// @param depth_mm  0.1 to 1000
std::shared_ptr<const PictureRegion> fan_region(const Probe& probe, double depth_mm, const ImageGeometry& geometry);

/// Returns the part of a picture where `inside` returns true. Its outline is empty if that is nowhere.
/// @param inside  called from several threads
std::shared_ptr<const PictureRegion> region_where(int width, int height,
                                                  const std::function<bool(int x, int y)>& inside);

/// A rectangle of pixels.
struct PixelRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Returns a rectangle of a picture, as for a recording whose transducer is unknown.
/// @param part  within the picture, not empty
std::shared_ptr<const PictureRegion> rectangle_region(int width, int height, const PixelRectangle& part);

/// A picture of a tracked probe.
struct TrackedPicture {
  Image<std::uint8_t> grey;                     ///< of the region's size
  std::shared_ptr<const PictureRegion> region;  ///< never null
  /// Maps (column, row, 0, 1), the centre of a pixel, to the patient, mm. Affine; columns and rows are perpendicular.
  glm::dmat4 patient_from_pixel{1.0};
  double time_s = 0;  ///< on one clock for all pictures of a sweep, rising
};

/// Returns the matrix patient_from_pixel of a picture of that geometry.
glm::dmat4 patient_from_pixel(const Pose& patient_from_probe, const ImageGeometry& geometry);

/// Returns a frame in the picture: origin at pixel (0, 0), x along the rows, y along the columns, z perpendicular to
/// both.
Pose plane_of(const glm::dmat4& patient_from_pixel);

}  // namespace insonate
