#pragma once

#include <cstdint>

#include "sim/probe/sweep.h"
#include "sim/reference/reference.h"

namespace insonate {

/// Scan conversion of a sweep to a volume in double precision, in plain loops: each voxel is looked up by
/// sweep_position(), bilinear in each of the two planes, and mixed by its share. NaN outside the sweep.
Volume<double> convert_sweep_reference(const Sweep& sweep, const SweepValues& values, const Grid& grid);

/// Model S of a sweep in double precision: U (6) at each sample of its planes' lines, without the smoothing of
/// pictures, of what simulate_reference() gives for each plane; brought to the voxels; and gain and log compression (7)
/// there, at the depth that scan conversion gives a voxel as it does U.
struct ReferenceVolume {
  Volume<double> fused;       ///< U before gain; NaN outside the sweep
  Volume<std::int16_t> grey;  ///< 0 to 255; -1 outside the sweep
};
ReferenceVolume simulate_sweep_reference(const MediumField& field, const TissueTable& table, const Sweep& sweep,
                                         const Settings& settings, const Grid& grid);

}  // namespace insonate
