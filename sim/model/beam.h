#pragma once

#include <vector>

#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The window (4) over the lines of the active aperture: `beam_lines` weights, symmetric, sum 1.
std::vector<double> beam_weights(const Settings& settings);

/// What the speckle's envelope is multiplied by at each sample so that fully developed speckle has a mean of 1.
///
/// Where lines lie closer together than the scatterers' cells, neighbouring lines see the same scatterers and their
/// window averages less away; without this the near field of a fan would be brighter than its depth. The correlation
/// between lines a distance d apart is that of linear interpolation: the cubic B-spline in d / cell.
std::vector<double> envelope_scale(const ScanLines& lines, const Settings& settings);

}  // namespace insonate
