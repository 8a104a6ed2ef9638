#pragma once

#include "sim/probe/sweep.h"

namespace insonate {

/// Scan conversion of a sweep to a volume in double precision, in plain loops: each voxel is looked up by
/// sweep_position(), bilinear in each of the two planes, and mixed by its share. NaN outside the sweep.
Volume<double> convert_sweep_reference(const Sweep& sweep, const SweepValues& values, const Grid& grid);

}  // namespace insonate
