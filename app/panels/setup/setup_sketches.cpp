#include "app/panels/setup/setup_sketches.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace insonate::ui {
namespace {

constexpr ImU32 kBody = IM_COL32(48, 56, 66, 255), kBodyLit = IM_COL32(60, 70, 82, 255),
                kTable = IM_COL32(26, 31, 37, 255), kProbe = IM_COL32(190, 198, 206, 255),
                kGhost = IM_COL32(190, 198, 206, 70);

ImVec2 screen(const glm::dvec2& point) {
  return {float(point.x), float(point.y)};
}

/// Fills a convex polygon given in either order. ImGui smooths only edges that run clockwise on the screen.
void polygon(const std::vector<glm::dvec2>& points, ImU32 colour) {
  std::vector<ImVec2> corners;
  double twice_area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 &a = points[i], &b = points[(i + 1) % points.size()];
    twice_area += a.x * b.y - b.x * a.y;
    corners.push_back(screen(a));
  }
  if (twice_area < 0) std::reverse(corners.begin(), corners.end());
  ImGui::GetWindowDrawList()->AddConvexPolyFilled(corners.data(), int(corners.size()), colour);
}

void arrow(const Theme& theme, const glm::dvec2& from, const glm::dvec2& to, ImU32 colour) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const glm::dvec2 way = glm::normalize(to - from), side(-way.y, way.x);
  const double head = theme.px(18);
  list->AddLine(screen(from), screen(to - way * head), colour, theme.px(5));
  const ImVec2 tip = screen(to), left = screen(to - way * head + side * (0.55 * head)),
               right = screen(to - way * head - side * (0.55 * head));
  list->AddTriangleFilled(tip, left, right, colour);
}

void spot(const Theme& theme, const glm::dvec2& at, bool done, bool current) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 where = screen(at);
  list->AddCircleFilled(where, theme.px(current ? 9 : 6), done || current ? colour::kAccent : colour::kFaint, 24);
  if (current) list->AddCircle(where, theme.px(17), colour::kAccent, 32, theme.px(2.5f));
}

/// A patient who lies on a table with the head to the right, seen from above the right side. Lengths are in mm from the
/// middle of the body, along (patient's right, up, towards the head).
class LyingPatient {
public:
  explicit LyingPatient(const Rect& area)
      : middle_(area.x + area.w * 0.46, area.y + area.h * 0.64), scale_(std::min(area.h / 760, area.w / 1400)) {}

  glm::dvec2 at(const glm::dvec3& p) const {
    return middle_ + scale_ * (p.x * glm::dvec2(-0.42, 0.46) + p.y * glm::dvec2(0, -1) + p.z * glm::dvec2(0.95, -0.16));
  }
  double scale() const { return scale_; }

  void draw() const {
    slab({250, -90, 560}, {-250, -90, -420}, 25, kTable, kTable);
    slab({150, 90, 290}, {-150, 90, -330}, 180, kBodyLit, kBody);
    const glm::dvec2 head = at({0, 20, 420});
    ImGui::GetWindowDrawList()->AddCircleFilled(screen(head), float(105 * scale_), kBodyLit, 48);
  }

private:
  // Draws a box whose upper side has two given corners and which is `thick` mm thick below it.
  void slab(const glm::dvec3& a, const glm::dvec3& b, double thick, ImU32 top, ImU32 sides) const {
    const glm::dvec3 down(0, -thick, 0);
    const glm::dvec3 near_head = a, far_head(b.x, a.y, a.z), far_foot = b, near_foot(a.x, a.y, b.z);
    polygon({at(near_head), at(near_foot), at(near_foot + down), at(near_head + down)}, sides);
    polygon({at(near_foot), at(far_foot), at(far_foot + down), at(near_foot + down)}, sides);
    polygon({at(near_head), at(far_head), at(far_foot), at(near_foot)}, top);
  }

  glm::dvec2 middle_;
  double scale_;
};

/// Draws a probe in the patient's directions, given its face, the direction of its marker and that of its beam.
void draw_probe(const Theme& theme, const LyingPatient& patient, const glm::dvec3& face, const glm::dvec3& marker,
                const glm::dvec3& beam, ImU32 colour) {
  // Larger than life. The second side, 0.45 times as wide, gives it thickness, so that it is never seen edge-on.
  const glm::dvec3 across = glm::cross(marker, beam), neck = face - 110.0 * beam, tail = face - 340.0 * beam;
  for (const glm::dvec3& side : {marker, 0.45 * across}) {
    polygon({patient.at(face + 85.0 * side), patient.at(face - 85.0 * side), patient.at(neck - 50.0 * side),
             patient.at(neck + 50.0 * side)},
            colour);
    polygon({patient.at(neck + 40.0 * side), patient.at(neck - 40.0 * side), patient.at(tail - 34.0 * side),
             patient.at(tail + 34.0 * side)},
            colour);
  }
  if (colour != kGhost)
    ImGui::GetWindowDrawList()->AddCircleFilled(screen(patient.at(face + 66.0 * marker - 40.0 * beam)), theme.px(7),
                                                colour::kAccent, 24);
}

void draw_axes(const Theme& theme, const Rect& area, std::size_t part) {
  struct Move {
    glm::dvec3 marker, beam, way;
  };
  const glm::dvec3 right(1, 0, 0), up(0, 1, 0), head(0, 0, 1);
  const std::array<Move, 4> moves{{{right, -up, right}, {right, -up, up}, {head, -up, head}, {up, right, up}}};
  const Move& move = moves[std::min<std::size_t>(part / 2, 3)];
  const LyingPatient patient(area);
  patient.draw();
  const glm::dvec3 from(0, move.beam.y < 0 ? 95 : 150, 0), to = from + 230.0 * move.way;
  draw_probe(theme, patient, from, move.marker, move.beam, kProbe);
  if (part % 2 == 1) {
    draw_probe(theme, patient, to, move.marker, move.beam, kGhost);
    const glm::dvec3 grip = from - 200.0 * move.beam;
    arrow(theme, patient.at(grip), patient.at(grip + 230.0 * move.way), colour::kAccent);
  }
  const auto label = [&](const glm::dvec3& place, const char* text) {
    const glm::dvec2 at = patient.at(place);
    draw_text({float(at.x) - theme.px(80), float(at.y) - theme.px(12), theme.px(160), theme.px(24)}, theme.text,
              colour::kMuted, text, Align::centre);
  };
  label({0, 20, 420}, "head");
  label({345, -90, -60}, "patient's right");
}

/// A probe seen from the front with its face down, showing the places that touch landmarks.
class FrontProbe {
public:
  FrontProbe(const glm::dvec2& face, double height, double tilt_deg)
      : face_(face), scale_(height / 260), turn_(tilt_deg * 3.14159265358979 / 180) {}

  /// Converts mm, to the right and up from the middle of the face, to the screen.
  glm::dvec2 at(double right, double up) const {
    const glm::dvec2 p(right * std::cos(turn_) + up * std::sin(turn_), right * std::sin(turn_) - up * std::cos(turn_));
    return face_ + scale_ * p;
  }
  void draw(const Theme& theme, ImU32 colour) const {
    polygon({at(-48, 0), at(48, 0), at(32, 72), at(-32, 72)}, colour);
    polygon({at(-25, 72), at(25, 72), at(20, 230), at(-20, 230)}, colour);
    polygon({at(47, 0), at(42, -30), at(33, 0)}, colour);
    if (colour != kGhost)
      ImGui::GetWindowDrawList()->AddCircleFilled(screen(at(-38, 18)), theme.px(6), colour::kAccentDark, 24);
  }
  glm::dvec2 tip() const { return at(42, -30); }

  /// Returns a probe whose tip is at a place.
  static FrontProbe standing(const glm::dvec2& tip, double height, double tilt_deg) {
    return {tip - FrontProbe({0, 0}, height, tilt_deg).tip(), height, tilt_deg};
  }

private:
  glm::dvec2 face_;
  double scale_, turn_;
};

void draw_pivot(const Theme& theme, const Rect& area) {
  const glm::dvec2 dimple(area.x + area.w / 2, area.y + area.h * 0.86);
  const double height = area.h * 0.7, block = area.h * 0.55;
  for (const double tilt : {-32.0, 32.0}) FrontProbe::standing(dimple, height, tilt).draw(theme, kGhost);
  FrontProbe::standing(dimple, height, 0).draw(theme, kProbe);
  polygon({dimple + glm::dvec2(-block, 0), dimple + glm::dvec2(block, 0), dimple + glm::dvec2(block, area.h * 0.12),
           dimple + glm::dvec2(-block, area.h * 0.12)},
          kBody);
  spot(theme, dimple, false, true);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PathArcTo(screen(dimple), float(height * 1.04), -3.14159f * 0.68f, -3.14159f * 0.32f, 32);
  list->PathStroke(colour::kAccent, 0, theme.px(4));
}

void draw_face(const Theme& theme, const Rect& area, std::size_t part) {
  const FrontProbe probe({area.x + area.w / 2, area.y + area.h * 0.78}, area.h * 0.76, 0);
  probe.draw(theme, kProbe);
  const std::array<std::pair<glm::dvec2, const char*>, 5> touches{{{probe.tip(), "1  tip"},
                                                                   {probe.at(0, 0), "2  middle of the face"},
                                                                   {probe.at(-48, 0), "3  end at the marker"},
                                                                   {probe.at(48, 0), "4  other end"},
                                                                   {probe.at(0, 230), "5  tail"}}};
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const auto& [at, name] = touches[i];
    spot(theme, at, i < part, i == part);
    const bool left = i == 2, below = i == 1;
    const float x = float(at.x) + theme.px(below ? -140 : left ? -212 : 30);
    const float y = float(at.y) + theme.px(below ? 20 : i == 0 ? 6 : i == 3 ? -30 : -12);
    draw_text({x, y, theme.px(180), theme.px(24)}, i == part ? theme.strong : theme.text,
              i == part ? colour::kText : colour::kMuted, name,
              below  ? Align::centre
              : left ? Align::right
                     : Align::left);
  }
}

void draw_landmarks(const Theme& theme, const Rect& area, const SetupWizard& wizard, Pictures& pictures) {
  const std::vector<LandmarkPair> landmarks = wizard.landmarks();
  const int width = int(area.w), height = int(area.h);
  if (landmarks.empty() || width < 1 || height < 1) return;
  view::OrbitCamera camera = view::OrbitCamera::framing(pictures.grid());
  camera.yaw_deg = camera.pitch_deg = 0;
  camera.zoom(0.92);  // landmarks lie near the edges of the body
  const gl::Texture* body = pictures.draw_body(camera, width, height, std::numeric_limits<double>::infinity());
  if (!body) return;
  ImGui::GetWindowDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(body->name())), area.min(),
                                       area.max());
  const SetupView view = wizard.view();
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const glm::dvec2 at = camera.project(landmarks[i].ct_mm, width, height);
    spot(theme, at + glm::dvec2(area.x, area.y), view.done || i < view.part, !view.done && i == view.part);
  }
  const Rect caption{area.x + theme.px(12), area.y + theme.px(8), area.w - theme.px(24), theme.px(22)};
  draw_text(caption, theme.small_text, colour::kMuted, "Seen from the front: the patient's right is on the left.");
}

void draw_blows(const Theme& theme, const Rect& area, std::size_t blows) {
  constexpr int kBlows = 10;
  const glm::dvec2 key(area.x + area.w / 2, area.y + area.h * 0.74);
  const double height = area.h * 0.5;
  const FrontProbe probe(key + glm::dvec2(0, -area.h * 0.14), height, 0);
  probe.draw(theme, kProbe);
  arrow(theme, key + glm::dvec2(area.h * 0.22, -area.h * 0.42), key + glm::dvec2(area.h * 0.22, -area.h * 0.06),
        colour::kAccent);
  const Rect cap{float(key.x) - theme.px(90), float(key.y), theme.px(180), theme.px(40)};
  fill(cap, colour::kRaised, theme.px(6));
  outline(cap, colour::kFaint, theme.px(6), theme.px(2));
  draw_text(cap, theme.strong, colour::kText, "Space", Align::centre);
  for (int i = 0; i < kBlows; ++i) {
    const ImVec2 at(float(key.x) + theme.px(26) * (float(i) - (kBlows - 1) / 2.0f), cap.y + cap.h + theme.px(24));
    ImGui::GetWindowDrawList()->AddCircleFilled(at, theme.px(7), std::size_t(i) < blows ? colour::kAccent : kBody, 20);
  }
}

}  // namespace

void draw_setup_sketch(const Theme& theme, const Rect& area, const SetupWizard& wizard, Pictures& pictures) {
  ImGui::GetWindowDrawList()->PushClipRect(area.min(), area.max(), true);
  const SetupView view = wizard.view();
  const std::string_view step = kSetupSteps[wizard.current()];
  if (step == "axes") draw_axes(theme, area, view.part);
  if (step == "pivot") draw_pivot(theme, area);
  if (step == "face") draw_face(theme, area, view.part);
  if (step == "landmarks") draw_landmarks(theme, area, wizard, pictures);
  if (step == "lag") draw_blows(theme, area, view.part);
  ImGui::GetWindowDrawList()->PopClipRect();
}

}  // namespace insonate::ui
