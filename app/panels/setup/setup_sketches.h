#pragma once

#include <glm/vec3.hpp>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "app/trainer/setup_wizard.h"

namespace insonate::ui {

/// Draws what the set-up asks for now: how to hold the probe and where to touch, on the body of the patient.
/// @param belly  where a probe stands on it, patient mm
void draw_setup_sketch(const Theme& theme, const Rect& area, const SetupWizard& wizard, const glm::dvec3& belly,
                       Pictures& pictures);

}  // namespace insonate::ui
