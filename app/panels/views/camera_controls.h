#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "sim/view/body/orbit_camera.h"

namespace insonate::ui {

/// Moves a camera by the mouse over ImGui's last item, as in 3D Slicer: a drag rotates; with the middle button, or with
/// Shift, it shifts; with the right button it zooms, upwards nearer, as the wheel does.
/// @param dragged  whether drags are the camera's; the wheel always is
void move_by_mouse(const Theme& theme, const Rect& panel, view::OrbitCamera& camera, bool dragged = true);

/// Shows in the lower right corner how the patient lies: the axes that point towards the viewer, with their letters.
void draw_orientation(const Theme& theme, const Rect& panel, const view::OrbitCamera& camera);

}  // namespace insonate::ui
