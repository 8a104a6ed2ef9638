#pragma once

#include <array>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/imaging/device_volume.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/settings.h"
#include "sim/model/tissue.h"
#include "sim/probe/probe.h"

namespace insonate::gl {

/// The traversal of model S by the method of Kutter, Shams, Navab 2009, with which benchmarks compare the simulator's:
/// a render pass for each of the D samples of a line draws one line primitive, a fragment for each of the N scan lines,
/// and reads what the pass before it left in a target that it swaps with its own.
///
/// I and R are those of sim/reference/reference.h in single precision: the same tissue table, reflection length,
/// trilinear volume and gradient. A pass changes no more state than its targets. Where the reflection length is the
/// distance between samples, as in the paper, or twice that, its ends meet other samples', and what the passes before
/// have fetched is not fetched again.
class PaperTraversal {
public:
  /// Throws std::runtime_error when its shaders do not build.
  PaperTraversal();

  /// Throws TextureRefused when the device cannot hold it.
  void set_volume(const AcousticVolume& volume, const TissueTable& table);
  /// @param settings  those of the traversal, of one plane without edge shadow; the number of samples is that of
  /// `lines`
  void set_lines(const ScanLines& lines, const Settings& settings);

  /// Places the lines and draws the D passes. Leaves no framebuffer bound.
  void run(const Pose& patient_from_probe);

  /// What the last run wrote: x line, y sample.
  struct Scan {
    Image<float> intensity, reflection;
  };
  Scan read() const;

private:
  std::array<Program, 3> passes_;  ///< by how many samples a reflection length has: 1, 2, or any (0)
  ScanLines lines_;
  Settings settings_;
  DeviceVolume volume_;
  Texture scan_;
  Buffer line_buffer_;
  struct Side {
    Texture carried;
    Object<FramebufferKind> framebuffer;
  };
  std::array<Side, 2> sides_;  ///< passes of even and of odd number write to these
  Object<VertexArrayKind> no_vertices_;
};

}  // namespace insonate::gl
