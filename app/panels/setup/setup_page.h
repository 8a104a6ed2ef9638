#pragma once

#include <glm/vec3.hpp>

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "app/trainer/setup_wizard.h"

namespace insonate::ui {

/// Draws the set-up's page over the whole screen: its steps, what to do now, the outcome, and buttons. A click on a
/// step goes to it. Returns true if the page should be closed.
/// @param next_start  how to start with the calibration (Trainer::next_start); shown once the probe can be used
/// @param belly  where a probe stands on the patient, mm
/// @param places  receives the positions of the buttons, by name, for programs that drive the window
bool draw_setup_page(const Theme& theme, const Rect& screen, SetupWizard& wizard, const std::string& next_start,
                     const glm::dvec3& belly, Pictures& pictures, std::map<std::string, Rect>& places);

}  // namespace insonate::ui
