#pragma once

#include <vector>

#include "sim/probe/probe.h"
#include "sim/tissue/tissue.h"
#include "sim/tissue/transmission.h"
#include "sim/volume/case.h"

namespace insonate {

/// Determines which points of a patient a probe shows, without a reference view. A point is shown if it lies in the
/// slice and the sound reaches it. The sound reaches a point if its one-way transmission is above -20 dB of that
/// through soft tissue alone on the same path. Runs on the CPU in double precision with kLines lines. A line is
/// traversed only when a point on it is queried.
class Visibility {
public:
  static constexpr int kLines = 48;
  static constexpr double kHalfSlice_mm = 2.5;  ///< maximum distance from the plane that counts as in the picture
  static constexpr double kArrives = kArrivingShare;

  /// Keeps a reference to the case. `depth_mm` is the depth of the picture from the face.
  Visibility(const Case& subject, const Probe& probe, double depth_mm, const TissueTable& tissues);

  /// Sets the pose of the probe for the following queries.
  void look_from(const Pose& patient_from_probe);
  /// Returns true if the point lies within kHalfSlice_mm of the plane and in the fan, and the sound reaches it.
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
  std::vector<double> soft_tissue_;  ///< one-way intensity of soft tissue at the middle of each sample
  Pose patient_from_probe_, probe_from_patient_;
  std::vector<Line> looked_;
};

}  // namespace insonate
