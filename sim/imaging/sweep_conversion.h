#pragma once

#include <vector>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/streamed_buffer.h"
#include "sim/gl/work_division.h"
#include "sim/probe/sweep.h"

namespace insonate::gl {

/// Converts a sweep to a volume on the graphics card. Each voxel mixes the two planes on its sides by its distances to
/// them, bilinear among the lines and samples of each. Filtering is exact in single precision.
///
/// The planes may come in parts. Needs an OpenGL 4.5 context that is current at every use. Throws std::runtime_error if
/// its shader does not compile.
class SweepConversion {
public:
  explicit SweepConversion(const ShaderSources& sources = {}, const WorkDivision& division = {});

  /// Places the volume, and allocates it if its size has changed. Throws DeviceRefused.
  /// @param grid  where the voxels lie in the patient
  void lay_out(const Grid& grid);

  /// Neighbouring planes of a sweep. A part begins with the last plane of the part before it, because voxels lie
  /// between planes. The first part starts the volume again; the others add to it.
  struct Part {
    int first = 0;   ///< plane of the sweep
    int planes = 2;  ///< 2 or more
  };
  /// Converts one part.
  /// @param values   at each sample of the part's lines: R32F, one row per line, plane by plane
  /// @param samples  per line
  void convert(const Sweep& sweep, const Part& part, const TexelBuffer& values, int samples);

  /// A run of the volume's slices, as many as fit one buffer of a shader.
  struct Slab {
    int first_slice, slices;
    TexelBuffer voxels;  ///< RG32F: value, share of the imaging depth along the line; 0, -1 outside
  };
  const std::vector<Slab>& slabs() const { return slabs_; }

  /// Reads the values back; NaN outside the sweep.
  Volume<float> read() const;

  /// For Program::reload().
  Program& program() { return program_; }

private:
  Program program_;
  WorkDivision division_;
  StreamedBuffer parameters_;
  TexelBuffer plane_from_voxel_;
  Grid grid_;
  std::vector<Slab> slabs_;
};

}  // namespace insonate::gl
