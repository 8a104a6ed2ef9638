#pragma once

#include <map>
#include <string>

#include "app/panels/replay/recorded_panel.h"
#include "app/panels/views_panel.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

/// Where a replay's parts go on the screen.
struct ReplayPlaces {
  Rect top, ultrasound, recorded, space, timeline;  ///< `recorded` is empty without images
};

/// The screen while a run is looked at again: the step and its outcome, the picture with the knobs as they were, the
/// recording's own image beside it, the patient with the probe's path so far and the expert's, and the time line. The
/// CT's pictures are those of a session.
void draw_replay_page(const Theme& theme, const ReplayPlaces& places, Trainer& trainer, SpacePanel& space,
                      RecordedPanel& recorded, std::map<std::string, Rect>& names);

}  // namespace insonate::ui
