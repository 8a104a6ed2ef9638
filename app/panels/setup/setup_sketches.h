#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "app/trainer/setup_wizard.h"

namespace insonate::ui {

/// Draws what the set-up asks for now: how to hold the probe and where to touch. Landmarks are shown on the patient's
/// own body.
void draw_setup_sketch(const Theme& theme, const Rect& area, const SetupWizard& wizard, Pictures& pictures);

}  // namespace insonate::ui
