#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <optional>
#include <vector>

#include "sim/core/pose.h"
#include "sim/probe/probe.h"
#include "sim/view/axis_slice.h"

namespace insonate::view {

using PixelLine = std::array<glm::dvec2, 2>;

/// Where the plane of an ultrasound picture appears in an axis slice, in pixels as AxisSlice::pixel() counts them.
struct PlaneTrace {
  std::optional<PixelLine> line;  ///< where the planes cross, from edge to edge of the picture
  std::vector<PixelLine> in_fan;  ///< the parts of that line inside the fan, from the first end to the last
  std::vector<glm::dvec2>
      outline;  ///< the fan's outline, closed, if the slice lies in its plane; then there is no line
};

/// Planes that differ by less are taken as one. A slice that then passes the middle of the fan by kSamePlane_mm or more
/// has an empty trace.
inline constexpr double kSamePlane_deg = 2, kSamePlane_mm = 3;

/// @param depth_mm  how deep the fan reaches
PlaneTrace trace_of_plane(const AxisSlice& slice, const Pose& patient_from_probe, const Probe& probe, double depth_mm);

/// Returns the outline of a probe's fan in its plane (x lateral, y along the central beam), mm, closed without
/// repeating the first point.
/// @param lines  the points along the face, and along the far end; at least 2
std::vector<glm::dvec2> fan_outline(const Probe& probe, double depth_mm, int lines = 32);

}  // namespace insonate::view
