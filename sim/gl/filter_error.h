#pragma once

#include "sim/gl/program.h"

namespace insonate::gl {

/// What the current context's linear filter of 3D textures is off by, as shares of the difference between neighbouring
/// voxels: weights of n bits are off by up to 2^-(n+1) along each axis, 3 x 2^-(n+1) in all.
struct FilterError {
  double largest = 0, rms = 0;

  /// Whether differences of near samples feel it, which is what the tests' tolerances allow for in a sample's place.
  bool is_coarse() const { return largest > 2e-5; }
};

/// Measured at places all over a small texture of alternating voxels. Throws std::runtime_error when its shader does
/// not build.
FilterError measure_filter(const ShaderSources& sources = {});

}  // namespace insonate::gl
