#include "app/panels/views/space_drawing.h"

#include <vector>

#include "sim/view/plane_trace.h"

namespace insonate::ui {

SpaceDrawing::SpaceDrawing(const Rect& panel, const view::OrbitCamera& camera)
    : panel_(panel), camera_(camera), camera_from_patient_(camera.patient_from_camera().inverse()) {
  ImGui::GetWindowDrawList()->PushClipRect(panel.min(), panel.max(), true);
}

SpaceDrawing::~SpaceDrawing() {
  ImGui::GetWindowDrawList()->PopClipRect();
}

bool SpaceDrawing::in_front(const glm::dvec3& patient_mm) const {
  constexpr double kNearest_mm = 10;
  return camera_from_patient_.point(patient_mm).z > kNearest_mm;
}

ImVec2 SpaceDrawing::at(const glm::dvec3& patient_mm) const {
  const glm::dvec2 p = camera_.project(patient_mm, int(panel_.w), int(panel_.h));
  return {panel_.x + float(p.x), panel_.y + float(p.y)};
}

void SpaceDrawing::path(std::span<const glm::dvec3> points, ImU32 colour, float thickness) const {
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (const glm::dvec3& point : points) {
    if (in_front(point)) {
      list->PathLineTo(at(point));
    } else {
      list->PathStroke(colour, 0, thickness);
    }
  }
  list->PathStroke(colour, 0, thickness);
}

void SpaceDrawing::fan_edge(const Pose& patient_from_probe, const Probe& probe, double depth_mm, ImU32 colour,
                            float thickness) const {
  std::vector<glm::dvec3> edge;
  for (const glm::dvec2& point : view::fan_outline(probe, depth_mm))
    edge.push_back(patient_from_probe.point({point, 0}));
  edge.push_back(edge.front());
  path(edge, colour, thickness);
}

std::optional<ImVec2> SpaceDrawing::seen(const glm::dvec3& patient_mm) const {
  if (!in_front(patient_mm)) return std::nullopt;
  const ImVec2 p = at(patient_mm);
  const bool inside = p.x > panel_.x && p.y > panel_.y && p.x < panel_.x + panel_.w && p.y < panel_.y + panel_.h;
  return inside ? std::optional(p) : std::nullopt;
}

void SpaceDrawing::fan(const Pose& patient_from_probe, const Probe& probe, double depth_mm, ImU32 edge,
                       ImU32 glass) const {
  Probe outlined = probe;
  outlined.lines = 24;  // smooth enough for the eye
  const ScanLines lines = scan_lines(outlined, depth_mm, 1);
  std::vector<ImVec2> near_end, far_end;
  for (const ScanLine& line : lines.lines) {
    const glm::dvec3 from = patient_from_probe.point(line.start),
                     to = patient_from_probe.point(line.start + lines.r_max_mm * line.direction);
    if (!in_front(from) || !in_front(to)) return;
    near_end.push_back(at(from));
    far_end.push_back(at(to));
  }
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImDrawListFlags flags = list->Flags;
  list->Flags &= ~ImDrawListFlags_AntiAliasedFill;  // soft edges would show as seams between the quads
  for (std::size_t i = 1; i < near_end.size(); ++i)
    list->AddQuadFilled(near_end[i - 1], near_end[i], far_end[i], far_end[i - 1], glass);
  list->Flags = flags;
  for (const ImVec2& point : near_end) list->PathLineTo(point);
  for (auto point = far_end.rbegin(); point != far_end.rend(); ++point) list->PathLineTo(*point);
  list->PathStroke(edge, ImDrawFlags_Closed, 1.5f);
}

}  // namespace insonate::ui
