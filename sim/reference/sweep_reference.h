#pragma once

#include <cstdint>

#include "sim/probe/sweep.h"
#include "sim/reference/reference.h"

namespace insonate {

/// Converts a sweep to a volume in double precision and plain loops. sweep_position() places each voxel. Its value is
/// bilinear in each of the two planes and mixed by its share of the way between them. NaN outside the sweep.
Volume<double> convert_sweep_reference(const Sweep& sweep, const SweepValues& values, const Grid& grid);

/// The results of model S of a sweep, in double precision. U (6) follows at each sample of the planes' lines from what
/// simulate_reference() computes per plane, without the smoothing of pictures. It is then converted to the voxels. Gain
/// and log compression (7) follow there, at the depth that scan conversion gives a voxel by the same interpolation as
/// U.
struct ReferenceVolume {
  Volume<double> fused;       ///< U before gain; NaN outside the sweep
  Volume<std::int16_t> grey;  ///< 0 to 255; -1 outside the sweep
};
ReferenceVolume simulate_sweep_reference(const MediumField& field, const TissueTable& table, const Sweep& sweep,
                                         const Settings& settings, const Grid& grid);

}  // namespace insonate
