#pragma once

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The clutter from the body wall (sim/model/noise.h), 0 without waves or clutter.
struct WallClutter {
  Image<double> most, per_arriving;  ///< H and H/J: one column, by sample
  Image<double> arriving;            ///< I^2: x line, y sample

  /// Returns the clutter's power between samples.
  double at(double line, double sample) const;
};

/// @param stages  f and I of the lines
WallClutter wall_clutter_reference(const Stages<double>& stages, const ScanLines& lines, const Settings& settings);

}  // namespace insonate
