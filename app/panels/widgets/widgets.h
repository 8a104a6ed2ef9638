#pragma once

#include <imgui.h>

#include <string>
#include <string_view>
#include <vector>

#include "app/panels/widgets/theme.h"

namespace insonate::ui {

/// A rectangle on the screen, pixels from the top left.
struct Rect {
  float x = 0, y = 0, w = 0, h = 0;

  ImVec2 min() const { return {x, y}; }
  ImVec2 max() const { return {x + w, y + h}; }
  ImVec2 centre() const { return {x + w / 2, y + h / 2}; }
  Rect inset(float dx, float dy) const { return {x + dx, y + dy, w - 2 * dx, h - 2 * dy}; }
  /// Cut a part off one side and return it; the rest remains.
  Rect take_left(float width);
  Rect take_right(float width);
  Rect take_top(float height);
  Rect take_bottom(float height);
};

enum class Align { left, centre, right };

/// Returns the width of one line of text, pixels.
float text_width(ImFont* font, std::string_view text);

/// Draws one line of text, centred in the rectangle's height. Text that does not fit ends in an ellipsis.
void draw_text(const Rect& where, ImFont* font, ImU32 colour, std::string_view text, Align align = Align::left);

/// Returns the texts that were drawn since the last call and did not fit, so that tests find what cannot be read.
std::vector<std::string> take_cut_texts();

/// Returns the height, pixels, of text that is wrapped to `width` pixels.
float paragraph_height(ImFont* font, std::string_view text, float width);

/// Wraps text to the rectangle's width and returns the height it takes. Does not draw below the rectangle's bottom.
float draw_paragraph(const Rect& where, ImFont* font, ImU32 colour, std::string_view text);

void fill(const Rect& where, ImU32 colour, float rounding = 0);
void outline(const Rect& where, ImU32 colour, float rounding = 0, float thickness = 1);

/// Draws a small plate with one line of text, its top left at `at`. Returns its width.
float draw_chip(const Theme& theme, const ImVec2& at, ImU32 background, ImU32 colour, std::string_view text);

enum class ButtonKind { normal, chosen, primary, warning, recording };

/// Draws a button. Returns true if it was clicked.
/// @param tip  what it does and with which key, shown when the pointer rests on it; empty: the text says it all
bool button(const Theme& theme, const char* id, const Rect& where, std::string_view text,
            ButtonKind kind = ButtonKind::normal, bool enabled = true, std::string_view tip = {});

/// Draws a slider with its name on the left and its value on the right above the track. The value stands below the name
/// if the rectangle is as high as slider_height() for that. A double click sets `normal`.
/// Returns true if the value changed; it is rounded to whole `step`s. A disabled slider shows its value and does not
/// change it.
/// @param tip  as for button()
bool slider(const Theme& theme, const char* id, const Rect& where, std::string_view name, std::string_view value_text,
            double& value, double least, double most, double step, double normal, bool enabled = true,
            std::string_view tip = {});

/// Returns whether name and value of a slider of that width fit into one line.
bool fits_one_line(const Theme& theme, float width, std::string_view name, std::string_view value_text);
/// Returns the height that a slider needs, with the value below the name or beside it.
float slider_height(const Theme& theme, bool value_below);

/// Draws a short upright slider for values from -limit to limit, such as one of the time gain compensation.
bool upright_slider(const Theme& theme, const char* id, const Rect& where, double& value, double limit,
                    bool enabled = true, std::string_view tip = {});

/// Explains ImGui's last item in a box beside the pointer, once the pointer has rested on it for a moment.
void draw_tip(const Theme& theme, const Rect& of, std::string_view text);

/// Leaves such boxes out of the frames to come, or draws them again.
void hide_tips(bool hidden);

/// Explains what lies in `of` in such a box as long as the pointer is there: what a person has to know at once, such as
/// why a button is dim. Draws nothing for an empty text.
void draw_tooltip(const Theme& theme, const Rect& of, std::string_view text);

/// Draws a ring that fills clockwise from the top.
void draw_ring(const ImVec2& centre, float radius, float thickness, double share, ImU32 colour, ImU32 rest);

}  // namespace insonate::ui
