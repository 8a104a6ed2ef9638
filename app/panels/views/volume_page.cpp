#include "app/panels/views/volume_page.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/panels/pages/overlays.h"
#include "app/panels/scan/picture_plates.h"
#include "app/panels/views/camera_controls.h"
#include "app/panels/views/space_drawing.h"
#include "sim/core/text.h"

namespace insonate::ui {
namespace {

using view::kMprPlanes;
using view::MprPlane;

struct PlaneLook {
  const char* id;
  const char* title;
  ImU32 colour;
};

constexpr ImU32 kSide = IM_COL32(130, 204, 140, 255);  // apart from the other planes' accent and violet

PlaneLook look_of(MprPlane plane) {
  switch (plane) {
    case MprPlane::imaging:
      return {"plane_imaging", "As the probe showed it", colour::kAccent};
    case MprPlane::side:
      return {"plane_side", "From the side, along the sweep", kSide};
    case MprPlane::face:
      break;
  }
  return {"plane_face", "Parallel to the probe's face", colour::kExpert};
}

/// Returns the scale at which all three planes show the whole volume while they are not turned.
double scale_for(const Grid& grid, const Rect& panel) {
  constexpr double kMargin = 1.12;
  const glm::dvec3 size_mm = grid.spacing * glm::dvec3(grid.size);
  const double widest = std::max(size_mm.x, size_mm.z), highest = std::max(size_mm.y, size_mm.z);
  return kMargin * std::max(widest / panel.w, highest / panel.h);
}

/// Converts between the patient and a panel that shows a plane around the volume's middle.
struct PlanePicture {
  Pose frame;  ///< origin in the middle of the panel
  Rect panel;
  double mm_per_pixel;

  PlanePicture(const Pose& plane, const glm::dvec3& middle, const Rect& shown, double scale)
      : frame(plane), panel(shown), mm_per_pixel(scale) {
    // The picture stays where it is while the point moves in it.
    const glm::dvec3 off = middle - plane.translation;
    frame.translation +=
        glm::dot(off, plane.rotation[0]) * plane.rotation[0] + glm::dot(off, plane.rotation[1]) * plane.rotation[1];
  }
  glm::dvec3 patient(const ImVec2& screen) const {
    return frame.point(
        {mm_per_pixel * double(screen.x - panel.centre().x), mm_per_pixel * double(screen.y - panel.centre().y), 0});
  }
  ImVec2 screen(const glm::dvec3& patient_mm) const {
    const glm::dvec3 at = (patient_mm - frame.translation) / mm_per_pixel;
    return {panel.centre().x + float(glm::dot(at, frame.rotation[0])),
            panel.centre().y + float(glm::dot(at, frame.rotation[1]))};
  }
};

/// Draws where the other planes cut this one, and a gap around the point so that it is seen.
void draw_cuts(const Theme& theme, const PlanePicture& picture, const view::MprPlanes& planes, MprPlane shown) {
  const ImVec2 centre = picture.screen(planes.centre());
  const float gap = theme.px(8), far = picture.panel.w + picture.panel.h;
  for (const MprPlane other : kMprPlanes) {
    if (other == shown) continue;
    const glm::dvec3 along = glm::cross(planes.normal(shown), planes.normal(other));
    const ImVec2 d{float(glm::dot(along, picture.frame.rotation[0])),
                   float(glm::dot(along, picture.frame.rotation[1]))};
    const ImU32 colour = (look_of(other).colour & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 170);
    for (const float side : {-1.0f, 1.0f})
      ImGui::GetWindowDrawList()->AddLine({centre.x + side * gap * d.x, centre.y + side * gap * d.y},
                                          {centre.x + side * far * d.x, centre.y + side * far * d.y}, colour, 1);
  }
}

/// Returns a camera that sees the whole volume, obliquely towards the imaging plane.
view::OrbitCamera facing_plane(const Grid& grid, const view::MprPlanes& planes) {
  view::OrbitCamera camera = view::OrbitCamera::facing(grid, planes.frame(MprPlane::imaging, false));
  camera.distance_mm = view::OrbitCamera::framing(grid).distance_mm;
  camera.centre = grid.centre();
  return camera;
}

glm::dvec3 corner_of(const Grid& grid, int n) {
  return grid.patient_from_index(glm::dvec3(n & 1, n >> 1 & 1, n >> 2) * glm::dvec3(grid.size) - 0.5);
}

void draw_box(const SpaceDrawing& drawing, const Grid& grid, ImU32 ink, float thickness) {
  for (int from = 0; from < 8; ++from)
    for (const int axis : {1, 2, 4})
      if (!(from & axis)) {
        const std::array<glm::dvec3, 2> edge{corner_of(grid, from), corner_of(grid, from | axis)};
        drawing.path(edge, ink, thickness);
      }
}

/// Returns the closed outline of the part of a plane that lies in a grid's box; empty if the plane misses it.
std::vector<glm::dvec3> outline_in_box(const Grid& grid, const glm::dvec3& through, const glm::dvec3& normal) {
  std::vector<glm::dvec3> points;
  for (int from = 0; from < 8; ++from)
    for (const int axis : {1, 2, 4}) {
      if (from & axis) continue;
      const glm::dvec3 a = corner_of(grid, from), b = corner_of(grid, from | axis);
      const double of_a = glm::dot(a - through, normal), of_b = glm::dot(b - through, normal);
      if ((of_a < 0) != (of_b < 0)) points.push_back(a + of_a / (of_a - of_b) * (b - a));
    }
  if (points.empty()) return points;
  glm::dvec3 middle(0);
  for (const glm::dvec3& point : points) middle += point / double(points.size());
  const glm::dvec3 u = glm::normalize(points.front() - middle), v = glm::cross(normal, u);
  const auto angle = [&](const glm::dvec3& p) { return std::atan2(glm::dot(p - middle, v), glm::dot(p - middle, u)); };
  std::sort(points.begin(), points.end(), [&](const auto& p, const auto& q) { return angle(p) < angle(q); });
  points.push_back(points.front());
  return points;
}

/// Draws how well it was swept, and what the volume is.
void draw_words(const Theme& theme, Rect rest, const SweptVolume& swept) {
  const auto paragraph = [&](ImFont* font, ImU32 ink, const std::string& text) {
    rest.take_top(draw_paragraph(rest, font, ink, text) + theme.px(6));
  };
  const SweepQuality& quality = swept.quality;
  draw_text(rest.take_top(theme.px(28)), theme.heading, colour::kText, "Swept volume");
  paragraph(theme.text, quality.is_good() ? colour::kText : colour::kAmber, quality.verdict());
  constexpr std::size_t kMaxFlaws = 5;
  for (std::size_t n = 0; n < std::min(quality.flaws.size(), kMaxFlaws); ++n)
    paragraph(theme.small_text, colour::kAmber, "\u2022 " + quality.flaws[n].words());
  if (quality.flaws.size() > kMaxFlaws)
    paragraph(theme.small_text, colour::kAmber, formatted("and %zu more", quality.flaws.size() - kMaxFlaws));
  const Grid& grid = swept.volume.grey.grid;
  paragraph(theme.small_text, colour::kMuted,
            formatted("%d x %d x %d voxels of %.2f mm. Bluish voxels are interpolated between pictures.", grid.size.x,
                      grid.size.y, grid.size.z, grid.spacing.x));
  if (!swept.remark.empty()) paragraph(theme.small_text, colour::kMuted, swept.remark);
  paragraph(theme.small_text, colour::kFaint,
            "In a plane: drag to move the point, with the right button to turn the other planes; the wheel moves the "
            "plane. Up, Down: along the sweep. The volume turns as the patient does in the 3D view.");
}

}  // namespace

void VolumePage::show(const std::shared_ptr<const SweptVolume>& swept) {
  if (swept == swept_) return;
  swept_ = swept;
  planes_ = view::MprPlanes(swept->volume.grey.grid);
  problem_.clear();
  texture_.reset();
  volume_.reset();
  camera_ = facing_plane(swept->volume.grey.grid, planes_);
  try {
    texture_ = std::make_unique<view::SweptTexture>(swept->volume.grey, swept->volume.known);
    volume_ = std::make_unique<view::SweptView>(swept->volume.grey, swept->volume.known);
    for (auto& each : views_) {
      if (!each) each = std::make_unique<view::MprView>();
      each->forget();
    }
    face_ = std::make_unique<view::MprView>();
  } catch (const gl::DeviceRefused& error) {
    problem_ = error.what();
  }
}

void VolumePage::step(int voxels) {
  if (swept_) planes_.shift(MprPlane::imaging, voxels * swept_->volume.grey.grid.spacing.z);
}

void VolumePage::reset() {
  planes_.reset();
  if (swept_) camera_ = facing_plane(swept_->volume.grey.grid, planes_);
}

void VolumePage::switch_cut() {
  cut_ = !cut_;
}

long VolumePage::version_of(GLuint texture) const {
  if (volume_ && texture == volume_picture_) return volume_->renders();
  for (std::size_t n = 0; n < pictures_.size(); ++n)
    if (views_[n] && pictures_[n] == texture) return views_[n]->renders();
  return 0;
}

void VolumePage::draw_plane(const Theme& theme, const Rect& panel, MprPlane plane, double mm_per_pixel) {
  const PlaneLook look = look_of(plane);
  const bool marker_left = theme.look().marker == MarkerSide::left;
  const Grid& grid = swept_->volume.grey.grid;
  ImGui::SetCursorScreenPos(panel.min());
  ImGui::InvisibleButton(look.id, {panel.w, panel.h},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  const PlanePicture before(planes_.frame(plane, marker_left), grid.centre(), panel, mm_per_pixel);
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    wheel_ += io.MouseWheel;  // a trackpad moves it by small steps
    planes_.shift(plane, std::trunc(wheel_) * grid.spacing.x);
    wheel_ -= std::trunc(wheel_);
  }
  if (ImGui::IsItemActive() && io.MouseDown[0]) {
    planes_.move_to(before.patient(io.MousePos));
  } else if (ImGui::IsItemActive() && io.MouseDown[1] && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    const ImVec2 about = before.screen(planes_.centre());
    const auto angle = [&](float x, float y) { return std::atan2(double(y - about.y), double(x - about.x)); };
    const double turned =
        angle(io.MousePos.x, io.MousePos.y) - angle(io.MousePos.x - io.MouseDelta.x, io.MousePos.y - io.MouseDelta.y);
    planes_.turn(plane, glm::degrees(std::remainder(turned, glm::radians(360.0))), marker_left);
  }

  const PlanePicture picture(planes_.frame(plane, marker_left), grid.centre(), panel, mm_per_pixel);
  view::MprPicture drawn;
  drawn.patient_from_picture = picture.frame;
  drawn.mm_per_pixel = mm_per_pixel;
  drawn.width = int(panel.w);
  drawn.height = int(panel.h);
  const auto number = std::size_t(plane);
  const gl::Texture& texture = views_[number]->render(*texture_, drawn);
  pictures_[number] = texture.name();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(panel.min(), panel.max(), true);
  list->AddImage(id_of(texture), panel.min(), panel.max());
  draw_cuts(theme, picture, planes_, plane);
  const ImVec2 corner{panel.x + theme.px(4), panel.y + theme.px(4)};
  const float title_width = draw_chip(theme, corner, colour::kPlate, look.colour, look.title);
  draw_edge_letters(theme, panel, view::edge_letters(picture.frame.rotation[0], picture.frame.rotation[1]),
                    {corner.x, corner.y, title_width, 0}, {});
  list->PopClipRect();
  outline(panel, look.colour);
}

view::UltrasoundPlane VolumePage::face() {
  const Grid& grid = swept_->volume.grey.grid;
  // Twice the volume's diagonal wide, so that the plane covers it however it is turned and wherever the point lies.
  view::MprPicture drawn;
  drawn.patient_from_picture = planes_.frame(MprPlane::imaging, false);
  drawn.width = drawn.height = 600;
  drawn.mm_per_pixel = 2 * glm::length(grid.spacing * glm::dvec3(grid.size)) / drawn.width;
  drawn.unseen_clear = true;
  view::UltrasoundPlane face;
  face.image = &face_->render(*texture_, drawn);
  face.image_version = face_->renders();
  face.geometry = {drawn.width, drawn.height, drawn.mm_per_pixel,
                   glm::dvec2(-drawn.mm_per_pixel * (drawn.width - 1) / 2)};
  face.patient_from_probe = drawn.patient_from_picture;
  return face;
}

void VolumePage::draw_volume(const Theme& theme, const Rect& panel, Pictures& pictures,
                             std::map<std::string, Rect>& places) {
  // Before the picture's own item, which lies below them.
  Rect row{panel.x + theme.px(4), panel.y + theme.px(4), panel.w, theme.px(26)};
  const auto choice = [&](const char* id, const char* text, bool in_patient, const char* tip) {
    const Rect place = places[id] = row.take_left(theme.px(84));
    row.take_left(theme.px(4));
    if (button(theme, id, place, text, in_patient == in_patient_ ? ButtonKind::chosen : ButtonKind::normal, true, tip))
      in_patient_ = in_patient;
  };
  const ImVec2 below = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->ChannelsSplit(2);
  list->ChannelsSetCurrent(1);
  choice("show_volume", "Volume", false, "The swept volume, by volume rendering");
  choice("show_patient", "Patient", true, "The patient as in the 3D view, cut at the probe's plane");
  list->ChannelsSetCurrent(0);
  ImGui::SetCursorScreenPos(panel.min());
  ImGui::InvisibleButton(
      "swept_volume", {panel.w, panel.h},
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  move_by_mouse(theme, panel, camera_);
  // While a button is down something moves: a coarser picture in time, and the whole one when it is let go.
  constexpr double kMoving_ms = 30;
  const view::VolumeBudget budget =
      ImGui::IsAnyMouseDown() ? view::VolumeBudget{kMoving_ms, kMoving_ms} : view::VolumeBudget();
  const gl::Texture* texture = in_patient_ ? pictures.draw_cut(face(), camera_, int(panel.w), int(panel.h), budget)
                                           : &volume_->render(int(panel.w), int(panel.h), camera_, look_,
                                                              cut_ ? face() : view::UltrasoundPlane(), budget);
  if (!in_patient_) volume_picture_ = texture->name();
  list->PushClipRect(panel.min(), panel.max(), true);
  if (texture) list->AddImage(id_of(*texture), panel.min(), panel.max());
  const SpaceDrawing drawing(panel, camera_);
  const Grid& grid = swept_->volume.grey.grid;
  for (const MprPlane plane : kMprPlanes)
    drawing.path(outline_in_box(grid, planes_.centre(), planes_.normal(plane)), look_of(plane).colour, theme.px(1.2f));
  if (in_patient_) draw_box(drawing, grid, colour::kFaint, theme.px(1));
  draw_orientation(theme, panel, camera_);
  list->PopClipRect();
  outline(panel, colour::kFaint);
  list->ChannelsMerge();
  ImGui::SetCursorScreenPos(below);
}

VolumeAnswer VolumePage::draw(const Theme& theme, const Rect& screen, const std::shared_ptr<const SweptVolume>& swept,
                              Pictures& pictures, std::map<std::string, Rect>& places) {
  show(swept);
  const float gap = theme.px(8);
  Rect rest = begin_overlay(theme, screen, {screen.w, screen.h}).inset(-theme.px(16), -theme.px(12));
  Rect side = rest.take_right(theme.px(270));
  rest.take_right(theme.px(16));
  // The panels lie on whole pixels, as the pictures do.
  const float w = std::floor((rest.w - gap) / 2), h = std::floor((rest.h - gap) / 2);
  const float x = std::round(rest.x), y = std::round(rest.y);
  const std::array<Rect, 3> panels{Rect{x, y, w, h}, Rect{x + w + gap, y, w, h}, Rect{x, y + h + gap, w, h}};
  const double mm_per_pixel = scale_for(swept->volume.grey.grid, panels[0]);
  for (const MprPlane plane : kMprPlanes) {
    const Rect& panel = places[look_of(plane).id] = panels[std::size_t(plane)];
    if (problem_.empty()) draw_plane(theme, panel, plane, mm_per_pixel);
  }
  const Rect& volume_panel = places["swept_volume"] = {x + w + gap, y + h + gap, w, h};
  if (problem_.empty()) draw_volume(theme, volume_panel, pictures, places);
  if (!problem_.empty()) draw_paragraph(panels[0], theme.text, colour::kAmber, problem_);

  VolumeAnswer answer = VolumeAnswer::none;
  const auto next = [&](const char* id, const char* text, ButtonKind kind, const char* tip, bool enabled = true) {
    const Rect place = places[id] = side.take_bottom(theme.px(38));
    side.take_bottom(gap);
    return button(theme, id, place, text, kind, enabled, tip);
  };
  if (next("close_volume", "Close  (Esc)", ButtonKind::primary, "")) answer = VolumeAnswer::close;
  if (next("save_volume", "Save  (S)", ButtonKind::normal, "Writes the volume as an NRRD, which 3D Slicer opens"))
    answer = VolumeAnswer::save;
  if (next("reset_planes", "Planes as at first  (Home)", ButtonKind::normal, "")) reset();
  const auto look_slider = [&](const char* id, const char* name, const std::string& text, double& value, double most,
                               double step, double normal, const char* tip) {
    const Rect place = places[id] = side.take_bottom(theme.px(40));
    side.take_bottom(gap);
    slider(theme, id, place, name, text, value, 0, most, step, normal, problem_.empty() && !in_patient_, tip);
  };
  const view::SweptLook usual;
  look_slider("swept_opacity", "Opacity", formatted("%.0f %%", 100 * look_.opacity), look_.opacity, view::kMaxOpacity,
              0.005, usual.opacity, "Of 1 mm of white tissue in the volume. A double click takes it back.");
  look_slider("swept_threshold", "Threshold", formatted("%.0f", look_.threshold), look_.threshold,
              view::kMaxSweptThreshold, 1, usual.threshold,
              "Grey level from which tissue shows in the volume. A double click takes it back.");
  if (next("cut_volume", cut_ ? "Show the whole volume  (C)" : "Cut the volume at the plane  (C)", ButtonKind::normal,
           "The plane is that of the probe's picture", !in_patient_))
    switch_cut();
  draw_words(theme, side, *swept);
  end_overlay();
  return answer;
}

void draw_swept_box(const Theme& theme, const Rect& space, const SweptVolume& swept, const view::OrbitCamera& camera) {
  draw_box(SpaceDrawing(space, camera), swept.volume.grey.grid, colour::kAccent, theme.px(1));
}

}  // namespace insonate::ui
