#include "app/panels/views/camera_controls.h"

#include <glm/matrix.hpp>

#include <array>
#include <cmath>

namespace insonate::ui {

void move_by_mouse(const Theme& theme, const Rect& panel, view::OrbitCamera& camera, bool dragged) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) camera.zoom(std::pow(1.1, io.MouseWheel));
  if (!dragged || !ImGui::IsItemActive() || (io.MouseDelta.x == 0 && io.MouseDelta.y == 0)) return;
  constexpr double kDegPerPixel = 0.4;
  if (io.MouseDown[1]) {
    camera.zoom(std::pow(1.1, -io.MouseDelta.y / theme.px(12)));
  } else if (io.MouseDown[2] || io.KeyShift) {
    camera.pan({io.MouseDelta.x, io.MouseDelta.y}, int(panel.h));
  } else {
    camera.orbit(kDegPerPixel * io.MouseDelta.x, kDegPerPixel * io.MouseDelta.y);
  }
}

void draw_orientation(const Theme& theme, const Rect& panel, const view::OrbitCamera& camera) {
  struct Axis {
    glm::dvec3 direction;
    const char* name;
  };
  static constexpr double kFaces = 0.08;
  const std::array<Axis, 6> axes{
      {{{1, 0, 0}, "L"}, {{-1, 0, 0}, "R"}, {{0, 1, 0}, "P"}, {{0, -1, 0}, "A"}, {{0, 0, 1}, "S"}, {{0, 0, -1}, "I"}}};
  const glm::dmat3 camera_from_patient = glm::transpose(camera.patient_from_camera().rotation);
  const ImVec2 centre{panel.x + panel.w - theme.px(40), panel.y + panel.h - theme.px(40)};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddCircleFilled(centre, theme.px(31), colour::kPlate, 32);
  for (const Axis& axis : axes) {
    const glm::dvec3 seen = camera_from_patient * axis.direction;  // z points into the picture
    const ImVec2 tip{centre.x + float(seen.x) * theme.px(22), centre.y + float(seen.y) * theme.px(22)};
    if (seen.z > kFaces) continue;
    // The line ends before the letter.
    const float length = std::hypot(tip.x - centre.x, tip.y - centre.y), shown = length - theme.px(9);
    if (shown > 0)
      list->AddLine(centre,
                    {centre.x + (tip.x - centre.x) * shown / length, centre.y + (tip.y - centre.y) * shown / length},
                    colour::kFaint, 1);
    draw_text({tip.x - theme.px(10), tip.y - theme.px(9), theme.px(20), theme.px(18)}, theme.small_text, colour::kText,
              axis.name, Align::centre);
  }
}

}  // namespace insonate::ui
