#pragma once

#include <cstdint>

#include "sim/probe/sweep.h"
#include "sim/reference/reference.h"

namespace insonate {

/// Converts a sweep to a volume in double precision and plain loops. sweep_position() places each voxel. Its value is
/// bilinear in each of the two planes and mixed by its share of the way between them. NaN outside the sweep.
Volume<double> convert_sweep_reference(const Sweep& sweep, const SweepValues& values, const Grid& grid);

/// The results of model S of a sweep, in double precision. simulate_reference() runs on each plane. From its results
/// follows U (6) at each sample of the planes' lines, without the smoothing of pictures, and is converted to the
/// voxels. Gain and log compression (7) follow there, at the voxel's depth, which scan conversion interpolates as it
/// does U.
struct ReferenceVolume {
  Volume<double> fused;       ///< U before gain; NaN outside the sweep
  Volume<std::int16_t> grey;  ///< 0 to 255; -1 outside the sweep
};
ReferenceVolume simulate_sweep_reference(const MediumField& field, const TissueTable& table, const Sweep& sweep,
                                         const Settings& settings, const Grid& grid);

}  // namespace insonate
