#pragma once

#include "app/panels/theme.h"
#include "app/panels/widgets.h"
#include "app/pictures.h"

namespace insonate::ui {

/// The live ultrasound with what a machine writes around it. The marker's side is on the left, as abdominal imaging
/// has it. Dragging on it slides the probe, with shift it tilts and rocks, the wheel turns it.
class UltrasoundPanel {
public:
  /// Where the picture itself goes in the panel, margins for scales left free: its size decides what is computed.
  static Rect picture_area(const Theme& theme, const Rect& panel);

  static void draw(const Theme& theme, const Rect& panel, Session& session, const Pictures& pictures);
};

}  // namespace insonate::ui
