#pragma once

#include <cstddef>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/wein/wein_settings.h"

/// What both implementations of model W on the processor read. It is made once, before any image.
namespace insonate::bench {

/// A voxel: HU and its differences over the reflection length along the CT's axes, HU.
struct alignas(16) DensityVoxel {
  float hu = -1000, gradient[3] = {0, 0, 0};
};

/// A CT with its gradient. One voxel of air lies in front of the CT and two behind it along each axis. A position that
/// is held within -1 to the CT's size, in voxels, has all its eight neighbours, and air beyond the border.
struct DensityVoxels {
  Grid grid;                       ///< the CT's, without the air
  std::size_t row = 0, layer = 0;  ///< voxels from one row, and from one layer, to the next
  std::vector<DensityVoxel> voxels;

  /// @param reflection_length_mm  0.01 to 20
  DensityVoxels(const AcousticVolume& volume, double reflection_length_mm);

  /// Returns the voxel of an index of -1 to the CT's size + 1 along each axis.
  const DensityVoxel* at(int i, int j, int k) const {
    return voxels.data() + std::size_t(k + 1) * layer + std::size_t(j + 1) * row + std::size_t(i + 1);
  }
};

/// The place of a pixel inside the fan among the samples of the scan lines.
struct ProcessorPixel {
  int pixel;                   ///< index in the picture, row by row
  int line, sample;            ///< the scan line and sample in front of it
  int next_line, next_sample;  ///< how far it is to the next ones: 1, or 0 at the border
  float line_share, sample_share;
};

/// An image's geometry, which does not depend on the pose.
struct ProcessorFan {
  ScanLines lines;
  int width, height;
  std::vector<ProcessorPixel> pixels;

  /// @param depth_mm  0.1 to 1000
  ProcessorFan(const Probe& probe, double depth_mm, const WeinSettings& settings);
};

}  // namespace insonate::bench
