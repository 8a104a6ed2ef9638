#include "app/panels/views/space_lines.h"

#include <algorithm>
#include <string>

#include "app/panels/views/space_drawing.h"

namespace insonate::ui {
namespace {

std::string readable(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.x + b.w && b.x < a.x + a.w && a.y < b.y + b.h && b.y < a.y + a.h;
}

}  // namespace

void draw_fan_edge(const Theme& theme, const Rect& space, const Pictures& pictures) {
  const SpaceDrawing drawing(space, pictures.volume_camera());
  drawing.fan_edge(pictures.volume_pose(), pictures.plane().probe, pictures.depth_mm(), colour::kAccent,
                   theme.px(1.5f));
}

void draw_landmarks(const Theme& theme, const Rect& space, const std::vector<Landmark>& landmarks,
                    const Pictures& pictures) {
  const SpaceDrawing drawing(space, pictures.volume_camera());
  const float dot = theme.px(4), gap = dot + theme.px(2), height = theme.px(19);
  struct Seen {
    std::string name;
    ImVec2 at;
    float width;  // of the name's plate
  };
  std::vector<Seen> seen;
  std::vector<Rect> taken;  // by dots, and then by names
  for (const Landmark& landmark : landmarks)
    if (const std::optional<ImVec2> at = drawing.seen(landmark.position)) {
      const std::string name = readable(landmark.name);
      seen.push_back({name, *at, text_width(theme.small_text, name) + theme.px(8)});
      taken.push_back({at->x - dot, at->y - dot, 2 * dot, 2 * dot});
    }
  const auto draw_name = [&](const Rect& plate, const std::string& name) {
    fill(plate, colour::kPlate, theme.px(3));
    draw_text(plate, theme.small_text, colour::kText, name, Align::centre);
  };
  ImDrawList* list = ImGui::GetWindowDrawList();
  const Seen* pointed = nullptr;  // without room for its name
  for (const Seen& each : seen) {
    const auto& [name, at, width] = each;
    list->AddCircleFilled(at, dot, colour::kBackground, 16);
    list->AddCircleFilled(at, theme.px(3), colour::kText, 16);
    const float right = at.x + gap, left = at.x - gap - width, up = at.y - height, middle = at.y - height / 2;
    bool named = false;
    for (const ImVec2& corner : {ImVec2(right, middle), ImVec2(left, middle), ImVec2(right, up), ImVec2(right, at.y),
                                 ImVec2(left, up), ImVec2(left, at.y)}) {
      const Rect plate{corner.x, corner.y, width, height};
      const bool inside = plate.x >= space.x && plate.x + plate.w <= space.x + space.w && plate.y >= space.y &&
                          plate.y + plate.h <= space.y + space.h;
      if (!inside || std::any_of(taken.begin(), taken.end(), [&](const Rect& other) { return overlap(plate, other); }))
        continue;
      taken.push_back(plate);
      draw_name(plate, name);
      named = true;
      break;
    }
    const Rect around{at.x - 2 * dot, at.y - 2 * dot, 4 * dot, 4 * dot};
    if (!named && ImGui::IsMouseHoveringRect(around.min(), around.max(), false)) pointed = &each;
  }
  if (!pointed) return;
  const float right = pointed->at.x + gap;
  const float y = std::clamp(pointed->at.y - height / 2, space.y, space.y + space.h - height);
  const bool fits = right + pointed->width <= space.x + space.w;
  draw_name({fits ? right : pointed->at.x - gap - pointed->width, y, pointed->width, height}, pointed->name);
}

}  // namespace insonate::ui
