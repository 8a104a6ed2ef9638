#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/replay/shown_annotations.h"
#include "app/session/picture_tools.h"
#include "app/session/plane_on_screen.h"

namespace insonate::ui {

/// What is placed in the ultrasound picture, as machines draw it: small crosses, a dotted line between them, and a box
/// of values in the corner.
void draw_annotations(const Theme& theme, const Rect& panel, const PlaneOnScreen& plane,
                      const ShownAnnotations& annotations);

/// The buttons beside the frozen picture: what to measure with, undo, clear. Adds to `places` where they are.
void draw_picture_tools(const Theme& theme, const Rect& panel, Session& session, PictureTools& tools,
                        std::map<std::string, Rect>& places);

/// Hands the pointer to the tools. To be called right after ImGui's item that covers the picture.
void take_pointer(const Theme& theme, const PlaneOnScreen& plane, Session& session, PictureTools& tools);

/// What to do next in the frozen picture, in a few words.
std::string tool_prompt(const PictureTools& tools);

}  // namespace insonate::ui
