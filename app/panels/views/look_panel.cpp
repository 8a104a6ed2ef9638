#include "app/panels/views/look_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "app/panels/scan/picture_plates.h"
#include "app/panels/widgets/scroll_area.h"
#include "sim/view/body/tissue_classes.h"

namespace insonate::ui {
namespace {

// What a CT of the trunk contains. Points above stay at the right edge.
constexpr double kLeft_hu = view::kFirstTransfer_hu, kRight_hu = 1600;

// Tissue's opacity of 1 mm is small except at surfaces: the graph gives the lower tenth a third of its height.
double height_of(double opacity) {
  return std::sqrt(std::clamp(opacity / view::kMaxOpacity, 0.0, 1.0));
}
double opacity_at(double height) {
  return view::kMaxOpacity * std::clamp(height, 0.0, 1.0) * std::clamp(height, 0.0, 1.0);
}

constexpr double kMaxShift_hu = 300, kMinScale = 0.25, kMaxScale = 4;

// Colours of tissue, from air to bone, and some that stand out.
constexpr std::array<glm::dvec3, 10> kColours{{{0.93, 0.80, 0.72},
                                               {0.85, 0.64, 0.54},
                                               {0.74, 0.33, 0.27},
                                               {0.80, 0.16, 0.12},
                                               {0.93, 0.62, 0.44},
                                               {0.95, 0.90, 0.80},
                                               {0.62, 0.70, 0.82},
                                               {0.36, 0.62, 0.85},
                                               {0.45, 0.75, 0.45},
                                               {0.90, 0.80, 0.35}}};

ImU32 ink_of(const glm::dvec3& colour, double alpha = 1) {
  return ImGui::GetColorU32(ImVec4(float(colour.r), float(colour.g), float(colour.b), float(alpha)));
}

float x_of(const Rect& graph, double hu) {
  return graph.x + graph.w * float(std::clamp((hu - kLeft_hu) / (kRight_hu - kLeft_hu), 0.0, 1.0));
}
float y_of(const Rect& graph, double opacity) {
  return graph.y + graph.h * float(1 - height_of(opacity));
}

void draw_histogram(const Rect& graph, const std::vector<float>& bins) {
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double hu = view::kFirstTransfer_hu + double(i) * PatientLook::kBin_hu;
    if (hu >= kRight_hu) break;
    const float left = x_of(graph, hu), right = x_of(graph, hu + PatientLook::kBin_hu);
    fill({left, graph.y + graph.h * (1 - bins[i]), right - left, graph.h * bins[i]}, colour::kHovered);
  }
}

/// Draws the function's colours below its curve.
void draw_curve(const Theme& theme, const Rect& graph, const view::TransferFunction& function) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  constexpr int kParts = 160;
  for (int i = 0; i < kParts; ++i) {
    const double hu = kLeft_hu + (kRight_hu - kLeft_hu) * (i + 0.5) / kParts;
    const view::TransferPoint at = function.at(hu);
    // On whole pixels, so that neighbours neither overlap nor leave gaps.
    const float left = std::round(graph.x + graph.w * float(i) / kParts),
                right = std::round(graph.x + graph.w * float(i + 1) / kParts), top = y_of(graph, at.opacity);
    if (at.opacity > 0) fill({left, top, right - left, graph.y + graph.h - top}, ink_of(at.colour, 0.55));
  }
  ImVec2 before{graph.x, y_of(graph, function.points.front().opacity)};
  for (int i = 1; i <= kParts; ++i) {
    const double hu = kLeft_hu + (kRight_hu - kLeft_hu) * i / kParts;
    const ImVec2 next{graph.x + graph.w * float(i) / kParts, y_of(graph, function.at(hu).opacity)};
    list->AddLine(before, next, colour::kText, theme.px(1.5f));
    before = next;
  }
}

void draw_scale(const Theme& theme, const Rect& below) {
  for (const int hu : {-1000, -500, 0, 500, 1000}) {
    const float x = x_of(below, hu);
    char text[16];
    std::snprintf(text, sizeof text, "%d", hu);
    draw_text({x - theme.px(30), below.y, theme.px(60), below.h}, theme.small_text, colour::kFaint, text,
              hu == -1000 ? Align::right : Align::centre);
  }
  draw_text({below.x + below.w - theme.px(26), below.y, theme.px(26), below.h}, theme.small_text, colour::kFaint, "HU",
            Align::right);
}

}  // namespace

void LookPanel::draw_graph(const Theme& theme, const Rect& graph, PatientLook& look,
                           std::map<std::string, Rect>& places) {
  fill(graph, colour::kBackground, theme.px(3));
  if (!look.shown())
    return draw_text(graph, theme.text, colour::kMuted, "Surfaces have no curve to edit: choose another look",
                     Align::centre);
  draw_histogram(graph, look.histogram());
  draw_curve(theme, graph, *look.shown());
  places["look_graph"] = graph;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto hu_at = [&](float x) { return kLeft_hu + (kRight_hu - kLeft_hu) * double((x - graph.x) / graph.w); };
  const auto opacity_of = [&](float y) { return opacity_at(double(1 - (y - graph.y) / graph.h)); };
  const float radius = theme.px(8);
  bool on_point = false;
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < look.shown()->points.size(); ++i) {
    const view::TransferPoint& point = look.shown()->points[i];
    const ImVec2 at{x_of(graph, point.hu), y_of(graph, point.opacity)};
    const Rect grip{at.x - radius, at.y - radius, 2 * radius, 2 * radius};
    const std::string id = "look_point" + std::to_string(i);
    places[id] = grip;
    ImGui::SetCursorScreenPos(grip.min());
    ImGui::InvisibleButton(id.c_str(), {grip.w, grip.h},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    on_point = on_point || hovered || ImGui::IsItemActive();
    if (ImGui::IsItemActivated()) point_ = i;
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) removed = i;
    if (ImGui::IsItemActive() && ImGui::GetIO().MouseDown[0] &&
        (ImGui::GetIO().MouseDelta.x != 0 || ImGui::GetIO().MouseDelta.y != 0))
      look.move_point(i, hu_at(mouse.x), opacity_of(mouse.y));
    if (!ImGui::IsItemActive()) draw_tip(theme, grip, "Drag to move the point. The right button removes it.");
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddCircleFilled(at, theme.px(hovered ? 6.0f : 5.0f), ink_of(point.colour), 20);
    list->AddCircle(at, theme.px(hovered ? 6.0f : 5.0f), point_ == i ? colour::kAccent : colour::kText, 20,
                    theme.px(point_ == i ? 2.0f : 1.2f));
  }
  if (removed) {
    look.remove_point(*removed);
    point_.reset();
  }
  // Behind the points, so that these take the pointer first.
  ImGui::SetCursorScreenPos(graph.min());
  ImGui::InvisibleButton("look_graph", {graph.w, graph.h});
  if (!on_point && ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
    if (const auto added = look.add_point(hu_at(mouse.x), opacity_of(mouse.y))) point_ = added;
  if (!on_point) draw_tip(theme, graph, "Opacity by Hounsfield unit. A double click adds a point.");
}

void LookPanel::draw_colours(const Theme& theme, const Rect& where, PatientLook& look,
                             std::map<std::string, Rect>& places) const {
  const std::size_t per_row = kColours.size() / 2;
  const float gap = theme.px(4), wide = (where.w - gap * float(per_row - 1)) / float(per_row),
              high = (where.h - gap) / 2;
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    const std::size_t row = i / per_row, column = i % per_row;
    const Rect swatch{where.x + float(column) * (wide + gap), where.y + float(row) * (high + gap), wide, high};
    const std::string id = "look_colour" + std::to_string(i);
    places[id] = swatch;
    ImGui::SetCursorScreenPos(swatch.min());
    if (ImGui::InvisibleButton(id.c_str(), {swatch.w, swatch.h}) && point_) look.colour_point(*point_, kColours[i]);
    fill(swatch, ink_of(kColours[i], point_ ? 1 : 0.35), theme.px(3));
    if (point_ && look.shown()->points[*point_].colour == kColours[i])
      outline(swatch, colour::kText, theme.px(3), theme.px(2));
    draw_tip(theme, swatch, point_ ? "Gives the chosen point this colour" : "Choose a point first: click on it");
  }
}

void LookPanel::draw_structures(const Theme& theme, const Rect& where, PatientLook& look,
                                std::map<std::string, Rect>& places) const {
  const float height = theme.px(20);
  Rect list = where;
  draw_text(list.take_top(height), theme.small_text, colour::kMuted, "Structures");
  const ScrollArea area(theme, "look_structures", whole_rows(list, height), height * float(look.structures().size()));
  for (std::size_t i = 0; i < look.structures().size(); ++i) {
    const StructureChoice& structure = look.structures()[i];
    Rect row{area.content().x, area.content().y + height * float(i), area.content().w, height};
    if (!area.shows(row)) continue;
    const std::string id = "structure_" + std::to_string(structure.label);
    if (area.shows_all_of(row)) places[id] = row;
    ImGui::SetCursorScreenPos(row.min());
    if (ImGui::InvisibleButton(id.c_str(), {row.w, row.h})) look.show_structure(i, !structure.shown);
    if (ImGui::IsItemHovered()) fill(row, colour::kHovered, theme.px(3));
    draw_tip(theme, row, "Shows its surface within the CT");
    Rect swatch = row.take_left(theme.px(24)).inset(theme.px(5), theme.px(4));
    const glm::dvec3 ink(structure.colour);
    if (structure.shown)
      fill(swatch, ink_of(ink), theme.px(3));
    else
      outline(swatch, ink_of(ink, 0.8), theme.px(3), theme.px(1.5f));
    draw_text(row, theme.small_text, structure.shown ? colour::kText : colour::kMuted, structure.title);
  }
}

LookAnswer LookPanel::draw(const Theme& theme, const Rect& panel, PatientLook& look,
                           std::map<std::string, Rect>& places) {
  LookAnswer answer = LookAnswer::none;
  places["look_panel"] = panel;
  fill(panel, colour::kPanel, theme.px(4));
  Rect rest = panel.inset(theme.px(10), theme.px(8));
  const float gap = theme.px(6), high = theme.px(26);

  Rect title = rest.take_top(high);
  if (button(theme, "look_close", places["look_close"] = title.take_right(high), "\u00d7", ButtonKind::normal, true,
             "Closes this panel  (K)"))
    answer = LookAnswer::close;
  title.take_right(gap);
  if (button(theme, "look_open", places["look_open"] = title.take_right(theme.px(64)), "Open", ButtonKind::normal, true,
             "Takes a transfer function from a file"))
    answer = LookAnswer::open;
  title.take_right(gap);
  if (button(theme, "look_save", places["look_save"] = title.take_right(theme.px(64)), "Save",
             look.is_edited() ? ButtonKind::primary : ButtonKind::normal, look.shown().has_value(),
             "Offers this look from now on, and writes it to a file"))
    answer = LookAnswer::save;
  draw_text(title, theme.strong, colour::kText, "How the patient looks");
  rest.take_top(gap);

  // The looks, in rows that fill the width.
  const std::size_t count = look.offered().size() + 1;
  float widest = 0;
  for (const view::TransferFunction& offered : look.offered())
    widest = std::max(widest, text_width(theme.text, offered.name + " *"));
  const std::size_t per_row = std::max<std::size_t>(2, std::size_t((rest.w + gap) / (widest + theme.px(16) + gap)));
  for (std::size_t first = 0; first < count; first += per_row) {
    Rect row = rest.take_top(high);
    rest.take_top(theme.px(4));
    const float width = (row.w - gap * float(per_row - 1)) / float(per_row);
    for (std::size_t i = first; i < std::min(first + per_row, count); ++i) {
      const std::optional<std::size_t> index = i == 0 ? std::nullopt : std::optional(i - 1);
      const std::string id = "look" + std::to_string(i);
      const bool chosen = look.chosen() == index;
      std::string name = index ? look.offered()[*index].name : view::kSurfaces;
      if (chosen && look.is_edited()) name += " *";
      if (button(theme, id.c_str(), places[id] = row.take_left(width), name,
                 chosen ? ButtonKind::chosen : ButtonKind::normal, true,
                 index ? "Shows the CT itself with this transfer function; organs and vessels need contrast medium"
                       : "Shows labelled organs and bone as surfaces, and the skin as glass")) {
        look.choose(index);
        point_.reset();
      }
      row.take_left(gap);
    }
  }
  rest.take_top(theme.px(4));
  if (!look.shown() || (point_ && *point_ >= look.shown()->points.size())) point_.reset();
  if (look.shown()) {
    const float column = theme.px(look.structures().empty() ? 124 : 164);
    Rect sliders = rest.take_bottom(theme.px(40));
    rest.take_bottom(gap);
    draw_colours(theme, sliders.take_right(column), look, places);
    sliders.take_right(theme.px(16));
    if (!look.structures().empty()) {
      draw_structures(theme, rest.take_right(column), look, places);
      rest.take_right(theme.px(16));
    }
    Rect left = sliders.take_left((sliders.w - theme.px(20)) / 2);
    sliders.take_left(theme.px(20));
    char text[32];
    double shift = look.shift_hu(), doublings = std::log2(look.scale_factor());
    std::snprintf(text, sizeof text, "%+.0f HU", shift);
    if (slider(theme, "look_shift", places["look_shift"] = left, "Threshold", text, shift, -kMaxShift_hu, kMaxShift_hu,
               5, 0, true, "Moves the whole function. A double click takes it back."))
      look.shift(shift);
    std::snprintf(text, sizeof text, "%.0f %%", 100 * look.scale_factor());
    if (slider(theme, "look_scale", places["look_scale"] = sliders, "Width", text, doublings, std::log2(kMinScale),
               std::log2(kMaxScale), 0.05, 0, true, "Widens or narrows the function. A double click takes it back."))
      look.scale(std::exp2(doublings));
  }
  draw_scale(theme, rest.take_bottom(theme.px(16)));
  draw_graph(theme, rest, look, places);
  return answer;
}

}  // namespace insonate::ui
