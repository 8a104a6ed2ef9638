#pragma once

#include <optional>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"

namespace insonate {

/// A probe's imaging plane at several poses. A 3D probe produces it by swinging its plane through the body, by a motor
/// or by steering; a hand produces it by moving a tracked 2D probe.
///
/// Planes are in the order of the sweep, at least two. A point lies between two neighbouring planes if they are on its
/// two sides. This requires that a sweep goes one way and that its planes do not cross in front of the face.
struct Sweep {
  Probe probe;                           ///< the probe of each plane
  double depth_mm = 160;                 ///< along each line, 0.1 to 1000
  std::vector<Pose> patient_from_plane;  ///< rigid; the imaging plane is the plane of x and y

  bool operator==(const Sweep&) const = default;
};

/// Returns the planes of a 3D probe. They are tilted about an axis along x that lies `pivot_mm` behind the face's
/// middle, at equal angles from -sweep_deg/2 (first plane) to sweep_deg/2 (last plane, towards +z).
/// @param planes     2 to 4096
/// @param sweep_deg  above 0, up to 150
/// @param pivot_mm   0 or more: the radius on which the face swings
std::vector<Pose> swept_planes(const Pose& patient_from_probe, int planes, double sweep_deg, double pivot_mm);

/// Returns the index of the first plane that moves against the direction of the planes before it; nothing for a sweep
/// that goes one way. A plane's motion is that of its middle, at half the depth from the face. Steps below 0.05 mm do
/// not count, because the hand may rest.
std::optional<std::size_t> reversal_index(const Sweep& sweep);

/// Returns all lines of a sweep, patient mm, plane by plane: line i of plane p is at p * probe.lines + i.
/// @param samples  per line, 1 to 8192
ScanLines scan_lines(const Sweep& sweep, int samples);

/// The position of a patient point in a sweep: between two neighbouring planes, and, projected onto each, among its
/// lines.
struct SweepPosition {
  int plane;             ///< the plane before the point: 0 to planes - 2
  double share;          ///< distance to `plane` over the sum of the distances to both planes: 0 to 1
  LinePosition in_this;  ///< position among the lines of `plane`
  LinePosition in_next;  ///< position among the lines of the next plane
};

/// Returns the position of a point; nothing before the first plane, behind the last, and outside the fan of either
/// neighbour.
std::optional<SweepPosition> sweep_position(const Sweep& sweep, const glm::dvec3& patient_mm);

/// Returns a grid of cubic voxels around all lines of a sweep. Its axes are those of the sweep's middle plane: i
/// lateral, j into the depth, k along the elevation.
/// @param voxel_mm  above 0
Grid sweep_grid(const Sweep& sweep, double voxel_mm);

/// Holds one value per sample of a sweep.
struct SweepValues {
  int samples = 0;             ///< samples per line; sample k is at (k + 1/2) depth / samples from the face
  int lines = 0;               ///< lines per plane
  std::vector<double> values;  ///< samples fastest, then lines, then planes
};

}  // namespace insonate
