#pragma once

#include <vector>

#include "sim/model/tissue.h"
#include "sim/model/transmission.h"
#include "sim/probe/probe.h"
#include "sim/volume/case.h"

namespace insonate {

/// What a probe at a depth shows from a place, without a reference view to compare with: whether a point of the patient
/// lies in the slice and the sound reaches it, the one-way transmission being above -20 dB of what soft tissue alone
/// would let through on that way. On the CPU, in double precision, kLines lines; lines are traversed when first asked.
class Visibility {
public:
  static constexpr int kLines = 48;
  static constexpr double kHalfSlice_mm = 2.5;  ///< how far off the plane still counts as in the picture
  static constexpr double kArrives = 0.01;      ///< -20 dB of intensity

  Visibility(const Case& subject, const Probe& probe, double depth_mm, const TissueTable& tissues);

  void look_from(const Pose& patient_from_probe);
  bool reaches(const glm::dvec3& patient_mm);

  const Probe& probe() const { return probe_; }
  double depth_mm() const { return depth_mm_; }

private:
  struct Line {
    bool traversed = false;
    std::vector<double> intensity;
  };

  const Case* case_;
  Probe probe_;
  double depth_mm_;
  ScanLines lines_;
  Transmission transmission_;
  std::vector<double> soft_tissue_;  ///< its one-way intensity at the middle of each sample
  Pose patient_from_probe_, probe_from_patient_;
  std::vector<Line> looked_;
};

}  // namespace insonate
