#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/probe/probe.h"
#include "sim/volume/case.h"

namespace insonate {

/// What a picture shows of a case.
struct InPicture {
  std::vector<std::string> structures;  ///< names of labels, that with the largest area in the fan first
  std::vector<std::string> landmarks;   ///< names, as ViewMeter takes them for being in the picture; as in the case
};

/// Of the picture that a probe takes at a pose. Structures are looked for every kLookedAt_mm, so that one smaller than
/// that in the plane may be missed; whether anything reaches them is not asked.
/// @param depth_mm  of the picture, from the face
InPicture in_picture(const Case& subject, const Probe& probe, double depth_mm, const Pose& patient_from_probe);
inline constexpr double kLookedAt_mm = 1;

/// Why a landmark is not in that picture, as the end of a sentence about it; empty when it is.
std::string why_not_in_picture(const Landmark& landmark, const Probe& probe, double depth_mm,
                               const Pose& patient_from_probe);

}  // namespace insonate
