#pragma once

#include <span>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"
#include "sim/tissue/coupling.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// A scan line in the voxel indices of a grid. The map from the patient is affine, so sample positions are evenly
/// spaced too.
struct VoxelLine {
  glm::dvec3 start{0.0};     ///< continuous index where the line's first sample begins
  glm::dvec3 per_step{0.0};  ///< step from sample to sample; sample k begins at start + k per_step

  glm::dvec3 at(double step) const { return start + step * per_step; }
};

/// Returns line number `line` of `set` in the indices of `grid`.
VoxelLine voxel_line(const Grid& grid, const ScanLines& set, std::size_t line, const Pose& patient_from_probe);

/// The share of soft_tissue_intensity() above which the sound counts as arriving: -20 dB of intensity.
inline constexpr double kArrivingShare = 0.01;

/// Returns the one-way intensity, relative to the emitted one, that soft tissue alone would let through to the middle
/// of each sample of a line.
std::vector<double> soft_tissue_intensity(const ScanLines& lines, const TissueTable& tissues, double frequency_mhz);

/// How air in front of the skin counts as coupling gel.
struct GelLayer {
  double thickness_mm = kUsualGel_mm;
  /// False: voxels below half the density between air and fat count as gel completely, denser ones not at all. Scores
  /// count so. True: the skin's outermost voxels count as gel in part, as in pictures (sim/tissue/coupling.h).
  bool gradual = false;
};

/// Computes the sound that arrives along scan lines: model S's transmission (Kutter, Shams, Navab 2009, equations 1 and
/// 5), with the reflection length equal to the sample distance, on the CPU in double precision.
class Transmission {
public:
  /// @param ct  must outlive this object
  Transmission(const Volume<std::int16_t>& ct, const TissueTable& tissues, double sample_distance_mm,
               double frequency_mhz, const GelLayer& gel = {});

  /// Writes to `intensity` the one-way intensity, relative to the emitted one, at the middle of each sample of a line
  /// through the CT: as many samples as it holds, the nearest first.
  void along(const VoxelLine& line, std::span<double> intensity) const;

private:
  struct Medium {
    double impedance_mrayl;
    double half_step;  ///< share that absorption passes over half a sample distance
  };
  const Medium& medium(const glm::dvec3& index, double distance_mm) const;

  const Volume<std::int16_t>* ct_;
  double dr_mm_;
  GelLayer gel_;
  std::vector<Medium> medium_of_hu_;  ///< from kMin_hu up, one per Hounsfield unit
};

}  // namespace insonate
