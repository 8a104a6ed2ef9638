#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/guide.h"
#include "sim/view/orbit_camera.h"

namespace insonate::ui {

/// Draw the help for practice: the reference view's plane as a ghost in the 3D view, and the next movements beside the
/// ultrasound.
void draw_ghost(const Theme& theme, const Rect& space, const Guiding& guiding, const view::OrbitCamera& camera);
/// Returns the rectangle that the advice covers.
Rect draw_advice(const Theme& theme, const Rect& ultrasound, const Guiding& guiding);

}  // namespace insonate::ui
