#pragma once

#include <cstdint>

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/probe/probe.h"

namespace insonate::bench {

/// A picture as it is displayed.
struct Display {
  ImageGeometry geometry;
  Image<std::uint8_t> inside;  ///< 1 inside the fan
  Image<double> db;            ///< echo after gain relative to white, no lower than what is black
  Image<double> grey;          ///< 0 to 255
};

/// @param settings  those of the stages, with a fixed reference level
template <typename Real>
Display displayed(const Stages<Real>& stages, const Probe& probe, double depth_mm, const Settings& settings);

struct DisplayError {
  double db = 0;    ///< RMS over the pixels that the converged picture shows neither black nor white
  double grey = 0;  ///< RMS over the fan
};

/// Compares on the converged picture's pixels, over which the other is drawn by linear interpolation between its own
/// pixels inside the fan.
DisplayError error_of(const Display& shown, const Display& converged, double dynamic_range_db);

}  // namespace insonate::bench
