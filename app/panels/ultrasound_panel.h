#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "app/replay/shown_annotations.h"
#include "app/session/picture_tools.h"
#include "app/session/plane_on_screen.h"

namespace insonate::ui {

/// The live ultrasound with what a machine writes around it. The marker's side is on the left, as abdominal imaging
/// has it. Dragging on it slides the probe, with shift it tilts and rocks, the wheel turns it; a frozen picture is
/// measured in.
class UltrasoundPanel {
public:
  /// Where the picture itself goes in the panel, margins for scales left free: its size decides what is computed.
  static Rect picture_area(const Theme& theme, const Rect& panel);

  /// The picture's plane on the screen.
  static PlaneOnScreen plane(const Theme& theme, const Rect& panel, const Pictures& pictures);

  /// Adds to `places` where its buttons are.
  static void draw(const Theme& theme, const Rect& panel, Session& session, const Pictures& pictures,
                   PictureTools& tools, std::map<std::string, Rect>& places);
  /// The same of a run that is over: nothing on it can be taken hold of.
  static void draw_still(const Theme& theme, const Rect& panel, const std::string& patient, const Machine& machine,
                         const ShownAnnotations& annotations, std::optional<double> lost_for_s,
                         const Pictures& pictures);
};

}  // namespace insonate::ui
