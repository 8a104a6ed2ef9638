#pragma once

#include <array>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/streamed_buffer.h"
#include "sim/imaging/device_volume.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate::gl {

/// The traversal of model S by the method of Kutter, Shams, Navab 2009, which benchmarks compare with the simulator's.
/// There is one render pass for each of the D samples of a line. A pass draws one line primitive, with one fragment for
/// each of the N scan lines. It reads the results of the previous pass from a target that alternates with its own.
///
/// I and R are those of sim/reference/reference.h in single precision: the same tissue table, reflection length,
/// trilinear volume and gradient. A pass changes no state except its targets. The reflection length can equal the
/// distance between samples, as in the paper, or twice that. Its ends then coincide with other samples, and values that
/// earlier passes fetched are not fetched again.
class PaperTraversal {
public:
  /// Throws std::runtime_error if its shaders do not compile.
  PaperTraversal();

  /// Throws TextureRefused if the device cannot hold the volume.
  void set_volume(const AcousticVolume& volume, const TissueTable& table);
  /// Sets the scan lines.
  /// @param settings  settings of the traversal, for one plane without edge shadow; the number of samples is that of
  ///                  `lines`
  void set_lines(const ScanLines& lines, const Settings& settings);

  /// Positions the lines and draws the D passes. Leaves no framebuffer bound.
  void run(const Pose& patient_from_probe);

  /// The output of the last run: x line, y sample.
  struct Scan {
    Image<float> intensity, reflection;
  };
  Scan read() const;

private:
  std::array<Program, 3> passes_;  ///< index: samples per reflection length, 1, 2, or any (0)
  ScanLines lines_;
  Settings settings_;
  DeviceVolume volume_;
  Texture scan_;
  StreamedBuffer line_buffer_;
  struct Side {
    Texture carried;
    Object<FramebufferKind> framebuffer;
  };
  std::array<Side, 2> sides_;  ///< passes of even and odd number write to these
  Object<VertexArrayKind> no_vertices_;
};

}  // namespace insonate::gl
