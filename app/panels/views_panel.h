#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"

namespace insonate::ui {

/// The patient in space with the ultrasound's plane in it. Dragging beside the probe turns the patient, with the right
/// button it shifts it, the wheel comes nearer; dragging the probe puts it elsewhere on the skin.
class SpacePanel {
public:
  /// @param session  nullptr: there is no probe to be dragged
  void draw(const Theme& theme, const Rect& panel, Session* session, Pictures& pictures);

private:
  bool holds_probe_ = false;
};

/// The CT in the ultrasound's plane, and both on top of each other with a slider between them.
void draw_slice_panel(const Theme& theme, const Rect& panel, const Pictures& pictures);
void draw_blend_panel(const Theme& theme, const Rect& panel, Pictures& pictures);

}  // namespace insonate::ui
