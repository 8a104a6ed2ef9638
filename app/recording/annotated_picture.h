#pragma once

#include <vector>

#include "scenarios/action.h"
#include "sim/core/image.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Draws what a learner has placed into a picture that is stored without the screen's layers: crosses at the ends of
/// calipers and at places, with dots between the ends and round ellipses.
/// @param picture   marker on the left
/// @param geometry  of the picture
/// @param placed    calipers, ellipses, points and labels
void draw_annotations(Image<Rgba8>& picture, const ImageGeometry& geometry, const std::vector<Action>& placed);

}  // namespace insonate
