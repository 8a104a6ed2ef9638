#pragma once

#include <optional>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"

namespace insonate {

/// A probe's imaging plane in several places: what a 3D probe gives that swings its plane through the body, by a motor
/// or by steering, and what a hand gives that moves a tracked 2D probe.
///
/// Planes are in the order of the sweep, at least two. To lie between two neighbours, a point has them on its two
/// sides: a sweep goes one way, and its planes do not cross in front of the face.
struct Sweep {
  Probe probe;                           ///< of each plane
  double depth_mm = 160;                 ///< along each line, 0.1 to 1000
  std::vector<Pose> patient_from_plane;  ///< rigid; the plane is that of x and y

  bool operator==(const Sweep&) const = default;
};

/// The planes of a 3D probe: tilted about an axis along x that lies `pivot_mm` behind the face's middle, from
/// -sweep_deg/2 (first plane) to sweep_deg/2 (last), which is towards +z, at equal angles.
/// @param planes     2 to 4096
/// @param sweep_deg  above 0, up to 150
/// @param pivot_mm   0 or more: the radius on which the face swings
std::vector<Pose> swept_planes(const Pose& patient_from_probe, int planes, double sweep_deg, double pivot_mm);

/// The first plane that goes back the way the planes before it came, as its middle shows, half the depth from the face;
/// empty for a sweep that goes one way. Where a hand rests planes may lie within a twentieth of a millimetre.
std::optional<std::size_t> turns_back_at(const Sweep& sweep);

/// All lines of a sweep, patient mm, plane by plane: line i of plane p is at p * probe.lines + i.
ScanLines scan_lines(const Sweep& sweep, int samples);

/// Where a point of the patient lies in a sweep: between two neighbouring planes, and among the lines of each where it
/// is nearest to them.
struct SweepPosition {
  int plane;             ///< the one before the point: 0 to planes - 2
  double share;          ///< of the way to the next, by distances to the two: 0 to 1
  LinePosition in_this;  ///< among the lines of `plane`
  LinePosition in_next;
};

/// Empty before the first plane, behind the last, and where it is outside the fan of either neighbour.
std::optional<SweepPosition> sweep_position(const Sweep& sweep, const glm::dvec3& patient_mm);

/// A grid of cubic voxels around all lines of a sweep. Its axes are those of the sweep's middle plane: i lateral, j
/// into the depth, k along the elevation.
/// @param voxel_mm  above 0
Grid sweep_grid(const Sweep& sweep, double voxel_mm);

/// A value at each sample of a sweep.
struct SweepValues {
  int samples = 0;             ///< a line; sample k at (k + 1/2) depth / samples from the face
  int lines = 0;               ///< a plane
  std::vector<double> values;  ///< samples fastest, then lines, then planes
};

}  // namespace insonate
