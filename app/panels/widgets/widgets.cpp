#include "app/panels/widgets/widgets.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr float kPi = 3.14159265f;

ImVec2 size_of(ImFont* font, std::string_view text) {
  return font->CalcTextSizeA(font->FontSize, 3e38f, 0, text.data(), text.data() + text.size());
}

// Returns the longest beginning that fits with an ellipsis after it, cut between UTF-8 characters.
std::string shortened(ImFont* font, std::string_view text, float width) {
  static constexpr char kEllipsis[] = "\u2026";
  std::size_t length = text.size();
  while (length > 0) {
    --length;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0u) == 0x80u) --length;
    std::string candidate = std::string(text.substr(0, length)) + kEllipsis;
    if (size_of(font, candidate).x <= width) return candidate;
  }
  return kEllipsis;
}

/// Returns the text with line ends that keep it within a width: at blanks and after slashes alone, so that numbers and
/// names of files stay whole. What has neither and is wider is cut anywhere.
std::string wrapped(ImFont* font, std::string_view words, float width) {
  const std::string text = unbroken(words);
  std::string lines;
  float used = 0;  // of the last line
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin;
    while (end < text.size() && text[end] == ' ') ++end;
    while (end < text.size() && text[end] != ' ' && text[end] != '\n' && text[end] != '/') ++end;
    if (end < text.size() && text[end] == '/') ++end;
    const std::string_view piece(text.data() + begin, end - begin);
    const float wide = size_of(font, piece).x;
    if (used + wide <= width) {
      lines += piece;
      used += wide;
    } else {
      if (used > 0) lines += '\n';
      used = 0;
      for (std::size_t i = std::min(piece.find_first_not_of(' '), piece.size()); i < piece.size();) {
        std::size_t next = i + 1;
        while (next < piece.size() && (static_cast<unsigned char>(piece[next]) & 0xc0u) == 0x80u) ++next;
        const std::string_view letter = piece.substr(i, next - i);
        const float step = size_of(font, letter).x;
        if (used > 0 && used + step > width) {
          lines += '\n';
          used = 0;
        }
        lines += letter;
        used += step;
        i = next;
      }
    }
    if (end < text.size() && text[end] == '\n') {
      lines += '\n';
      used = 0;
      ++end;
    }
    begin = end;
  }
  return lines;
}

/// Of a slider: the height of a line of text, and the least gap between name and value.
constexpr float kSliderLine = 20, kSliderGap = 8;

struct Scale {
  double least, most, step, normal;
};

/// Lets the mouse change a slider's value: dragging sets `at_mouse`, the wheel moves one step, a double click sets the
/// normal value. Returns whether the pointer is on it.
bool handle(const char* id, const Rect& where, const Scale& scale, double at_mouse, double& value) {
  ImGui::SetCursorScreenPos(where.min());
  ImGui::InvisibleButton(id, {where.w, where.h});
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  const float wheel = hovered ? ImGui::GetIO().MouseWheel : 0;
  const auto set = [&](double to) {
    value = std::clamp(std::round(to / scale.step) * scale.step, scale.least, scale.most);
  };
  if (active) set(at_mouse);
  if (wheel != 0) set(value + scale.step * wheel);
  if (hovered && ImGui::IsMouseDoubleClicked(0)) value = scale.normal;
  return active || hovered;
}

void draw_knob(const Theme& theme, const ImVec2& centre, float radius, bool lit) {
  ImGui::GetWindowDrawList()->AddCircleFilled(centre, theme.px(radius), lit ? colour::kText : colour::kAccent, 24);
}

bool tips_are_hidden = false;
std::vector<std::string> cut_texts;

/// Draws a text in a box above `of`, or below where there is no room.
void draw_box(const Theme& theme, const Rect& of, std::string_view words) {
  if (words.empty() || tips_are_hidden) return;
  const std::string text = wrapped(theme.text, words, theme.px(340));
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 size = size_of(theme.text, text);
  Rect box{io.MousePos.x, 0, size.x + theme.px(24), size.y + theme.px(16)};
  const float edge = theme.px(8);
  box.x = std::clamp(box.x, edge, std::max(edge, io.DisplaySize.x - box.w - edge));
  box.y = of.y - box.h - theme.px(6);
  if (box.y < 0) box.y = of.y + of.h + theme.px(6);
  ImDrawList* list = ImGui::GetForegroundDrawList();
  list->AddRectFilled(box.min(), box.max(), colour::kHovered, theme.px(4));
  list->AddText(theme.text, theme.text->FontSize, box.inset(theme.px(12), theme.px(8)).min(), colour::kText,
                text.data(), text.data() + text.size());
}

/// Returns for how long the pointer has not moved, by the frames that asked.
float pointer_rests_s() {
  static double moved_s = 0;
  const ImVec2& way = ImGui::GetIO().MouseDelta;
  if (way.x != 0 || way.y != 0) moved_s = ImGui::GetTime();
  return float(ImGui::GetTime() - moved_s);
}

}  // namespace

void hide_tips(bool hidden) {
  tips_are_hidden = hidden;
}

Rect Rect::take_left(float width) {
  const Rect part{x, y, width, h};
  x += width;
  w -= width;
  return part;
}

Rect Rect::take_right(float width) {
  w -= width;
  return {x + w, y, width, h};
}

Rect Rect::take_top(float height) {
  const Rect part{x, y, w, height};
  y += height;
  h -= height;
  return part;
}

Rect Rect::take_bottom(float height) {
  h -= height;
  return {x, y + h, w, height};
}

float text_width(ImFont* font, std::string_view text) {
  return size_of(font, text).x;
}

std::vector<std::string> take_cut_texts() {
  return std::exchange(cut_texts, {});
}

void draw_text(const Rect& where, ImFont* font, ImU32 colour, std::string_view text, Align align) {
  ImVec2 size = size_of(font, text);
  std::string cut;
  if (size.x > where.w + 0.5f) {
    cut_texts.emplace_back(text);
    cut = shortened(font, text, where.w);
    text = cut;
    size = size_of(font, text);
  }
  const float free = where.w - size.x;
  const float x = where.x + (align == Align::left ? 0 : align == Align::right ? free : free / 2);
  const ImVec2 at(std::round(x), std::round(where.y + (where.h - size.y) / 2));
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize, at, colour, text.data(), text.data() + text.size());
}

float paragraph_height(ImFont* font, std::string_view text, float width) {
  return size_of(font, wrapped(font, text, width)).y;
}

float draw_paragraph(const Rect& where, ImFont* font, ImU32 colour, std::string_view words) {
  const std::string text = wrapped(font, words, where.w);
  const ImVec4 clip(where.x, where.y, where.x + where.w + 1, where.y + where.h);
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize, where.min(), colour, text.data(), text.data() + text.size(),
                                      0, &clip);
  const float height = size_of(font, text).y;
  if (height > where.h + 1) cut_texts.emplace_back(words);
  return height;
}

void fill(const Rect& where, ImU32 colour, float rounding) {
  ImGui::GetWindowDrawList()->AddRectFilled(where.min(), where.max(), colour, rounding);
}

void outline(const Rect& where, ImU32 colour, float rounding, float thickness) {
  ImGui::GetWindowDrawList()->AddRect(where.min(), where.max(), colour, rounding, 0, thickness);
}

float draw_chip(const Theme& theme, const ImVec2& at, ImU32 background, ImU32 colour, std::string_view text) {
  const Rect plate{at.x, at.y, text_width(theme.strong, text) + theme.px(24), theme.px(30)};
  fill(plate, background, theme.px(4));
  draw_text(plate, theme.strong, colour, text, Align::centre);
  return plate.w;
}

bool button(const Theme& theme, const char* id, const Rect& where, std::string_view text, ButtonKind kind, bool enabled,
            std::string_view tip) {
  ImGui::SetCursorScreenPos(where.min());
  const bool clicked = ImGui::InvisibleButton(id, {where.w, where.h}) && enabled;
  const bool hovered = ImGui::IsItemHovered() && enabled;
  ImU32 background = hovered ? colour::kHovered : colour::kRaised, ink = colour::kText;
  if (kind == ButtonKind::chosen) background = colour::kAccentDark;
  if (kind == ButtonKind::primary && enabled) {
    background = colour::kAccent;
    ink = colour::kBackground;
  }
  if (kind == ButtonKind::warning) {
    background = colour::kAmber;
    ink = colour::kBackground;
  }
  if (kind == ButtonKind::recording) {
    background = colour::kRed;
    ink = colour::kBackground;
  }
  if (!enabled && kind != ButtonKind::chosen) {
    background = colour::kRaised;
    ink = colour::kFaint;
  }
  fill(where, background, theme.px(4));
  if (hovered) outline(where, colour::kFaint, theme.px(4));
  draw_tip(theme, where, tip);
  draw_text(where.inset(std::min(theme.px(6), where.w / 8), 0), theme.text, ink, text, Align::centre);
  return clicked;
}

bool fits_one_line(const Theme& theme, float width, std::string_view name, std::string_view value_text) {
  return text_width(theme.small_text, name) + theme.px(kSliderGap) + text_width(theme.strong, value_text) <= width;
}

float slider_height(const Theme& theme, bool value_below) {
  return theme.px(kSliderLine * (value_below ? 2 : 1) + 26);
}

bool slider(const Theme& theme, const char* id, const Rect& where, std::string_view name, std::string_view value_text,
            double& value, double least, double most, double step, double normal, bool enabled, std::string_view tip) {
  constexpr float kRadius = 7;
  const double before = value;
  const float left = where.x + theme.px(kRadius), right = where.x + where.w - theme.px(kRadius);
  const double at_mouse = least + (most - least) * (ImGui::GetIO().MousePos.x - left) / (right - left);
  const bool lit = enabled && handle(id, where, {least, most, step, normal}, at_mouse, value);
  if (enabled && !ImGui::IsItemActive()) draw_tip(theme, where, tip);

  const bool below = where.h >= slider_height(theme, true) - 1;
  Rect line = where;
  line.h = theme.px(kSliderLine);
  const float value_width = below ? 0 : text_width(theme.strong, value_text) + theme.px(kSliderGap);
  draw_text({line.x, line.y, line.w - value_width, line.h}, theme.small_text, colour::kMuted, name);
  if (below) line.y += line.h;
  draw_text(line, theme.strong, enabled ? colour::kText : colour::kMuted, value_text, Align::right);

  const float y = std::round(line.y + line.h + theme.px(11));
  const float x = left + float((value - least) / (most - least)) * (right - left);
  const float half = theme.px(2);
  fill({where.x, y - half, where.w, 2 * half}, colour::kRaised, half);
  fill({where.x, y - half, x - where.x, 2 * half}, enabled ? colour::kAccent : colour::kHovered, half);
  if (enabled) draw_knob(theme, {x, y}, kRadius, lit);
  return value != before;
}

bool upright_slider(const Theme& theme, const char* id, const Rect& where, double& value, double limit, bool enabled,
                    std::string_view tip) {
  constexpr float kRadius = 5;
  const double before = value;
  const float top = where.y + theme.px(kRadius), bottom = where.y + where.h - theme.px(kRadius);
  const double at_mouse = limit * (1 - 2.0 * (ImGui::GetIO().MousePos.y - top) / (bottom - top));
  const bool lit = enabled && handle(id, where, {-limit, limit, 1, 0}, at_mouse, value);
  if (enabled && !ImGui::IsItemActive()) draw_tip(theme, where, tip);

  const float x = std::round(where.x + where.w / 2), half = theme.px(1.5f);
  const float middle = (top + bottom) / 2, y = middle - float(value / limit) * (bottom - top) / 2;
  fill({x - half, where.y, 2 * half, where.h}, colour::kRaised, half);
  fill({x - half, std::min(y, middle), 2 * half, std::abs(y - middle)}, colour::kAccent);
  if (enabled) draw_knob(theme, {x, y}, kRadius, lit);
  return value != before;
}

void draw_tip(const Theme& theme, const Rect& of, std::string_view text) {
  constexpr float kRest_s = 0.5f, kRead_s = 8;  // longer, it would cover what is beside it for no reason
  constexpr float kSame_s = 0.1f;               // two moments of one movement
  const float hovered_s = ImGui::GetCurrentContext()->HoveredIdTimer;
  // A control that a page brings under a pointer at rest was not asked about.
  const bool is_entered = pointer_rests_s() < hovered_s + kSame_s;
  if (ImGui::IsItemHovered() && is_entered && hovered_s > kRest_s && hovered_s < kRead_s) draw_box(theme, of, text);
}

void draw_tooltip(const Theme& theme, const Rect& of, std::string_view text) {
  if (ImGui::IsWindowHovered(ImGuiHoveredFlags_RootAndChildWindows) && ImGui::IsMouseHoveringRect(of.min(), of.max()))
    draw_box(theme, of, text);
}

void draw_ring(const ImVec2& centre, float radius, float thickness, double share, ImU32 colour, ImU32 rest) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddCircle(centre, radius, rest, 64, thickness);
  if (share <= 0) return;
  list->PathArcTo(centre, radius, -kPi / 2, -kPi / 2 + float(std::min(share, 1.0)) * 2 * kPi, 64);
  list->PathStroke(colour, 0, thickness);
}

}  // namespace insonate::ui
