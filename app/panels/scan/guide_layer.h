#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/guide.h"
#include "sim/view/body/orbit_camera.h"

namespace insonate::ui {

/// Draw the help for practice: the reference view's plane as a ghost in the 3D view, and the next movements in a strip
/// of their own, which covers nothing.
void draw_ghost(const Theme& theme, const Rect& space, const Guiding& guiding, const view::OrbitCamera& camera);
/// Returns how many of the movements the strip has room for.
/// @param counted  whether the report of a scored attempt will say that the guide was shown
std::size_t draw_guide_strip(const Theme& theme, const Rect& strip, const Guiding& guiding, bool counted);
float guide_strip_height(const Theme& theme);

}  // namespace insonate::ui
