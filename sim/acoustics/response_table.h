#pragma once

#include <complex>
#include <vector>

#include "sim/acoustics/scan_beam.h"
#include "sim/acoustics/transducer.h"

namespace insonate {

/// The response of a transducer's central scan line to a point, by depth, as the wave physics gives it (point_echo()):
/// the echo's complex envelope around the carrier. It is computed at depths kDepthStep_mm apart, and in between taken
/// from the nearest. At each depth it is interpolated linearly between samples, and ends kReach full widths to either
/// side of the line. It is scaled so that scatterers of amplitude 1, `density` of them per mm^3 at random places, have
/// an envelope of mean 1 at every depth.
class ResponseTable {
public:
  static constexpr double kDepthStep_mm = 1, kNearest_mm = 6, kReach = 2.2;

  /// Computes the table by all processors; some 20 depths in a second.
  /// @param depth_mm  the deepest, kNearest_mm or more
  /// @param density   scatterers per mm^3
  ResponseTable(const Transducer& transducer, const Beamforming& beamforming, double depth_mm, double density);

  /// Returns the index of the depth nearest to a distance from the face.
  std::size_t depth_index(double distance_mm) const;
  /// Returns how far to either side of a voxel a scatterer is heard: across, in elevation, and along, mm.
  double across_mm(std::size_t depth) const { return slices_[depth].across_step * (slices_[depth].across - 1); }
  double elevation_mm(std::size_t depth) const {
    return slices_[depth].elevation_step * (slices_[depth].elevation - 1);
  }
  double along_mm() const { return along_step_ * (along_ - 1) / 2.0; }
  double most_across_mm() const;
  double most_elevation_mm() const;

  /// Returns the complex envelope at a voxel, of a scatterer of phase 0.
  /// @param across_mm, elevation_mm  distance of the scatterer from the voxel's line, of any sign
  /// @param behind_mm                how much deeper the voxel lies than the scatterer
  std::complex<double> at(std::size_t depth, double across_mm, double elevation_mm, double behind_mm) const;

  /// Returns the phase that the carrier turns per mm of distance, there and back, rad.
  double phase_per_mm() const { return phase_per_mm_; }

private:
  struct Slice {
    int across = 0, elevation = 0;  // samples from the line on
    double across_step = 0, elevation_step = 0;
    std::vector<std::complex<float>> samples;  // along fastest, then elevation, then across
  };
  Slice slice(const Transducer& transducer, const Beamforming& beamforming, double distance_mm, double density) const;

  double along_step_ = 0, phase_per_mm_ = 0;
  int along_ = 0;
  std::vector<Slice> slices_;
};

}  // namespace insonate
