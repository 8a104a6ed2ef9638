#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/replay/shown_annotations.h"
#include "app/session/picture_tools.h"
#include "app/session/plane_on_screen.h"

namespace insonate::ui {

/// Draws the annotations of the ultrasound picture as ultrasound machines draw them: small crosses, a dotted line
/// between them, and a box of values in the corner. Returns how far down the box leaves the panel's side free.
float draw_annotations(const Theme& theme, const Rect& panel, const PlaneOnScreen& plane,
                       const ShownAnnotations& annotations);

/// Draws the buttons beside the frozen picture: measuring tools, undo, clear. Adds their positions to `places`.
void draw_picture_tools(const Theme& theme, const Rect& panel, Session& session, PictureTools& tools,
                        std::map<std::string, Rect>& places);

/// Passes the pointer to the tools. To be called right after ImGui's item that covers the picture.
void take_pointer(const Theme& theme, const PlaneOnScreen& plane, Session& session, PictureTools& tools);

/// Returns the next thing to do in the frozen picture, in a few words.
std::string tool_prompt(const PictureTools& tools);

}  // namespace insonate::ui
