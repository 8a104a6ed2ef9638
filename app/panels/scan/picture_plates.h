#pragma once

#include <string_view>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"
#include "sim/gl/objects.h"
#include "sim/view/edge_letters.h"

namespace insonate::ui {

/// Returns why a probe that is moved does not follow; empty if nothing has stopped it.
const char* stop_words(Session::Stop stop);

// What lies over every picture of the patient.

/// Returns the picture as ImGui refers to it.
ImTextureID id_of(const gl::Texture& texture);

/// Draws a picture's name in its upper left corner. Returns the plate's rectangle.
Rect draw_title(const Theme& theme, const Rect& panel, std::string_view title);

/// Draws text on a plate that is as wide as the text, so that it can be read on any echo. Returns the plate's
/// rectangle.
/// @param where  the text's line
/// @param align  where the plate lies in the line
Rect draw_on_plate(const Theme& theme, const Rect& where, ImFont* font, ImU32 colour, std::string_view text,
                   Align align = Align::left);

/// Draws letters at the middles of the edges, beside the plates in the corners.
/// @param upper_left, lower_left  the plates in the corners; empty: none
void draw_edge_letters(const Theme& theme, const Rect& picture, const view::EdgeLetters& letters,
                       const Rect& upper_left, const Rect& lower_left);

}  // namespace insonate::ui
