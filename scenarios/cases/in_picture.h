#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/probe/probe.h"
#include "sim/volume/case.h"

namespace insonate {

/// The structures and landmarks of a case in a picture.
struct InPicture {
  std::vector<std::string> structures;  ///< names of labels, by falling area in the fan
  std::vector<std::string> landmarks;   ///< names of those in the picture by ViewMeter's rule; in the case's order
};

/// Returns the content of a probe's picture at a pose. Structures are sampled every kLookedAt_mm, so that a smaller one
/// in the plane may be missed. It does not check whether sound reaches them.
/// @param depth_mm  of the picture from the face
InPicture in_picture(const Case& subject, const Probe& probe, double depth_mm, const Pose& patient_from_probe);
inline constexpr double kLookedAt_mm = 1;

/// Returns why a landmark is not in that picture, as the end of a sentence about it. Returns an empty text if it is in
/// the picture.
std::string why_not_in_picture(const Landmark& landmark, const Probe& probe, double depth_mm,
                               const Pose& patient_from_probe);

}  // namespace insonate
