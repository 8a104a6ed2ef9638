#include "app/panels/widgets.h"

#include <algorithm>
#include <cmath>

namespace insonate::ui {
namespace {

constexpr float kPi = 3.14159265f;

ImVec2 size_of(ImFont* font, std::string_view text, float wrap = 0) {
  return font->CalcTextSizeA(font->FontSize, 3e38f, wrap, text.data(), text.data() + text.size());
}

// The longest beginning that fits with an ellipsis behind it, cut between UTF-8 characters.
std::string shortened(ImFont* font, std::string_view text, float width) {
  static constexpr char kEllipsis[] = "\u2026";
  std::size_t length = text.size();
  while (length > 0) {
    --length;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0u) == 0x80u) --length;
    const std::string candidate = std::string(text.substr(0, length)) + kEllipsis;
    if (size_of(font, candidate).x <= width) return candidate;
  }
  return kEllipsis;
}

double rounded(double value, double step, double least, double most) {
  return std::clamp(std::round(value / step) * step, least, most);
}

}  // namespace

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

void draw_text(const Rect& where, ImFont* font, ImU32 colour, std::string_view text, Align align) {
  ImVec2 size = size_of(font, text);
  std::string cut;
  if (size.x > where.w + 0.5f) {
    cut = shortened(font, text, where.w);
    text = cut;
    size = size_of(font, text);
  }
  const float free = where.w - size.x;
  const float x = where.x + (align == Align::left ? 0 : align == Align::right ? free : free / 2);
  const ImVec2 at(std::round(x), std::round(where.y + (where.h - size.y) / 2));
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize, at, colour, text.data(), text.data() + text.size());
}

float draw_paragraph(const Rect& where, ImFont* font, ImU32 colour, std::string_view text) {
  const ImVec4 clip(where.x, where.y, where.x + where.w + 1, where.y + where.h);
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize, where.min(), colour, text.data(), text.data() + text.size(),
                                      where.w, &clip);
  return size_of(font, text, where.w).y;
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

bool button(const Theme& theme, const char* id, const Rect& where, std::string_view text, ButtonKind kind,
            bool enabled) {
  ImGui::SetCursorScreenPos(where.min());
  const bool clicked = ImGui::InvisibleButton(id, {where.w, where.h}) && enabled;
  const bool hovered = ImGui::IsItemHovered() && enabled;
  ImU32 background = hovered ? colour::kHovered : colour::kRaised, ink = colour::kText;
  if (kind == ButtonKind::chosen) background = colour::kAccentDark;
  if (kind == ButtonKind::primary) {
    background = colour::kAccent;
    ink = colour::kBackground;
  }
  if (kind == ButtonKind::warning) {
    background = colour::kAmber;
    ink = colour::kBackground;
  }
  if (!enabled) ink = colour::kFaint;
  fill(where, background, theme.px(4));
  if (hovered) outline(where, colour::kFaint, theme.px(4));
  draw_text(where.inset(theme.px(6), 0), theme.text, ink, text, Align::centre);
  return clicked;
}

bool slider(const Theme& theme, const char* id, const Rect& where, std::string_view name, std::string_view value_text,
            double& value, double least, double most, double step, double normal) {
  ImGui::SetCursorScreenPos(where.min());
  ImGui::InvisibleButton(id, {where.w, where.h});
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  const double before = value;
  const float radius = theme.px(7);
  const float left = where.x + radius, right = where.x + where.w - radius;
  const ImGuiIO& io = ImGui::GetIO();
  if (active) value = rounded(least + (most - least) * (io.MousePos.x - left) / (right - left), step, least, most);
  if (hovered && io.MouseWheel != 0) value = rounded(value + step * io.MouseWheel, step, least, most);
  if (hovered && ImGui::IsMouseDoubleClicked(0)) value = normal;

  Rect line = where;
  line.h = theme.px(20);
  const float value_width = text_width(theme.strong, value_text);
  draw_text({line.x, line.y, line.w - value_width - theme.px(8), line.h}, theme.small_text, colour::kMuted, name);
  draw_text(line, theme.strong, colour::kText, value_text, Align::right);

  const float y = std::round(where.y + line.h + theme.px(11));
  const float x = left + float((value - least) / (most - least)) * (right - left);
  const float half = theme.px(2);
  fill({where.x, y - half, where.w, 2 * half}, colour::kRaised, half);
  fill({where.x, y - half, x - where.x, 2 * half}, colour::kAccent, half);
  ImGui::GetWindowDrawList()->AddCircleFilled({x, y}, radius, hovered || active ? colour::kText : colour::kAccent, 24);
  return value != before;
}

bool upright_slider(const Theme& theme, const char* id, const Rect& where, double& value, double reach) {
  ImGui::SetCursorScreenPos(where.min());
  ImGui::InvisibleButton(id, {where.w, where.h});
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  const double before = value;
  const float radius = theme.px(5);
  const float top = where.y + radius, bottom = where.y + where.h - radius;
  const ImGuiIO& io = ImGui::GetIO();
  if (active) value = rounded(reach * (1 - 2.0 * (io.MousePos.y - top) / (bottom - top)), 1, -reach, reach);
  if (hovered && io.MouseWheel != 0) value = rounded(value + io.MouseWheel, 1, -reach, reach);
  if (hovered && ImGui::IsMouseDoubleClicked(0)) value = 0;

  const float x = std::round(where.x + where.w / 2), half = theme.px(1.5f);
  const float middle = (top + bottom) / 2, y = middle - float(value / reach) * (bottom - top) / 2;
  fill({x - half, where.y, 2 * half, where.h}, colour::kRaised, half);
  fill({x - half, std::min(y, middle), 2 * half, std::abs(y - middle)}, colour::kAccent);
  ImGui::GetWindowDrawList()->AddCircleFilled({x, y}, radius, hovered || active ? colour::kText : colour::kAccent, 20);
  return value != before;
}

void draw_ring(const ImVec2& centre, float radius, float thickness, double share, ImU32 colour, ImU32 rest) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddCircle(centre, radius, rest, 64, thickness);
  if (share <= 0) return;
  list->PathArcTo(centre, radius, -kPi / 2, -kPi / 2 + float(std::min(share, 1.0)) * 2 * kPi, 64);
  list->PathStroke(colour, 0, thickness);
}

}  // namespace insonate::ui
