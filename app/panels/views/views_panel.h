#pragma once

#include <functional>
#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"

namespace insonate::ui {

/// What else is drawn over the picture of the 3D view: lines below its buttons, and further buttons.
struct SpaceOverlay {
  std::function<void()> lines = [] {};
  std::function<void()> buttons = [] {};
};

/// Draws the patient in space with the ultrasound's plane in it. The mouse works as in 3D Slicer: dragging beside the
/// probe rotates the patient; with the middle button, or with Shift, it shifts the patient; with the right button it
/// zooms, upwards nearer, as the wheel does. Dragging the probe puts it elsewhere on the skin.
/// Buttons turn the patient to one of six sides, or back to the plane.
class SpacePanel {
public:
  /// @param session  nullptr if there is no probe to drag
  /// Returns whether the panel was double-clicked.
  /// @param places  receives the buttons' rectangles
  bool draw(const Theme& theme, const Rect& panel, Session* session, Pictures& pictures,
            std::map<std::string, Rect>& places, const SpaceOverlay& overlay = {});

private:
  bool holds_probe_ = false;
  ImVec2 grip_;  ///< from the face's middle to where the pointer took the probe, pixels
};

}  // namespace insonate::ui
