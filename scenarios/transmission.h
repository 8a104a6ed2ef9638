#pragma once

#include <vector>

#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/model/tissue.h"
#include "sim/probe/probe.h"

namespace insonate {

/// How much sound arrives along scan lines: model S's transmission (Kutter, Shams, Navab 2009, equations 1 and 5) with
/// the reflection length equal to the sample distance, on the CPU in double precision.
class Transmission {
public:
  /// Air nearer to the face than this is filled with coupling gel, as in the trainer's picture.
  static constexpr double kGel_mm = 6;

  Transmission(const Volume<std::int16_t>& ct, const TissueTable& tissues, const ScanLines& lines,
               double frequency_mhz);

  /// One-way intensity relative to the emitted at the middle of each sample of one line, into `intensity`, which
  /// holds as many as the line has samples.
  void along(std::size_t line, const Pose& patient_from_probe, std::vector<double>& intensity) const;

private:
  struct Medium {
    double impedance_mrayl;
    double half_step;  ///< what absorption lets through over half a sample distance
  };
  const Medium& medium(const glm::dvec3& index, double distance_mm) const;

  const Volume<std::int16_t>* ct_;
  ScanLines lines_;
  std::vector<Medium> medium_of_hu_;  ///< from kLeastHu up, one a Hounsfield unit
};

}  // namespace insonate
