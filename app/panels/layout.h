#pragma once

#include <map>
#include <optional>

#include "app/panels/widgets/widgets.h"
#include "app/trainer/look.h"

namespace insonate::ui {

/// The pictures that a layout places.
enum class View {
  ultrasound,
  recorded,  ///< the image of a recording, beside the ultrasound and of its size
  space,     ///< the patient in 3D
  slice,     ///< the CT in the ultrasound's plane
  blend,     ///< the CT and the ultrasound
  axial,
  coronal,
  sagittal
};

/// Returns the view's name, as Screen::places() and state files have it: "axial".
const char* name_of(View view);

struct Layout {
  LayoutName name = LayoutName::standard;
  std::optional<View> large;  ///< fills the area alone, if it may be seen
};

/// What a layout has to respect.
struct LayoutRules {
  bool anatomy = true;    ///< without it the ultrasound and the 3D view alone may be seen
  bool recorded = false;  ///< a recording's image is there to be shown
  bool charts = false;    ///< charts below take height, so that the ultrasound needs less width
  bool joined = false;    ///< slice and blend lie side by side, so that one panel can take the place of both
};

/// Returns where each view lies. A view that is not in the result is hidden.
/// @param gap  between two views, pixels
std::map<View, Rect> lay_out(const Layout& layout, const Rect& area, float gap, const LayoutRules& rules);

}  // namespace insonate::ui
