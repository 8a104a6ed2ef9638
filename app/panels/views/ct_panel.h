#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "app/panels/layout.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "app/session/guide.h"

namespace insonate::ui {

/// Draws the CT's pictures: in the ultrasound's plane, blended with the ultrasound, and along the patient's axes.
/// Dragging in any of them changes the grey scale of all, as in radiology viewers: across the window, up and down the
/// level. The wheel goes through the slices along an axis. A button shows the grey scale, and opens a menu of usual
/// ones and of what is drawn over the CT.
class CtPanel {
public:
  /// Draws one picture. Returns whether it was double-clicked.
  /// @param view      slice, blend, axial, coronal or sagittal
  /// @param look      receives what the person changes
  /// @param guiding   the view whose plane is drawn in the slices along the axes; null for none
  /// @param places    receives the buttons' rectangles
  bool draw(const Theme& theme, View view, const Rect& panel, Pictures& pictures, CtLook& look, const Guiding* guiding,
            std::map<std::string, Rect>& places);

  /// Closes the menu. Returns whether one was shown.
  bool close_menu() { return std::exchange(menu_, std::nullopt) && shown_in_ >= ImGui::GetFrameCount() - 1; }

private:
  Rect draw_grey_button(const Theme& theme, View view, const Rect& picture, CtLook& look, bool has_labels,
                        std::map<std::string, Rect>& places);
  void draw_menu(const Theme& theme, const Rect& button, View view, CtLook& look, bool has_labels,
                 std::map<std::string, Rect>& places);

  std::optional<View> menu_;         ///< whose menu is open
  int shown_in_ = -1;                ///< the last of ImGui's frames with a menu; its view may be hidden since
  std::optional<WindowLevel> held_;  ///< the grey scale when the drag began
  float wheel_ = 0;                  ///< turned, less than a slice
};

}  // namespace insonate::ui
