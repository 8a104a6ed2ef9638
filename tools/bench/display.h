#pragma once

#include <cstdint>

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/probe/probe.h"

namespace insonate::bench {

/// A displayed picture.
struct Display {
  ImageGeometry geometry;
  Image<std::uint8_t> inside;  ///< 1 inside the fan
  Image<double> db;            ///< echo after gain relative to white, clamped at black
  Image<double> grey;          ///< 0 to 255
};

/// Returns the displayed picture of the stages.
/// @param settings  settings of the stages, with a fixed reference level
template <typename Real>
Display displayed(const Stages<Real>& stages, const Probe& probe, double depth_mm, const Settings& settings);

/// The error of a displayed picture.
struct DisplayError {
  double db = 0;    ///< RMS over the pixels that are neither black nor white in the converged picture
  double grey = 0;  ///< RMS over the fan
};

/// Returns the error of `shown` on the converged picture's pixels. There, `shown` is interpolated linearly between its
/// own pixels inside the fan.
DisplayError error_of(const Display& shown, const Display& converged, double dynamic_range_db);

}  // namespace insonate::bench
