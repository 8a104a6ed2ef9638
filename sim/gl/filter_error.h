#pragma once

#include "sim/gl/program.h"

namespace insonate::gl {

/// The error of the current context's linear filter of 3D textures, as shares of the difference between neighbouring
/// voxels. Weights of n bits cause errors of up to 2^-(n+1) along each axis, 3 x 2^-(n+1) in all.
struct FilterError {
  double largest = 0, rms = 0;

  /// True if the error shows in differences between near samples. The limit is the error of a sample's position that
  /// the tests' tolerances allow for.
  bool is_coarse() const { return largest > 2e-5; }
};

/// Measures the filter at places all over a small texture of alternating voxels. Throws std::runtime_error if its
/// shader does not compile.
FilterError measure_filter(const ShaderSources& sources = {});

}  // namespace insonate::gl
