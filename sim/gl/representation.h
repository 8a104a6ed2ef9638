#pragma once

namespace insonate::gl {

/// How a voxel's two numbers, density and echogenicity, are kept on the device. Eight bits are none of them: over the
/// 4096 HU of a CT their steps are 16 HU, at which alone an interface of soft tissue reflects 2e-4, as much as that of
/// an organ.
enum class VolumeFormat {
  normalized_16,  ///< 16-bit normalised: exact, 4 bytes a voxel
  float_16,       ///< half floats: rounded by up to 0.25 HU at 1000 HU and 0.02 dB at -60 dB, 4 bytes
  float_32        ///< exact, 8 bytes
};

/// How model S keeps its numbers on the device; Scheme, beside it, is how the work is shared out. What each choice
/// costs and how far it is from the converged picture tells `insonate-bench front`; tests/gl/representation_gl_test.cpp
/// holds each against the default and the reference.
///
/// The default is what that command found best on llvmpipe, where alone it has been run: 32-bit volumes take twice the
/// memory for a few per cent of time, less on one processor and more on another, and gain nothing that shows; half
/// floats gain nothing that shows and cost time between stages; and a stored gradient gains about as much time for as
/// much error as fewer samples do, and takes memory.
struct Representation {
  VolumeFormat volume = VolumeFormat::normalized_16;

  /// What stages hand on (scan, echoes, picture) has 16 bits a number instead of 32, and of what falls with the depth
  /// the fourth root, because I^2 and R span more decades than half floats do (sim/shaders/shared/handed_on.glsl): a
  /// level is off by up to 0.04 dB, a fifth of a grey level.
  bool half_floats = false;

  /// The normals of interfaces, and the densities beside a line that edge shadows hang on, come from a gradient stored
  /// with each voxel (sim/gl/density_volume.h, 8 or 16 bytes more), by one fetch instead of four differences over the
  /// reflection length. It comes from voxels two apart, so that an edge between two of them is met in the cells beside
  /// it too, half as steep: where density rises evenly nothing changes, edges of few voxels cast wider shadows.
  bool stored_gradient = false;

  bool operator==(const Representation&) const = default;
};

}  // namespace insonate::gl
