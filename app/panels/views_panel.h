#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"

namespace insonate::ui {

/// Draws the patient in space with the ultrasound's plane in it. Dragging beside the probe rotates the patient, with
/// the right button it shifts the patient, and the wheel zooms. Dragging the probe puts it elsewhere on the skin.
/// Buttons turn the patient to one of six sides, or back to the plane.
class SpacePanel {
public:
  /// @param session  nullptr if there is no probe to drag
  /// @param places   receives the buttons' rectangles
  void draw(const Theme& theme, const Rect& panel, Session* session, Pictures& pictures,
            std::map<std::string, Rect>& places);

private:
  bool holds_probe_ = false;
};

/// Draw the CT in the ultrasound's plane, and both superimposed with a slider between them.
void draw_slice_panel(const Theme& theme, const Rect& panel, const Pictures& pictures);
void draw_blend_panel(const Theme& theme, const Rect& panel, Pictures& pictures);

}  // namespace insonate::ui
