#pragma once

#include <glm/vec3.hpp>

#include <complex>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/acoustics/response_table.h"
#include "sim/acoustics/scan_beam.h"
#include "sim/acoustics/transducer.h"
#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"

namespace insonate {

/// What a scattering volume is computed for (Kutter, Shams, Navab 2009): one patient, seen from one viewpoint.
///
/// Point scatterers fill the patient, one at a random place in each cubic cell of `cell_mm`, of amplitude 1 or -1 times
/// that of the tissue. Their echoes add up as the transducer's response says, along the scan lines of the viewpoint:
///
///     S(x) = |sum_s a_s e^(-2 i k r_s) h(r(x); across(x, s), z_s - z(x), r(x) - r_s)|,  k = 2 pi / wavelength
///
/// with r the distance from the face along a line, `across` the distance between the lines of x and s at the depth of
/// x, and h the ResponseTable of the transducer's central line, which serves for all lines.
struct SpecklePlan {
  Transducer transducer;
  Beamforming beamforming;
  Probe probe;               ///< linear or curvilinear, whose scan lines pass through the volume
  Pose patient_from_probe;   ///< the viewpoint
  double depth_mm = 160;     ///< 10 to 400
  double thickness_mm = 20;  ///< of the volume in elevation, 1 to 200
  double voxel_mm = 0.25;    ///< along the central line; twice as much across, three times in elevation; 0.05 to 2
  double cell_mm = 0.5;      ///< 0.05 to 5
  std::uint32_t seed = 1;
};

/// Returns a plan for a probe of the trainer and the transducer that stands for it, focused as the trainer's settings
/// are: at half the depth, f-number 3.5, with Hann's window over both apertures, so that side lobes end. Cells are such
/// that ten lie in the smallest resolution cell.
SpecklePlan speckle_plan(const Probe& probe, const Transducer& transducer, const Pose& patient_from_probe,
                         double depth_mm);

/// The amplitude of the tissue's scatterers at a place, 1 in liver.
using AmplitudeAt = std::function<double(const glm::dvec3& patient_mm)>;

/// Returns the volume's grid: its axes are the probe's, and it encloses the fan.
Grid speckle_grid(const SpecklePlan& plan);

/// A volume is computed in strips of this many voxels along the depth, which do not depend on each other.
inline constexpr int kStripVoxels = 16;
int strip_count(const Grid& grid);

/// Returns the voxels of a strip, i fastest, then j within the strip, then k; 0 outside the fan. Takes less than 2 MiB
/// besides the strip itself, however large the volume is and however many scatterers there are.
std::vector<float> speckle_strip(const SpecklePlan& plan, const Grid& grid, const ResponseTable& table,
                                 const AmplitudeAt& amplitude, int strip);

/// A scatterer in the probe's frame.
struct PlacedScatterer {
  glm::dvec3 place_mm{0.0};
  double amplitude = 0;
};
/// Calls `take` for each scatterer in a box of the probe's frame, in the order of their cells.
void for_each_scatterer(const SpecklePlan& plan, const glm::dvec3& low_mm, const glm::dvec3& high_mm,
                        const AmplitudeAt& amplitude, const std::function<void(const PlacedScatterer&)>& take);

}  // namespace insonate
