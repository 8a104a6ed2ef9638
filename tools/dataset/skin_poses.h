#pragma once

#include <optional>

#include "sim/core/grid.h"
#include "sim/core/pose.h"

namespace insonate {

/// Returns the pose of a probe whose face touches the skin of a body and whose beam runs along the skin's normal, with
/// the marker to the patient's right in front. The skin is looked for from outside towards the axis of the CT that runs
/// from feet to head. Returns nothing where there is no skin, or none that is smooth over 10 mm.
/// @param around_deg  where to look from: 0 in front, 90 on the patient's left, 180 behind
/// @param height_mm   patient z
std::optional<Pose> pose_on_skin(const Volume<std::int16_t>& ct, double around_deg, double height_mm);

}  // namespace insonate
