#include "app/panels/scan/annotation_layer.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "scenarios/caliper.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr float kReach_px = 10;

ImVec2 on_screen(const PlaneOnScreen& plane, const glm::dvec2& mm) {
  const glm::dvec2 p = plane.screen(mm);
  return {float(p.x), float(p.y)};
}

/// Odd slots have upright crosses and even ones slanted crosses, so that neighbours can be distinguished.
void draw_cross(const Theme& theme, const ImVec2& at, ImU32 colour, bool slanted) {
  const float arm = theme.px(slanted ? 4.5f : 6);
  ImDrawList* list = ImGui::GetWindowDrawList();
  // A dark outline makes it visible on bright echoes.
  for (const auto& [ink, thickness] : {std::pair{colour::kImage, 3.5f}, {colour, 1.5f}}) {
    const ImVec2 first{arm, slanted ? arm : 0}, second{slanted ? -arm : 0, arm};
    for (const ImVec2& to : {first, second})
      list->AddLine({at.x - to.x, at.y - to.y}, {at.x + to.x, at.y + to.y}, ink, theme.px(thickness));
  }
}

void draw_dotted(const Theme& theme, const ImVec2& from, const ImVec2& to, ImU32 colour) {
  const float length = std::hypot(to.x - from.x, to.y - from.y);
  const int dots = int(length / theme.px(6));
  for (int i = 1; i < dots; ++i) {
    const float share = float(i) / float(dots);
    ImGui::GetWindowDrawList()->AddCircleFilled({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)},
                                                theme.px(1.1f), colour, 8);
  }
}

/// Draws text beside a place, on a dark plate so that it can be read on any echo.
void draw_tag(const Theme& theme, const ImVec2& at, ImU32 colour, const std::string& text) {
  const float width = text_width(theme.small_text, text) + theme.px(8), height = theme.px(18);
  const Rect plate{at.x + theme.px(8), at.y - height - theme.px(3), width, height};
  fill(plate, colour::kPlate, theme.px(3));
  draw_text(plate, theme.small_text, colour, text, Align::centre);
}

void draw_measured(const Theme& theme, const PlaneOnScreen& plane, const Action& placed, ImU32 colour) {
  const std::vector<glm::dvec2> ends = handles(placed);
  const bool slanted = placed.slot() % 2 == 0;
  if (placed.kind == ActionKind::ellipse && placed.numbers[5] > 0) {
    // One dot about every 6 pixels, estimated with a circle of the mean of the two axes.
    const double around_px = 3.14 * (caliper_length_mm(placed) / 2 + placed.numbers[5]) * plane.pixels_per_mm();
    for (const glm::dvec2& dot : outline(placed, std::size_t(std::clamp(around_px / theme.px(6), 12.0, 400.0))))
      ImGui::GetWindowDrawList()->AddCircleFilled(on_screen(plane, dot), theme.px(1.1f), colour, 8);
  } else {
    draw_dotted(theme, on_screen(plane, ends[0]), on_screen(plane, ends[1]), colour);
  }
  const std::size_t shown = placed.kind == ActionKind::ellipse && placed.numbers[5] <= 0 ? 2 : ends.size();
  for (std::size_t i = 0; i < shown; ++i) draw_cross(theme, on_screen(plane, ends[i]), colour, slanted);
  draw_tag(theme, on_screen(plane, ends[1]), colour, std::to_string(placed.slot()));
}

void draw_place(const Theme& theme, const PlaneOnScreen& plane, const glm::dvec2& place, ImU32 colour,
                const std::string& text) {
  const ImVec2 at = on_screen(plane, place);
  draw_cross(theme, at, colour, false);
  ImGui::GetWindowDrawList()->AddCircle(at, theme.px(9), colour, 24, theme.px(1.2f));
  if (!text.empty()) draw_tag(theme, at, colour, text);
}

void draw_placed(const Theme& theme, const PlaneOnScreen& plane, const Action& action, ImU32 colour) {
  if (action.kind == ActionKind::caliper || action.kind == ActionKind::ellipse)
    draw_measured(theme, plane, action, colour);
  else
    draw_place(theme, plane, action.point(0), colour, in_words(action.text));
}

ImU32 ink_of(const ShownAnnotations::Value& value) {
  switch (value.of) {
    case ShownAnnotations::Value::Of::picture:
      return colour::kText;
    case ShownAnnotations::Value::Of::other_picture:
      return colour::kMuted;
    case ShownAnnotations::Value::Of::in_hand:
      break;
  }
  return colour::kAccent;
}

/// Returns the upper end of the box.
float draw_values(const Theme& theme, const Rect& panel, const std::vector<ShownAnnotations::Value>& rows) {
  if (rows.empty()) return panel.y + panel.h;
  float names = 0, texts = 0;
  for (const ShownAnnotations::Value& row : rows) {
    names = std::max(names, text_width(theme.small_text, row.name));
    texts = std::max(texts, text_width(theme.strong, row.text));
  }
  const float height = theme.px(23), margin = theme.px(10);
  const Rect box{panel.x + theme.px(16), 0, names + texts + theme.px(18) + 2 * margin,
                 height * float(rows.size()) + margin};
  const Rect placed{box.x, panel.y + panel.h - theme.px(16) - box.h, box.w, box.h};
  fill(placed, colour::kPanel, theme.px(4));
  outline(placed, colour::kLine, theme.px(4));
  Rect rest = placed.inset(margin, margin / 2);
  for (const ShownAnnotations::Value& row : rows) {
    const Rect line = rest.take_top(height);
    const ImU32 ink = ink_of(row);
    draw_text(line, theme.small_text, ink == colour::kText ? colour::kMuted : ink, row.name);
    draw_text(line, theme.strong, ink, row.text, Align::right);
  }
  return placed.y;
}

}  // namespace

float draw_annotations(const Theme& theme, const Rect& panel, const PlaneOnScreen& plane,
                       const ShownAnnotations& annotations) {
  for (const ShownAnnotations::Placed& placed : annotations.placed)
    draw_placed(theme, plane, placed.action, placed.in_hand ? colour::kAccent : colour::kText);
  if (annotations.unnamed_place) draw_place(theme, plane, *annotations.unnamed_place, colour::kAccent, "?");
  return draw_values(theme, panel, annotations.values);
}

void draw_picture_tools(const Theme& theme, const Rect& panel, Session& session, PictureTools& tools,
                        std::map<std::string, Rect>& places) {
  if (!PictureTools::ready(session)) return;
  Rect column{panel.x + panel.w - theme.px(76 + 88), panel.y + theme.px(14), theme.px(88), panel.h};
  const auto add = [&](const char* id, const char* text, const char* tip, ButtonKind kind, bool enabled) {
    const Rect where = column.take_top(theme.px(30));
    column.take_top(theme.px(6));
    places[id] = where;
    return button(theme, id, where, text, kind, enabled, tip);
  };
  using Tool = PictureTools::Tool;
  if (tools.free_choice())
    for (const auto& [tool, id, text, tip] :
         {std::tuple{Tool::distance, "tool_distance", "Distance", "Measures between two points  (C)"},
          {Tool::ellipse, "tool_ellipse", "Ellipse", "Measures circumference and area  (C)"}})
      if (add(id, text, tip, tools.tool() == tool ? ButtonKind::chosen : ButtonKind::normal, true)) tools.choose(tool);
  if (add("tool_undo", "Undo", "Takes back the last thing placed  (Backspace)", ButtonKind::normal, tools.can_undo()))
    tools.undo(session);
  if (add("tool_clear", "Clear", "Takes back all that is placed  (Delete)", ButtonKind::normal,
          tools.annotations().any()))
    tools.clear(session);
}

void take_pointer(const Theme& theme, const PlaneOnScreen& plane, Session& session, PictureTools& tools) {
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  const glm::dvec2 at = plane.plane_mm({pointer.x, pointer.y});
  const double reach_mm = theme.px(kReach_px) / plane.pixels_per_mm();
  if (ImGui::IsItemActivated())
    tools.press(session, at, reach_mm);
  else if (ImGui::IsItemDeactivated())
    tools.release(session, at, reach_mm);
  else if (ImGui::IsItemHovered() || ImGui::IsItemActive())
    tools.move(at);
  if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_None);
  if (ImGui::IsItemHovered()) draw_cross(theme, pointer, colour::kAccent, false);
}

std::string tool_prompt(const PictureTools& tools) {
  using Tool = PictureTools::Tool;
  const bool begun = tools.in_hand().has_value();
  if (tools.has_all()) return "All is placed";
  switch (tools.tool()) {
    case Tool::distance:
      return begun ? "Click the other end" : "Click one end, then the other";
    case Tool::ellipse:
      return !begun                            ? "Click both ends of an axis, then the width"
             : tools.in_hand()->numbers[5] > 0 ? "Click the width"
                                               : "Click the axis' other end";
    case Tool::point:
      return "Click the place";
    case Tool::label:
      return tools.unnamed_place() ? "Now choose its name" : "Click a place, then its name";
  }
  return "";
}

}  // namespace insonate::ui
