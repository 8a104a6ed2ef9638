#pragma once

#include <map>
#include <string>

#include "app/panels/replay/recorded_panel.h"
#include "app/panels/views_panel.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

/// Where the parts of a replay lie on the screen.
struct ReplayPlaces {
  Rect top, ultrasound, recorded, space, timeline;  ///< `recorded` is empty without images
};

/// Draws the screen of a replay: the step and its outcome, the picture with the settings of the moment, the recording's
/// own image beside it, the patient with the probe's path so far and the expert's path, and the time line. The
/// caller draws the CT's pictures, as in a session.
void draw_replay_page(const Theme& theme, const ReplayPlaces& places, Trainer& trainer, SpacePanel& space,
                      RecordedPanel& recorded, std::map<std::string, Rect>& names);

}  // namespace insonate::ui
