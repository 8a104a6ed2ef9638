#include "app/panels/setup/setup_sketches.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "app/panels/scan/picture_plates.h"
#include "sim/probe/probe.h"

namespace insonate::ui {
namespace {

/// Length of the drawn probe from its face to its tail, mm, as sim/shaders/view/probe_body.glsl has it.
constexpr double kProbeLength_mm = 131;

ImVec2 screen(const glm::dvec2& point) {
  return {float(point.x), float(point.y)};
}

/// The probe that is drawn. Which one is in the mannequin's box does not matter to the steps.
const Probe& drawn_probe() {
  return *find_probe("curvilinear");
}

/// A picture by the volume view, with what is drawn over it.
class SpaceSketch {
public:
  SpaceSketch(const Rect& area, const view::OrbitCamera& camera) : area_(area), camera_(camera) {}

  int width() const { return int(area_.w); }
  int height() const { return int(area_.h); }
  const view::OrbitCamera& camera() const { return camera_; }
  glm::dvec2 at(const glm::dvec3& patient_mm) const {
    return glm::dvec2(area_.x, area_.y) + camera_.project(patient_mm, width(), height());
  }
  /// Returns whether there was a picture to show.
  bool show(const gl::Texture* picture) const {
    if (picture) ImGui::GetWindowDrawList()->AddImage(id_of(*picture), area_.min(), area_.max());
    return picture;
  }

private:
  Rect area_;
  view::OrbitCamera camera_;
};

void arrow(const Theme& theme, const glm::dvec2& from, const glm::dvec2& to) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const glm::dvec2 way = glm::normalize(to - from), side(-way.y, way.x);
  const double head = theme.px(20);
  const ImVec2 tip = screen(to), left = screen(to - way * head + side * (0.5 * head)),
               right = screen(to - way * head - side * (0.5 * head)), neck = screen(to - way * (0.9 * head));
  // A dark edge keeps it visible on the bright skin.
  list->AddLine(screen(from), neck, colour::kBackground, theme.px(9));
  list->AddTriangle(tip, left, right, colour::kBackground, theme.px(4));
  list->AddLine(screen(from), neck, colour::kAccent, theme.px(5));
  list->AddTriangleFilled(tip, left, right, colour::kAccent);
}

void spot(const Theme& theme, const glm::dvec2& at, bool done, bool current) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 where = screen(at);
  list->AddCircleFilled(where, theme.px(current ? 11 : 8), colour::kBackground, 24);
  list->AddCircleFilled(where, theme.px(current ? 9 : 6), done || current ? colour::kAccent : colour::kFaint, 24);
  if (!current) return;
  list->AddCircle(where, theme.px(17), colour::kBackground, 32, theme.px(5));
  list->AddCircle(where, theme.px(17), colour::kAccent, 32, theme.px(2.5f));
}

/// Draws words on a plate in the middle of `at`.
void label(const Theme& theme, const glm::dvec2& at, std::string_view text, ImU32 ink = colour::kText) {
  const float width = text_width(theme.text, text) + theme.px(16), height = theme.px(26);
  const Rect plate{float(at.x) - width / 2, float(at.y) - height / 2, width, height};
  fill(plate, colour::kPlate, theme.px(4));
  draw_text(plate, theme.text, ink, text, Align::centre);
}

/// Returns a smooth line through points, which it closes: Catmull and Rom's spline.
std::vector<glm::dvec2> smooth(const std::vector<glm::dvec2>& points) {
  constexpr int kParts = 4;
  const auto at = [&](std::size_t i) { return points[i % points.size()]; };
  std::vector<glm::dvec2> line;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 a = at(i + points.size() - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    for (int part = 0; part < kParts; ++part) {
      const double t = double(part) / kParts;
      line.push_back(0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * (t * t) +
                            (3.0 * (b - c) + d - a) * (t * t * t)));
    }
  }
  return line;
}

/// Returns the outline of the drawn probe seen along its z axis, mm in its frame.
std::vector<glm::dvec2> outline_of(const Probe& probe) {
  std::vector<glm::dvec2> half;  // of the marker's side, from the face's middle to the tail's
  const glm::dvec2 edge = face_edge(probe);
  for (int i = 0; i <= 8; ++i) {
    const double angle = glm::radians(probe.field_of_view_deg / 2) * i / 8;
    half.emplace_back(probe.radius_mm * std::sin(angle), probe.radius_mm * (std::cos(angle) - 1));
  }
  half.emplace_back(edge.x - 3, edge.y - 24);
  half.emplace_back(15, edge.y - 34);
  half.emplace_back(14, -62);
  half.emplace_back(15, -75);
  for (int i = 0; i <= 6; ++i)
    half.emplace_back(13 * std::cos(glm::radians(15.0 * i)), -118 - 13 * std::sin(glm::radians(15.0 * i)));
  std::vector<glm::dvec2> whole = half;
  for (std::size_t i = half.size() - 2; i > 0; --i) whole.emplace_back(-half[i].x, half[i].y);
  return smooth(whole);
}

/// Draws where a probe is to go, as its outline, or the outline of its grip alone.
void ghost(const Theme& theme, const SpaceSketch& sketch, const Pose& patient_from_probe, bool grip_alone = false) {
  constexpr double kGrip_mm = -50;
  std::vector<ImVec2> line;
  // Points nearer to each other than the line is wide would give it spikes.
  const auto is_apart = [&](const ImVec2& a, const ImVec2& b) {
    return std::hypot(a.x - b.x, a.y - b.y) > theme.px(3);
  };
  for (const glm::dvec2& point : outline_of(drawn_probe())) {
    if (grip_alone && point.y >= kGrip_mm) continue;
    const ImVec2 at = screen(sketch.at(patient_from_probe.point({point, 0})));
    if (line.empty() || is_apart(line.back(), at)) line.push_back(at);
  }
  while (!grip_alone && line.size() > 2 && !is_apart(line.back(), line.front())) line.pop_back();
  const ImDrawFlags closed = grip_alone ? ImDrawFlags_None : ImDrawFlags_Closed;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddPolyline(line.data(), int(line.size()), colour::kBackground, closed, theme.px(4));
  list->AddPolyline(line.data(), int(line.size()), colour::kText, closed, theme.px(1.8f));
}

/// Draws the moves that show which way is which, on the patient who lies there, seen from the foot end of the table.
void draw_axes(const Theme& theme, const Rect& area, const glm::dvec3& belly, Pictures& pictures, std::size_t part) {
  const glm::dvec3 up(0, -1, 0);
  const AskedMove& move = asked_moves()[std::min<std::size_t>(part / 2, 3)];
  view::OrbitCamera camera = view::OrbitCamera::framing(pictures.grid());
  camera.yaw_deg = -12;
  camera.pitch_deg = -42;
  camera.centre = belly + 55.0 * up;  // between the body and the probe that is lifted
  camera.zoom(1.05);
  const SpaceSketch sketch(area, camera);
  // The probe that is laid over rests on its edge.
  const double lifted_mm = move.beam == -up ? 2 : face_edge(drawn_probe()).x + 4;
  const Pose from{glm::dmat3(move.marker, move.beam, glm::cross(move.marker, move.beam)), belly + lifted_mm * up};
  if (!sketch.show(pictures.draw_probe(camera, sketch.width(), sketch.height(), drawn_probe(), from, true))) return;
  constexpr double kHand_mm = 130;
  if (part % 2 == 1) {
    Pose to = from;
    to.translation += kHand_mm * move.way;
    ghost(theme, sketch, to);
    const glm::dvec3 grip(0, -70, 0);
    arrow(theme, sketch.at(from.point(grip)), sketch.at(to.point(grip)));
  }
  const glm::dvec3 size = glm::dvec3(pictures.grid().size) * pictures.grid().spacing;
  const glm::dvec3 middle = pictures.grid().centre();
  // Where no move ends.
  label(theme, sketch.at({middle.x - 0.16 * size.x, belly.y - 12, middle.z + 0.5 * size.z}), "to the head");
  label(theme, sketch.at({middle.x - 0.5 * size.x, middle.y, middle.z - 0.25 * size.z}), "patient's right");
}

/// A probe alone, seen from the front with its face down and its marker on the left, and the pointed tip that touches
/// landmarks. The tip belongs to the mannequin's probe, not to the simulated one.
class FrontProbe {
public:
  /// @param below_mm, above_mm  room below the face and above the tail
  /// @param tilt_deg  about the tip, to the right
  FrontProbe(const Rect& area, double below_mm, double above_mm) : area_(area) {
    camera_.field_of_view_deg = 12;  // narrow, so that both ends have the same scale
    const double height_mm = below_mm + kProbeLength_mm + above_mm;
    camera_.distance_mm = height_mm / 2 / std::tan(glm::radians(camera_.field_of_view_deg / 2));
    camera_.centre = {0, 0, height_mm / 2 - below_mm};
  }

  /// Returns where a place of the probe's frame (x to the marker, y along the beam, mm) is on the screen.
  glm::dvec2 at(const glm::dvec2& mm) const { return sketch().at(pose(0).point({mm, 0})); }
  glm::dvec2 tip() const { return at(kTip); }
  double pixels_per_mm() const { return glm::distance(at({0, 0}), at({1, 0})); }

  /// Draws the probe, and its outline at these tilts about the tip. Returns false without a patient, on whose texture
  /// the drawing depends.
  bool draw(const Theme& theme, Pictures& pictures, std::initializer_list<double> tilts_deg = {}) const {
    const SpaceSketch space = sketch();
    if (!space.show(pictures.draw_probe(camera_, space.width(), space.height(), drawn_probe(), pose(0), false)))
      return false;
    for (const double tilt_deg : tilts_deg) ghost(theme, space, pose(tilt_deg), true);
    draw_tip();
    return true;
  }

private:
  static constexpr glm::dvec2 kTip{-25, 18};

  SpaceSketch sketch() const { return {area_, camera_}; }
  /// Returns the pose with the tip where it is without a tilt.
  static Pose pose(double tilt_deg) {
    const double c = std::cos(glm::radians(tilt_deg)), s = std::sin(glm::radians(tilt_deg));
    const glm::dvec3 marker(-c, 0, s), beam(-s, 0, -c);
    const Pose turned{glm::dmat3(marker, beam, glm::cross(marker, beam)), glm::dvec3(0)};
    const glm::dvec3 there(-kTip.x, 0, -kTip.y);
    return {turned.rotation, there - turned.point({kTip, 0})};
  }
  /// Draws a steel cone below the edge that is away from the marker, lit from the left as the probe is.
  void draw_tip() const {
    const glm::dvec2 edge = face_edge(drawn_probe());
    const ImVec2 left = screen(at({-edge.x + 9, edge.y - 5})), right = screen(at({-edge.x + 1, edge.y - 7})),
                 middle{(left.x + right.x) / 2, (left.y + right.y) / 2}, end = screen(tip());
    constexpr ImU32 kLit = IM_COL32(214, 219, 224, 255), kShaded = IM_COL32(122, 130, 138, 255);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddTriangleFilled(left, middle, end, kLit);
    list->AddTriangleFilled(middle, right, end, kShaded);
  }

  Rect area_;
  view::OrbitCamera camera_;
};

/// Fills a body that is lit from above.
void lit_block(const Rect& where, ImU32 upper, ImU32 lower, float rounding) {
  fill(where, lower, rounding);
  const Rect top{where.x, where.y, where.w, where.h - rounding};
  ImGui::GetWindowDrawList()->AddRectFilledMultiColor({top.x, top.y + rounding}, top.max(), upper, upper, lower, lower);
  ImGui::GetWindowDrawList()->AddRectFilled(top.min(), {top.x + top.w, top.y + rounding + 1}, upper, rounding,
                                            ImDrawFlags_RoundCornersTop);
}

void draw_pivot(const Theme& theme, const Rect& area, Pictures& pictures) {
  const FrontProbe probe(area, 42, 26);
  if (!probe.draw(theme, pictures, {-34, 34})) return;
  const glm::dvec2 tip = probe.tip();
  const auto mm = float(probe.pixels_per_mm());
  lit_block({float(tip.x) - 75 * mm, float(tip.y), 150 * mm, 16 * mm}, IM_COL32(72, 82, 94, 255),
            IM_COL32(38, 45, 53, 255), 2 * mm);
  spot(theme, tip, false, true);
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (const auto& [begin, end] : {std::pair{-0.70f, -0.57f}, {-0.43f, -0.30f}}) {
    list->PathArcTo(screen(tip), 150 * mm, 3.14159f * begin, 3.14159f * end, 24);
    list->PathStroke(colour::kAccent, 0, theme.px(3));
  }
  label(theme, tip + glm::dvec2(0, 9.5 * mm), "a dimple that stands fast");
}

void draw_face(const Theme& theme, const Rect& area, Pictures& pictures, std::size_t part) {
  const FrontProbe probe(area, 34, 14);
  if (!probe.draw(theme, pictures)) return;
  const glm::dvec2 edge = face_edge(drawn_probe());
  struct Touch {
    glm::dvec2 at, aside;  ///< the place, and the way from it to its name, pixels
    const char* name;
  };
  const double x = theme.px(150), y = theme.px(46);
  const std::array<Touch, 5> touches{{{probe.tip(), {x, y / 3}, "1  tip"},
                                      {probe.at({0, 0}), {-x * 0.5, y}, "2  middle of the face"},
                                      {probe.at(edge), {-x, 0}, "3  end at the marker"},
                                      {probe.at({-edge.x, edge.y}), {x, -y}, "4  other end"},
                                      {probe.at({0, -kProbeLength_mm}), {x, 0}, "5  tail"}}};
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const auto& [at, aside, name] = touches[i];
    ImGui::GetWindowDrawList()->AddLine(screen(at), screen(at + aside), i == part ? colour::kAccent : colour::kFaint,
                                        theme.px(1.5f));
  }
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const auto& [at, aside, name] = touches[i];
    spot(theme, at, i < part, i == part);
    label(theme, at + aside, name, i == part ? colour::kText : colour::kMuted);
  }
}

void draw_landmarks(const Theme& theme, const Rect& area, const SetupWizard& wizard, Pictures& pictures) {
  const std::vector<LandmarkPair> landmarks = wizard.landmarks();
  if (landmarks.empty()) return;
  view::OrbitCamera camera = view::OrbitCamera::framing(pictures.grid());
  camera.yaw_deg = camera.pitch_deg = 0;
  camera.zoom(0.92);  // landmarks lie near the edges of the body
  const SpaceSketch sketch(area, camera);
  if (!sketch.show(
          pictures.draw_body(camera, sketch.width(), sketch.height(), std::numeric_limits<double>::infinity())))
    return;
  const SetupView view = wizard.view();
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    spot(theme, sketch.at(landmarks[i].ct_mm), view.done || i < view.part, !view.done && i == view.part);
  draw_title(theme, area, "Seen from the front: the patient's right is on the left.");
}

void draw_blows(const Theme& theme, const Rect& area, Pictures& pictures, std::size_t blows) {
  constexpr int kBlows = 10;
  const FrontProbe probe(area, 88, 14);
  if (!probe.draw(theme, pictures)) return;
  const auto mm = float(probe.pixels_per_mm());
  const glm::dvec2 key = probe.tip() + glm::dvec2(0, 14 * mm);
  const Rect cap{float(key.x) - 38 * mm, float(key.y), 76 * mm, 17 * mm};
  lit_block(cap, IM_COL32(66, 76, 88, 255), IM_COL32(36, 43, 51, 255), 3 * mm);
  outline(cap, colour::kFaint, 3 * mm, theme.px(1.5f));
  draw_text(cap, theme.strong, colour::kText, "Space", Align::centre);
  const glm::dvec2 beside = probe.at({-48, -70});
  arrow(theme, beside, {beside.x, key.y - 4 * mm});
  for (int i = 0; i < kBlows; ++i) {
    const ImVec2 at(float(key.x) + theme.px(28) * (float(i) - (kBlows - 1) / 2.0f), cap.y + cap.h + 16 * mm);
    ImGui::GetWindowDrawList()->AddCircleFilled(at, theme.px(8),
                                                std::size_t(i) < blows ? colour::kAccent : colour::kRaised, 24);
    ImGui::GetWindowDrawList()->AddCircle(at, theme.px(8), colour::kFaint, 24, theme.px(1.2f));
  }
}

}  // namespace

void draw_setup_sketch(const Theme& theme, const Rect& area, const SetupWizard& wizard, const glm::dvec3& belly,
                       Pictures& pictures) {
  const Rect whole{std::round(area.x), std::round(area.y), std::floor(area.w), std::floor(area.h)};
  if (whole.w < 1 || whole.h < 1) return;
  ImGui::GetWindowDrawList()->PushClipRect(whole.min(), whole.max(), true);
  const SetupView view = wizard.view();
  const std::string_view step = kSetupSteps[wizard.current()];
  if (step == "axes") draw_axes(theme, whole, belly, pictures, view.part);
  if (step == "pivot") draw_pivot(theme, whole, pictures);
  if (step == "face") draw_face(theme, whole, pictures, view.part);
  if (step == "landmarks") draw_landmarks(theme, whole, wizard, pictures);
  if (step == "lag") draw_blows(theme, whole, pictures, view.part);
  ImGui::GetWindowDrawList()->PopClipRect();
}

}  // namespace insonate::ui
