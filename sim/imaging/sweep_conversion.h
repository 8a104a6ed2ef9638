#pragma once

#include <vector>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/probe/sweep.h"

namespace insonate::gl {

/// Scan conversion of a sweep to a volume on the graphics card: each voxel takes from the two planes on its sides, by
/// its distances to them, bilinear among the lines and samples of each. Exact filtering in single precision.
///
/// The planes may come part by part. Needs an OpenGL 4.5 context, current whenever it is used. Throws
/// std::runtime_error when its shader does not build.
class SweepConversion {
public:
  explicit SweepConversion(const ShaderSources& sources = {}, const WorkDivision& division = {});

  /// Places the volume, and allocates it if it has another size. Throws DeviceRefused.
  /// @param grid  where the voxels lie in the patient
  void lay_out(const Grid& grid);

  /// Neighbouring planes of a sweep. A part begins with the plane that the part before it ends with, because voxels lie
  /// between planes; the first one makes the volume anew, the others add to it.
  struct Part {
    int first = 0;   ///< plane of the sweep
    int planes = 2;  ///< 2 or more
  };
  /// @param values   at each sample of the part's lines: R32F, a row a line, plane by plane
  /// @param samples  a line
  void convert(const Sweep& sweep, const Part& part, const TexelBuffer& values, int samples);

  /// The volume's slices, as many together as a shader can have in a buffer.
  struct Slab {
    int first_slice, slices;
    TexelBuffer voxels;  ///< RG32F: the value, and its share of the imaging depth along the line; 0, -1 outside
  };
  const std::vector<Slab>& slabs() const { return slabs_; }

  /// The values read back; NaN outside the sweep.
  Volume<float> read() const;

  /// For Program::reload().
  Program& program() { return program_; }

private:
  Program program_;
  WorkDivision division_;
  Buffer parameters_;
  TexelBuffer plane_from_voxel_;
  Grid grid_;
  std::vector<Slab> slabs_;
};

}  // namespace insonate::gl
