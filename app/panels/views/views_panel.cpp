#include "app/panels/views/views_panel.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/panels/scan/picture_plates.h"
#include "app/panels/views/camera_controls.h"
#include "sim/view/body/line_of_sight.h"

namespace insonate::ui {
namespace {

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
    {"view_head", "S", "Seen from the head (superior)", view::Side::head},
    {"view_feet", "I", "Seen from the feet (inferior), as axial CT slices are", view::Side::feet},
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

// Explains above the row of buttons, beside the axes, why the probe does not follow.
void draw_stop(const Theme& theme, const Rect& panel, const char* words) {
  const float margin = theme.px(12), widest = panel.w - theme.px(76) - 3 * margin;
  const float width = std::min(text_width(theme.strong, words), widest);
  const float height = paragraph_height(theme.strong, words, width + 1);
  const Rect plate{panel.x + margin / 2, panel.y + panel.h - theme.px(40) - height - margin, width + 2 * margin,
                   height + margin};
  fill(plate, colour::kAccentDark, theme.px(4));
  draw_paragraph({plate.x + margin, plate.y + margin / 2, width + 1, height}, theme.strong, colour::kText, words);
}

}  // namespace

bool SpacePanel::draw(const Theme& theme, const Rect& panel, Session* session, Pictures& pictures,
                      std::map<std::string, Rect>& places, const SpaceOverlay& overlay) {
  fill(panel, colour::kImage, theme.px(4));
  if (const gl::Texture* picture = pictures.volume())
    ImGui::GetWindowDrawList()->AddImage(id_of(*picture), panel.min(), panel.max());
  overlay.lines();
  draw_view_buttons(theme, panel, pictures, places);  // before the picture's own item, which lies below
  overlay.buttons();
  ImGui::SetCursorScreenPos(panel.min());
  ImGui::InvisibleButton(
      "space", {panel.w, panel.h},
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  const bool double_clicked = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0);
  const ImGuiIO& io = ImGui::GetIO();
  view::OrbitCamera& camera = pictures.camera;
  const bool over_probe = ImGui::IsItemHovered() && session && session->shown_pose() &&
                          on_probe(theme, camera, panel, *session->shown_pose(), io.MousePos);
  if (ImGui::IsItemActivated()) {
    holds_probe_ = over_probe && io.MouseDown[0] && !io.KeyShift;
    if (holds_probe_) {
      const glm::dvec2 face = camera.project(session->shown_pose()->translation, int(panel.w), int(panel.h));
      grip_ = {io.MousePos.x - panel.x - float(face.x), io.MousePos.y - panel.y - float(face.y)};
    }
  }
  if (over_probe || (holds_probe_ && ImGui::IsItemActive())) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  const bool drags_probe = holds_probe_ && session;
  move_by_mouse(theme, panel, camera, !drags_probe);
  if (drags_probe && ImGui::IsItemActive() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    const glm::dvec2 face(io.MousePos.x - panel.x - grip_.x, io.MousePos.y - panel.y - grip_.y);
    const view::LineOfSight to = view::line_of_sight(camera, face, int(panel.w), int(panel.h));
    session->move_probe([&](const ProbeHand& hand, const Pose& pose) { return hand.put(pose, to.eye, to.direction); });
  }
  draw_title(theme, panel, "Patient");
  if (session && session->stop() != Session::Stop::none && ImGui::IsMouseDown(0))
    draw_stop(theme, panel, stop_words(session->stop()));
  draw_orientation(theme, panel, camera);
  return double_clicked;
}

}  // namespace insonate::ui
