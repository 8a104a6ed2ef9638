#pragma once

#include <optional>
#include <string>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/probe/sweep.h"

namespace insonate::gl {

/// Scan conversion of a sweep to a volume on the graphics card: each voxel takes from the two planes on its sides, by
/// its distances to them, bilinear among the lines and samples of each. Exact filtering in single precision.
///
/// Needs an OpenGL 4.5 context, current whenever it is used. Throws std::runtime_error when its shader does not build.
class VolumeSweep {
public:
  explicit VolumeSweep(const ShaderSources& sources = {});

  /// RG32F, as large as the grid: the value and 1, or 0 and 0 outside the sweep. Stands until the next call. Throws
  /// TextureRefused when the device cannot hold the values or the volume.
  /// @param values  of the sweep's probe and number of planes
  /// @param grid    where the voxels lie in the patient
  const Texture& convert(const Sweep& sweep, const SweepValues& values, const Grid& grid);

  /// Builds the shader again; when that fails it goes on as it was and the compiler's words are returned.
  std::optional<std::string> reload(const ShaderSources& sources) { return program_.reload(sources); }

private:
  Program program_;
  Buffer parameters_;
  Texture values_, plane_from_voxel_, volume_;
};

/// What convert() gives, read back: NaN outside the sweep.
Volume<float> read_swept_volume(const Texture& volume, const Grid& grid);

}  // namespace insonate::gl
