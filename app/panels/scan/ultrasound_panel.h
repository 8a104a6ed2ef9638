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

/// Draws the live ultrasound with the texts and scales that a machine shows around it. The marker's side is on the
/// left, the convention of abdominal imaging. Dragging slides the probe, dragging with Shift tilts and rocks it, and
/// the wheel rotates it. In a frozen picture the pointer measures.
class UltrasoundPanel {
public:
  /// Returns the area of the picture in the panel, without the margins for scales. Its size decides how many pixels are
  /// computed.
  static Rect picture_area(const Theme& theme, const Rect& panel);

  /// Returns the mapping between the picture's plane and the screen.
  static PlaneOnScreen plane(const Theme& theme, const Rect& panel, const Pictures& pictures);

  /// Draws the panel and adds the positions of its buttons to `places`. Returns whether it was double-clicked; in a
  /// picture that can be measured in, clicks measure.
  /// @param is_saved  whether this frame becomes a file, without the buttons and prompts of a frozen picture
  static bool draw(const Theme& theme, const Rect& panel, Session& session, const Pictures& pictures,
                   PictureTools& tools, std::map<std::string, Rect>& places, bool is_saved);
  /// Draws the same for a finished run, without interaction. Returns whether it was double-clicked.
  static bool draw_still(const Theme& theme, const Rect& panel, const std::string& patient, const Machine& machine,
                         const ShownAnnotations& annotations, std::optional<double> lost_for_s,
                         const Pictures& pictures);
};

}  // namespace insonate::ui
