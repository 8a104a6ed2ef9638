#pragma once

#include <cstdint>
#include <span>

#include "tools/bench/processor/density_voxels.h"

/// Model W's images (sim/wein/wein_settings.h) computed by the processor's own instructions, without OpenGL:
/// what the graphics pipeline is compared with. `exact_filter` has no meaning here: both interpolate exactly.
namespace insonate::bench {

/// Computes the images one after the other on one core, in double precision and plain loops, as one would write it down
/// first.
/// @param pictures  width x height grey values per pose; pixels outside the fan are left as they are
void simulate_plainly(const DensityVoxels& ct, const ProcessorFan& fan, const WeinSettings& settings,
                      std::span<const Pose> patient_from_probe, std::span<std::uint8_t> pictures);

/// Computes the images in single precision on all cores, eight scan lines side by side in the lanes of vector
/// instructions, the four values of a voxel in those of one load. The same images but for rounding: one grey level.
void simulate_vectorised(const DensityVoxels& ct, const ProcessorFan& fan, const WeinSettings& settings,
                         std::span<const Pose> patient_from_probe, std::span<std::uint8_t> pictures);

}  // namespace insonate::bench
