#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "app/panels/layout.h"
#include "app/panels/replay/recorded_panel.h"
#include "app/panels/views/views_panel.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

/// Where the parts of a replay lie on the screen. A view that is not shown has an empty rectangle.
struct ReplayPlaces {
  Rect top, ultrasound, recorded, space, timeline;
};

/// Draws the screen of a replay: the step and its outcome, the picture with the settings of the moment, the recording's
/// own image beside it, the patient with the probe's path so far and the expert's path, and the time line. The
/// caller draws the CT's pictures, as in a session. Returns the view that was double-clicked.
/// @param overlay  what else is drawn over the 3D view
std::optional<View> draw_replay_page(const Theme& theme, const ReplayPlaces& places, Trainer& trainer,
                                     SpacePanel& space, RecordedPanel& recorded, std::map<std::string, Rect>& names,
                                     const SpaceOverlay& overlay);

}  // namespace insonate::ui
