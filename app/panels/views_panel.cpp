#include "app/panels/views_panel.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace insonate::ui {
namespace {

void draw_title(const Theme& theme, const Rect& panel, std::string_view title) {
  const Rect plate{panel.x + theme.px(4), panel.y + theme.px(4),
                   std::min(text_width(theme.small_text, title) + theme.px(12), panel.w - theme.px(8)), theme.px(22)};
  fill(plate, colour::kPlate, theme.px(3));
  draw_text(plate.inset(theme.px(6), 0), theme.small_text, colour::kMuted, title);
}

ImTextureID id_of(const gl::Texture& texture) {
  return reinterpret_cast<ImTextureID>(std::uintptr_t(texture.name()));
}

// Draws a picture in the middle of the panel, with the marker on the same side as in the ultrasound. Crops its sides,
// which the fan does not reach, as far as that makes the rest larger.
void draw_like_ultrasound(const Theme& theme, const Rect& panel, const gl::Texture* picture, double fan_share) {
  if (!picture) return;
  const float width = float(picture->width()), height = float(picture->height());
  const float scale = std::min(panel.h / height, panel.w / (width * float(fan_share)));
  const float shown = std::min(1.0f, panel.w / (width * scale));
  const float w = shown * width * scale, h = height * scale;
  const Rect area{panel.x + (panel.w - w) / 2, panel.y + (panel.h - h) / 2, w, h};
  const float left = theme.look().marker == MarkerSide::left ? (1 + shown) / 2 : (1 - shown) / 2;
  ImGui::GetWindowDrawList()->AddImage(id_of(*picture), area.min(), area.max(), {left, 0}, {1 - left, 1});
}

// Shows how the patient lies: the axes that point towards the viewer, with their anatomical letters.
void draw_orientation(const Theme& theme, const Rect& panel, const view::OrbitCamera& camera) {
  struct Axis {
    glm::dvec3 direction;
    const char* name;
  };
  static constexpr double kFaces = 0.08;
  const std::array<Axis, 6> axes{
      {{{1, 0, 0}, "L"}, {{-1, 0, 0}, "R"}, {{0, 1, 0}, "P"}, {{0, -1, 0}, "A"}, {{0, 0, 1}, "H"}, {{0, 0, -1}, "F"}}};
  const glm::dmat3 camera_from_patient = glm::transpose(camera.patient_from_camera().rotation);
  const ImVec2 centre{panel.x + panel.w - theme.px(40), panel.y + panel.h - theme.px(40)};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddCircleFilled(centre, theme.px(31), colour::kPlate, 32);
  for (const Axis& axis : axes) {
    const glm::dvec3 seen = camera_from_patient * axis.direction;  // z points into the picture
    const ImVec2 tip{centre.x + float(seen.x) * theme.px(22), centre.y + float(seen.y) * theme.px(22)};
    if (seen.z > kFaces) continue;
    list->AddLine(centre, tip, colour::kFaint, 1);
    draw_text({tip.x - theme.px(10), tip.y - theme.px(9), theme.px(20), theme.px(18)}, theme.small_text, colour::kText,
              axis.name, Align::centre);
  }
}

struct ViewButton {
  const char* id;
  const char* letter;
  const char* tip;
  std::optional<view::Side> side;  ///< empty: back to the plane
};
constexpr std::array<ViewButton, 7> kViewButtons{{
    {"view_front", "A", "Seen from the front (anterior)", view::Side::front},
    {"view_back", "P", "Seen from behind (posterior)", view::Side::back},
    {"view_right", "R", "Seen from the patient's right", view::Side::right},
    {"view_left", "L", "Seen from the patient's left", view::Side::left},
    {"view_head", "H", "Seen from the head", view::Side::head},
    {"view_feet", "F", "Seen from the feet, as axial CT slices are", view::Side::feet},
    {"view_reset", "\u21ba", "Turned to the plane of the ultrasound again  (Home)", {}},
}};

// Draws a button per side of the patient along the panel's lower edge.
void draw_view_buttons(const Theme& theme, const Rect& panel, Pictures& pictures, std::map<std::string, Rect>& places) {
  const float size = theme.px(26), between = theme.px(3);
  Rect row{panel.x + theme.px(6), panel.y + panel.h - size - theme.px(6), panel.w, size};
  for (const ViewButton& each : kViewButtons) {
    const Rect place = places[each.id] = row.take_left(size);
    row.take_left(between);
    if (button(theme, each.id, place, each.letter, ButtonKind::normal, true, each.tip))
      each.side ? pictures.look_from(*each.side) : pictures.reset_camera();
  }
}

// The line of sight through a point of the screen, in patient mm.
struct Sight {
  glm::dvec3 eye, direction;
};

Sight sight(const view::OrbitCamera& camera, const Rect& panel, const ImVec2& pointer) {
  const Pose pose = camera.patient_from_camera();
  const double focal = panel.h / 2 / std::tan(glm::radians(camera.field_of_view_deg / 2));
  const glm::dvec3 ray((pointer.x - panel.x - panel.w / 2) / focal, (pointer.y - panel.y - panel.h / 2) / focal, 1);
  return {pose.translation, glm::normalize(pose.rotation * ray)};
}

// Returns whether the pointer is on the dummy probe: near its face or its handle.
bool on_probe(const Theme& theme, const view::OrbitCamera& camera, const Rect& panel, const Pose& probe,
              const ImVec2& pointer) {
  constexpr double kHandle_mm = 90;
  for (const double back : {0.0, 0.33, 0.67, 1.0}) {
    const glm::dvec2 at = camera.project(probe.point({0, -kHandle_mm * back, 0}), int(panel.w), int(panel.h));
    if (std::hypot(at.x + panel.x - pointer.x, at.y + panel.y - pointer.y) < theme.px(26)) return true;
  }
  return false;
}

}  // namespace

void SpacePanel::draw(const Theme& theme, const Rect& panel, Session* session, Pictures& pictures,
                      std::map<std::string, Rect>& places) {
  fill(panel, colour::kImage, theme.px(4));
  if (const gl::Texture* picture = pictures.volume())
    ImGui::GetWindowDrawList()->AddImage(id_of(*picture), panel.min(), panel.max());
  draw_view_buttons(theme, panel, pictures, places);  // before the picture's own item, which lies below
  ImGui::SetCursorScreenPos(panel.min());
  ImGui::InvisibleButton("space", {panel.w, panel.h},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  const ImGuiIO& io = ImGui::GetIO();
  view::OrbitCamera& camera = pictures.camera;
  const bool over_probe = ImGui::IsItemHovered() && session && session->shown_pose() &&
                          on_probe(theme, camera, panel, *session->shown_pose(), io.MousePos);
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) camera.zoom(std::pow(1.1, io.MouseWheel));
  if (ImGui::IsItemActivated()) holds_probe_ = over_probe && io.MouseDown[0];
  if (over_probe || (holds_probe_ && ImGui::IsItemActive())) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  if (ImGui::IsItemActive() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    constexpr double kDegPerPixel = 0.4;
    if (holds_probe_ && session) {
      const Sight to = sight(camera, panel, io.MousePos);
      session->move_probe(
          [&](const ProbeHand& hand, const Pose& pose) { return hand.put(pose, to.eye, to.direction); });
    } else if (io.MouseDown[1]) {
      camera.pan({io.MouseDelta.x, io.MouseDelta.y}, int(panel.h));
    } else {
      camera.orbit(kDegPerPixel * io.MouseDelta.x, kDegPerPixel * io.MouseDelta.y);
    }
  }
  draw_title(theme, panel, "Patient");
  draw_orientation(theme, panel, camera);
}

void draw_slice_panel(const Theme& theme, const Rect& panel, const Pictures& pictures) {
  fill(panel, colour::kImage, theme.px(4));
  draw_like_ultrasound(theme, panel, pictures.slice(), pictures.fan_share());
  draw_title(theme, panel, "CT in this plane");
}

void draw_blend_panel(const Theme& theme, const Rect& panel, Pictures& pictures) {
  fill(panel, colour::kImage, theme.px(4));
  draw_like_ultrasound(theme, panel, pictures.blend(), pictures.fan_share());
  draw_title(theme, panel, "CT and ultrasound");
  Rect track{panel.x + theme.px(10), panel.y + panel.h - theme.px(20), panel.w - theme.px(20), theme.px(16)};
  fill({panel.x, track.y - theme.px(2), panel.w, panel.y + panel.h - track.y + theme.px(2)}, colour::kPlate);
  ImGui::SetCursorScreenPos(track.min());
  ImGui::InvisibleButton("blend", {track.w, track.h});
  if (!ImGui::IsItemActive()) draw_tip(theme, track, "More of the CT on the left, more of the ultrasound on the right");
  if (ImGui::IsItemActive())
    pictures.blend_share = std::clamp(double(ImGui::GetIO().MousePos.x - track.x) / track.w, 0.0, 1.0);
  const float y = track.y + track.h / 2, x = track.x + float(pictures.blend_share) * track.w;
  fill({track.x, y - theme.px(1.5f), track.w, theme.px(3)}, colour::kHovered, theme.px(1.5f));
  ImGui::GetWindowDrawList()->AddCircleFilled({x, y}, theme.px(6), colour::kAccent, 20);
}

}  // namespace insonate::ui
