#pragma once

#include <vector>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "sim/volume/case.h"

namespace insonate::ui {

/// Draws the edge of the ultrasound's fan over the 3D view, as sharp as the screen. Needs Pictures::volume().
void draw_fan_edge(const Theme& theme, const Rect& space, const Pictures& pictures);

/// Draws a dot at each landmark over the 3D view, and its name beside it where that covers no other one. Needs
/// Pictures::volume().
void draw_landmarks(const Theme& theme, const Rect& space, const std::vector<Landmark>& landmarks,
                    const Pictures& pictures);

}  // namespace insonate::ui
