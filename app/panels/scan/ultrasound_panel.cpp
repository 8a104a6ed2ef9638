#include "app/panels/scan/ultrasound_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "app/panels/scan/annotation_layer.h"
#include "app/panels/scan/exam_panel.h"
#include "app/panels/scan/picture_plates.h"
#include "sim/core/text.h"
#include "sim/view/plane_trace.h"

namespace insonate::ui {
namespace {

ImVec2 at(const PlaneOnScreen& plane, const glm::dvec2& plane_mm) {
  const glm::dvec2 p = plane.screen(plane_mm);
  return {float(p.x), float(p.y)};
}

// Draws a tick per centimetre; every fifth is longer and numbered, or every one if there is room.
void draw_depth_scale(const Theme& theme, const Rect& panel, const PlaneOnScreen& plane, double depth_mm) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const bool in_mm = theme.look().length_unit == LengthUnit::mm;
  const float right = panel.x + panel.w - theme.px(14);
  const int numbered_cm = plane.pixels_per_mm() * 10 > theme.px(34) ? 1 : 5;
  for (int cm = 0; 10 * cm <= depth_mm + 0.5; ++cm) {
    const float y = std::round(at(plane, {0, 10.0 * cm}).y);
    const bool major = cm % 5 == 0;
    list->AddLine({right - theme.px(major ? 12 : 6), y}, {right, y}, major ? colour::kText : colour::kMuted, 1);
    if (cm % numbered_cm == 0 && cm > 0)
      draw_on_plate(theme, {right - theme.px(52), y - theme.px(10), theme.px(34), theme.px(20)}, theme.small_text,
                    colour::kMuted, std::to_string(in_mm ? 10 * cm : cm), Align::right);
  }
  draw_on_plate(theme, {right - theme.px(52), at(plane, {0, 0}).y - theme.px(10), theme.px(34), theme.px(20)},
                theme.small_text, colour::kFaint, in_mm ? "mm" : "cm", Align::right);
}

/// Draws the scale below the texts and the state, as far as there is room above `bottom`.
void draw_grey_scale(const Theme& theme, const Rect& panel, float bottom, double dynamic_range_db) {
  const float top = panel.y + std::max(panel.h * 0.36f, theme.px(196));
  const Rect bar{panel.x + theme.px(16), top, theme.px(12), std::min(panel.h * 0.28f, bottom - theme.px(16) - top)};
  if (bar.h < theme.px(40)) return;
  ImGui::GetWindowDrawList()->AddRectFilledMultiColor(bar.min(), bar.max(), IM_COL32_WHITE, IM_COL32_WHITE,
                                                      IM_COL32_BLACK, IM_COL32_BLACK);
  outline(bar, colour::kLine);
  const Rect label{bar.x + theme.px(20), bar.y, theme.px(60), theme.px(18)};
  draw_on_plate(theme, label, theme.small_text, colour::kMuted, "0 dB");
  draw_on_plate(theme, {label.x, bar.y + bar.h - label.h, label.w, label.h}, theme.small_text, colour::kMuted,
                formatted("\u2212%.0f", dynamic_range_db));
}

/// Returns the middle of the dot beside the face's edge that is on the marker's side.
ImVec2 marker_dot(const Theme& theme, const PlaneOnScreen& plane, const Probe& probe) {
  const ImVec2 edge = at(plane, face_edge(probe));
  return {edge.x + theme.px(theme.look().marker == MarkerSide::left ? -20 : 20), edge.y + theme.px(4)};
}

void draw_marker(const Theme& theme, const PlaneOnScreen& plane, const Probe& probe) {
  const ImVec2 dot = marker_dot(theme, plane, probe);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddCircleFilled(dot, theme.px(6), colour::kAccent, 24);
  list->AddCircle(dot, theme.px(9), colour::kAccent, 24, 1.2f);
}

std::string mark_text(const Session& session) {
  return "Mark " + std::to_string(session.event_markers_s().size()) + " at " +
         clock_text(session.event_markers_s().back());
}

// Shows an event marker for a short time after it was set.
void draw_mark(const Theme& theme, const Rect& panel, const Session& session) {
  constexpr double kShown_s = 2;
  if (session.event_markers_s().empty() || session.attempt_for_s() - session.event_markers_s().back() > kShown_s)
    return;
  const std::string text = mark_text(session);
  const float width = text_width(theme.strong, text) + theme.px(24);
  draw_chip(theme, {panel.x + (panel.w - width) / 2, panel.y + theme.px(14)}, colour::kAccent, colour::kBackground,
            text);
}

/// Draws the texts around the picture, below the marker where that would lie under them. Returns where the next line
/// goes.
/// @param plane  of the picture; null if there is none
Rect draw_annotations(const Theme& theme, const Rect& panel, const std::string& patient, const Machine& machine,
                      const PlaneOnScreen* plane) {
  Rect line{panel.x + theme.px(16), panel.y + theme.px(12), panel.w * 0.27f, theme.px(24)};
  const std::array texts{machine.transducer().title + formatted(", %.1f MHz", machine.frequency_mhz),
                         "Depth " + depth_text(theme.look(), machine.depth_mm),
                         formatted("Gain %+.0f dB", machine.gain_db),
                         formatted("Range %.0f dB", machine.dynamic_range_db)};
  if (plane) {
    const float margin = theme.px(12);
    float width = std::min(text_width(theme.strong, patient), line.w), height = line.h;
    for (const std::string& text : texts) {
      width = std::max(width, text_width(theme.small_text, text));
      height += theme.px(19);
    }
    const ImVec2 dot = marker_dot(theme, *plane, machine.transducer());
    const bool covers = dot.x < line.x + width + margin && dot.y > line.y - margin && dot.y < line.y + height + margin;
    if (covers) line.y = dot.y + margin;
  }
  draw_on_plate(theme, line, theme.strong, colour::kText, patient);
  line.y += line.h;
  line.h = theme.px(19);
  for (const std::string& text : texts) {
    draw_on_plate(theme, line, theme.small_text, colour::kMuted, text);
    line.y += line.h;
  }
  if (settings_of(machine) != settings_of(with_usual_effects(machine))) {
    draw_on_plate(theme, line, theme.small_text, colour::kAmber, "Effects changed");
    line.y += line.h;
  }
  return line;
}

/// Says below the other texts, beside the fan, that the picture stands still or why the probe does.
void draw_state(const Theme& theme, const Rect& below, std::optional<double> lost_for_s, const std::string& state) {
  const std::string text =
      lost_for_s ? formatted("No usable pose for %.1f s: the picture stands still", *lost_for_s) : state;
  if (text.empty()) return;
  const float margin = theme.px(10), widest = std::max(below.w, theme.px(170)) - 2 * margin;
  const float width = std::min(text_width(theme.strong, text), widest);
  const float height = paragraph_height(theme.strong, text, width + 1);
  const Rect plate{below.x - theme.px(4), below.y + theme.px(6), width + 2 * margin, height + margin};
  fill(plate, lost_for_s ? colour::kAmber : colour::kAccentDark, theme.px(4));
  draw_paragraph({plate.x + margin, plate.y + margin / 2, width + 1, height}, theme.strong,
                 lost_for_s ? colour::kBackground : colour::kText, text);
}

/// Returns whether a frozen picture asks for something to be placed: for what the step demands, or without steps for
/// what the learner likes.
bool asks_to_place(const Session& session, const PictureTools& tools) {
  const Runner* runner = session.runner();
  const bool in_step = runner && !session.result() && !runner->live().finished;
  return !in_step || !tools.free_choice() || tools.in_hand();
}

/// @param prompts  whether it says what to do next
std::string state_text(const Session& session, const PictureTools& tools, bool prompts) {
  // While a button is down, as when the probe is dragged, the 3D view says it.
  if (session.stop() != Session::Stop::none && !ImGui::IsMouseDown(0)) return stop_words(session.stop());
  if (!session.machine().frozen) return session.looks_past_ct() ? "The CT ends here" : "";
  const bool asks = prompts && PictureTools::ready(session) && asks_to_place(session, tools);
  return asks ? "Frozen:  " + tool_prompt(tools) : "Frozen";
}

// Shows the tracker's problem in full. The tracker's own panel has room only for its beginning.
void draw_tracker_problem(const Theme& theme, const Rect& panel, const Session& session) {
  const TrackerState state = session.tracker_state();
  const bool stands_still = session.lost_for_s().has_value() && session.holder() == Holder::tracker;
  const std::string problem = !state.problem.empty() ? state.problem
                              : stands_still         ? rejection_advice(state)
                                                     : std::string();
  if (problem.empty()) return;
  const float width = std::min(panel.w * 0.6f, theme.px(560)), margin = theme.px(12);
  const float text = paragraph_height(theme.text, problem, width - 2 * margin);
  const float height = std::min(text + 2 * margin, panel.h * 0.5f);
  const Rect plate{panel.x + (panel.w - width) / 2, panel.y + panel.h - theme.px(58) - height, width, height};
  fill(plate, colour::kRaised, theme.px(4));
  draw_paragraph(plate.inset(margin, margin), theme.text, colour::kText, problem);
}

std::vector<ImVec2> outline_on_screen(const PlaneOnScreen& plane, const Probe& probe, double depth_mm) {
  std::vector<ImVec2> corners;
  for (const glm::dvec2& corner : view::fan_outline(probe, depth_mm)) corners.push_back(at(plane, corner));
  return corners;
}

constexpr float kEdge = 3;  // thickness of the line along the fan's edge

/// Covers the fan's edge by a smooth line of the background's colour: the picture has no half-covered pixels there, and
/// may have fewer pixels than the screen.
void smooth_edge(const std::vector<ImVec2>& outline) {
  ImGui::GetWindowDrawList()->AddPolyline(outline.data(), int(outline.size()), colour::kImage, ImDrawFlags_Closed,
                                          kEdge);
}

/// How far an outline reaches to the left and to the right; left is above right if it does not come there at all.
struct Reach {
  float left = std::numeric_limits<float>::max(), right = std::numeric_limits<float>::lowest();
};

/// Returns how far an outline reaches between two heights.
Reach reach_between(const std::vector<ImVec2>& outline, float top, float bottom) {
  Reach reach;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ImVec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    if (std::max(a.y, b.y) < top || std::min(a.y, b.y) > bottom) continue;
    for (const ImVec2& corner : {a, b}) {
      const float y = std::clamp(corner.y, top, bottom);
      const float x = y == corner.y ? corner.x : a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      reach.left = std::min(reach.left, x);
      reach.right = std::max(reach.right, x);
    }
  }
  return reach;
}

/// Draws the fan in two halves, each as wide as the fan is there. What lies beside them stays black, and a new picture
/// changes nothing there that would have to be drawn and shown again. More parts would not pay: a software renderer
/// takes as long for another part of the window as for some 20,000 pixels.
void draw_fan(const Rect& area, const gl::Texture& picture, const std::vector<ImVec2>& outline, bool mirrored,
              ImU32 tint) {
  const auto u = [&](float x) { return mirrored ? 1 - (x - area.x) / area.w : (x - area.x) / area.w; };
  const auto v = [&](float y) { return (y - area.y) / area.h; };
  const float middle = std::round(area.y + area.h / 2);
  for (const auto& [top, bottom] : {std::pair(area.y, middle), std::pair(middle, area.y + area.h)}) {
    const Reach reach = reach_between(outline, top - kEdge, bottom + kEdge);
    const float left = std::max(std::floor(reach.left - kEdge), area.x);
    const float right = std::min(std::ceil(reach.right + kEdge), area.x + area.w);
    if (left >= right) continue;
    ImGui::GetWindowDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(picture.name())), {left, top},
                                         {right, bottom}, {u(left), v(top)}, {u(right), v(bottom)}, tint);
  }
}

/// Draws the picture with its scales and annotations.
void draw_picture(const Theme& theme, const Rect& panel, const gl::Texture& picture, const Pictures& pictures,
                  const Machine& machine, const ShownAnnotations& annotations) {
  const Rect area = UltrasoundPanel::picture_area(theme, panel);
  const PlaneOnScreen plane = UltrasoundPanel::plane(theme, panel, pictures);
  const bool mirrored = theme.look().marker == MarkerSide::left;
  const std::vector<ImVec2> outline = outline_on_screen(plane, machine.transducer(), machine.depth_mm);
  draw_fan(area, picture, outline, mirrored, colour::of(theme.look().tint));
  smooth_edge(outline);
  draw_depth_scale(theme, panel, plane, machine.depth_mm);
  draw_marker(theme, plane, machine.transducer());
  const float bottom = draw_annotations(theme, panel, plane, annotations);
  draw_grey_scale(theme, panel, bottom, machine.dynamic_range_db);
}

/// Whether ImGui's last item was.
bool is_double_clicked() {
  return ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0);
}

void take_mouse(const Theme& theme, const Rect& area, Session& session, const PlaneOnScreen& plane,
                PictureTools& tools) {
  ImGui::SetCursorScreenPos(area.min());
  ImGui::InvisibleButton("ultrasound", {area.w, area.h});
  if (PictureTools::ready(session)) return take_pointer(theme, plane, session, tools);
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    session.turn_probe(0, 3.0 * io.MouseWheel, 0);
  }
  if (!ImGui::IsItemActive() || (io.MouseDelta.x == 0 && io.MouseDelta.y == 0)) return;
  constexpr double kDegPerPixel = 0.15;
  // The tissue follows the pointer, so the probe moves the other way: with the marker on the left that is +x.
  const double to_marker = theme.look().marker == MarkerSide::left ? 1 : -1;
  const glm::dvec2 mm = glm::dvec2(to_marker * io.MouseDelta.x, io.MouseDelta.y) / plane.pixels_per_mm();
  if (io.KeyShift)
    return session.turn_probe(kDegPerPixel * io.MouseDelta.y, 0, to_marker * kDegPerPixel * io.MouseDelta.x);
  session.move_probe([&](const ProbeHand& hand, const Pose& pose) { return hand.slide(pose, mm); });
}

}  // namespace

Rect UltrasoundPanel::picture_area(const Theme& theme, const Rect& panel) {
  return panel.inset(theme.px(44), theme.px(12));  // the depth's numbers lie beside it
}

PlaneOnScreen UltrasoundPanel::plane(const Theme& theme, const Rect& panel, const Pictures& pictures) {
  const Rect area = picture_area(theme, panel);
  return {{area.x, area.y}, {area.w, area.h}, pictures.geometry(), theme.look().marker == MarkerSide::right};
}

bool UltrasoundPanel::draw(const Theme& theme, const Rect& panel, Session& session, const Pictures& pictures,
                           PictureTools& tools, std::map<std::string, Rect>& places, bool is_saved) {
  bool double_clicked = false;
  fill(panel, colour::kImage, theme.px(4));
  const Rect area = picture_area(theme, panel);
  const PlaneOnScreen plane = UltrasoundPanel::plane(theme, panel, pictures);
  if (const gl::Texture* picture = pictures.ultrasound()) {
    draw_picture(theme, panel, *picture, pictures, session.machine(), shown_annotations(session, tools));
    // Before the picture's own item, which lies below. Nobody wants buttons in a picture that is saved.
    if (!is_saved) draw_picture_tools(theme, panel, session, tools, places);
    if (!is_saved) take_mouse(theme, area, session, plane, tools);
    double_clicked = !is_saved && is_double_clicked() && !PictureTools::ready(session);
  } else {
    draw_text(panel, theme.text, colour::kFaint, "Waiting for the probe", Align::centre);
  }
  Rect below = draw_annotations(theme, panel, session.loaded_case().subject.name, session.machine(),
                                pictures.ultrasound() ? &plane : nullptr);
  if (!session.event_markers_s().empty()) {
    draw_on_plate(theme, below, theme.small_text, colour::kAccent, mark_text(session));
    below.y += below.h;
  }
  draw_mark(theme, panel, session);
  draw_state(theme, below, session.lost_for_s(), state_text(session, tools, !is_saved));
  draw_tracker_problem(theme, panel, session);
  return double_clicked;
}

bool UltrasoundPanel::draw_still(const Theme& theme, const Rect& panel, const std::string& patient,
                                 const Machine& machine, const ShownAnnotations& annotations,
                                 std::optional<double> lost_for_s, const Pictures& pictures) {
  fill(panel, colour::kImage, theme.px(4));
  if (const gl::Texture* picture = pictures.ultrasound())
    draw_picture(theme, panel, *picture, pictures, machine, annotations);
  else
    draw_text(panel, theme.text, colour::kFaint, "No pose has come yet", Align::centre);
  const PlaneOnScreen plane = UltrasoundPanel::plane(theme, panel, pictures);
  const Rect below = draw_annotations(theme, panel, patient, machine, pictures.ultrasound() ? &plane : nullptr);
  draw_state(theme, below, lost_for_s, machine.frozen ? "Frozen" : "");
  ImGui::SetCursorScreenPos(panel.min());
  ImGui::InvisibleButton("ultrasound", {panel.w, panel.h});
  return is_double_clicked();
}

}  // namespace insonate::ui
