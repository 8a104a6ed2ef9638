#include "app/panels/views/ct_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/panels/scan/picture_plates.h"
#include "sim/core/text.h"
#include "sim/view/plane_trace.h"

namespace insonate::ui {
namespace {

std::optional<view::SliceAxis> axis_of(View view) {
  switch (view) {
    case View::axial:
      return view::SliceAxis::axial;
    case View::coronal:
      return view::SliceAxis::coronal;
    case View::sagittal:
      return view::SliceAxis::sagittal;
    default:
      return std::nullopt;
  }
}

std::string title_of(View view, const Pictures& pictures) {
  if (view == View::slice) return "CT in this plane";
  if (view == View::blend) return "CT and ultrasound";
  struct Name {
    const char *title, *plus, *minus;
  };
  static constexpr std::array<Name, 3> kNames{{{"Axial", "to the head", "to the feet"},
                                               {"Coronal", "to the back", "to the front"},
                                               {"Sagittal", "to the left", "to the right"}}};
  const Name& name = kNames[std::size_t(*axis_of(view))];
  const double offset_mm = pictures.slice_offset_mm(*axis_of(view));
  if (offset_mm == 0) return name.title;
  return formatted("%s, %.0f mm %s", name.title, std::abs(offset_mm), offset_mm > 0 ? name.plus : name.minus);
}

std::string grey_text(const WindowLevel& grey) {
  return formatted("W %.0f  L %s%.0f", grey.window_hu, grey.level_hu < 0 ? "\u2212" : "", std::abs(grey.level_hu));
}

/// Draws a picture over the panel, with the marker on the same side as in the ultrasound. Crops its sides, which the
/// fan hardly reaches, and a little of its ends rather than leaving bars. Returns its letters.
view::EdgeLetters draw_like_ultrasound(const Theme& theme, const Rect& panel, const gl::Texture& picture,
                                       const Pictures& pictures) {
  constexpr float kCropped = 0.1f;  // of the fan's width or height, at most
  const float width = float(picture.width()), height = float(picture.height());
  const float filling = std::max(panel.w / width, panel.h / height);
  const float fan = float(pictures.fan_share());
  const float scale =
      std::min({filling, panel.h / (height * (1 - kCropped)), panel.w / (width * fan * (1 - kCropped))});
  const float w = std::min(width * scale, panel.w), h = std::min(height * scale, panel.h);
  const Rect area{panel.x + (panel.w - w) / 2, panel.y + (panel.h - h) / 2, w, h};
  const float across = w / (width * scale), down = h / (height * scale);  // shares that are shown
  const bool marker_left = theme.look().marker == MarkerSide::left;
  const float left = marker_left ? (1 + across) / 2 : (1 - across) / 2, top = (1 - down) / 2;
  ImGui::GetWindowDrawList()->AddImage(id_of(picture), area.min(), area.max(), {left, top}, {1 - left, 1 - top});
  const glm::dmat3& r = pictures.plane().patient_from_probe.rotation;
  return view::edge_letters(marker_left ? -r[0] : r[0], r[1]);
}

/// Draws lines in an axis slice.
class SliceDrawing {
public:
  SliceDrawing(const Rect& panel, const view::AxisSlice& slice)
      : panel_(panel), slice_(slice), scale_(panel.w / float(slice.width), panel.h / float(slice.height)) {
    ImGui::GetWindowDrawList()->PushClipRect(panel.min(), panel.max(), true);
  }
  ~SliceDrawing() { ImGui::GetWindowDrawList()->PopClipRect(); }
  SliceDrawing(const SliceDrawing&) = delete;
  SliceDrawing& operator=(const SliceDrawing&) = delete;

  ImVec2 at(const glm::dvec2& pixel) const {
    return {panel_.x + float(pixel.x) * scale_.x, panel_.y + float(pixel.y) * scale_.y};
  }
  void line(const view::PixelLine& ends, ImU32 colour, float thickness) const {
    ImGui::GetWindowDrawList()->AddLine(at(ends[0]), at(ends[1]), colour, thickness);
  }

  /// Draws where a probe's plane crosses the slice, brighter inside the fan.
  void trace(const Pose& pose, const Probe& probe, double depth_mm, ImU32 ink, ImU32 faint, float thickness) const {
    const view::PlaneTrace trace = view::trace_of_plane(slice_, pose, probe, depth_mm);
    if (trace.line) line(*trace.line, faint, thickness / 2);
    for (const view::PixelLine& part : trace.in_fan) line(part, ink, thickness);
    for (const glm::dvec2& point : trace.outline) ImGui::GetWindowDrawList()->PathLineTo(at(point));
    ImGui::GetWindowDrawList()->PathStroke(ink, ImDrawFlags_Closed, thickness);
  }

  /// Draws lines across the picture that leave its crossing free.
  void cross_hair(const glm::dvec2& pixel, float gap, ImU32 ink) const {
    const ImVec2 p = at(pixel);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddLine({panel_.x, p.y}, {p.x - gap, p.y}, ink);
    list->AddLine({p.x + gap, p.y}, {panel_.x + panel_.w, p.y}, ink);
    list->AddLine({p.x, panel_.y}, {p.x, p.y - gap}, ink);
    list->AddLine({p.x, p.y + gap}, {p.x, panel_.y + panel_.h}, ink);
  }

private:
  Rect panel_;
  const view::AxisSlice& slice_;
  ImVec2 scale_;
};

/// Draws a slice along an axis, with the plane's trace and where the other slices lie. Returns its letters.
view::EdgeLetters draw_axis_slice(const Theme& theme, const Rect& panel, view::SliceAxis axis,
                                  const gl::Texture& picture, const Pictures& pictures, const Guiding* guiding) {
  using view::SliceAxis;
  constexpr ImU32 kFaintAccent = IM_COL32(74, 190, 204, 110), kFaintText = IM_COL32(232, 236, 240, 90),
                  kHair = IM_COL32(255, 255, 255, 70);
  const view::AxisSlice& slice = pictures.axis_geometry(axis);
  ImGui::GetWindowDrawList()->AddImage(id_of(picture), panel.min(), panel.max());
  const SliceDrawing drawing(panel, slice);
  const glm::dvec3 centre = pictures.cross_hair();
  glm::dvec3 crossing = centre;
  for (const SliceAxis each : {SliceAxis::axial, SliceAxis::coronal, SliceAxis::sagittal})
    crossing[view::normal_axis(each)] += pictures.slice_offset_mm(each);
  drawing.cross_hair(slice.pixel(crossing), theme.px(8), kHair);
  if (guiding)
    if (const Probe* probe = find_probe(guiding->view->probe))
      drawing.trace(guiding->view->patient_from_probe, *probe, guiding->view->depth_mm, colour::kText, kFaintText,
                    theme.px(1.5f));
  const view::UltrasoundPlane& plane = pictures.plane();
  drawing.trace(plane.patient_from_probe, plane.probe, pictures.depth_mm(), colour::kAccent, kFaintAccent, theme.px(2));
  ImGui::GetWindowDrawList()->AddCircle(drawing.at(slice.pixel(centre)), theme.px(4), colour::kAccent, 20,
                                        theme.px(1.5f));
  const glm::dmat3 directions = slice.patient_from_picture().rotation;
  return view::edge_letters(directions[0], directions[1]);
}

/// Draws the slider from the CT to the ultrasound, and the choice of the ultrasound's colour, along the lower edge.
void draw_blend_controls(const Theme& theme, const Rect& strip, Pictures& pictures, CtLook& look,
                         std::map<std::string, Rect>& places) {
  fill(strip, colour::kPlate);
  Rect row = strip.inset(theme.px(8), theme.px(2));
  struct Swatch {
    BlendColour colour;
    ImU32 ink;
    const char *id, *tip;
  };
  static constexpr std::array<Swatch, 3> kSwatches{{
      {BlendColour::green, IM_COL32(115, 255, 140, 255), "blend_green", "The ultrasound in green over the grey CT"},
      {BlendColour::amber, IM_COL32(255, 184, 76, 255), "blend_amber", "The ultrasound in amber over the grey CT"},
      {BlendColour::grey, IM_COL32(230, 230, 230, 255), "blend_grey", "CT and ultrasound in grey"},
  }};
  for (const Swatch& swatch : kSwatches) {
    const Rect place = places[swatch.id] = row.take_right(theme.px(20));
    ImGui::SetCursorScreenPos(place.min());
    if (ImGui::InvisibleButton(swatch.id, {place.w, place.h})) look.blend_colour = swatch.colour;
    draw_tip(theme, place, swatch.tip);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddCircleFilled(place.centre(), theme.px(5), swatch.ink, 20);
    if (look.blend_colour == swatch.colour)
      list->AddCircle(place.centre(), theme.px(8), colour::kText, 24, theme.px(1.5f));
  }
  row.take_right(theme.px(8));
  places["blend_slider"] = row;
  ImGui::SetCursorScreenPos(row.min());
  ImGui::InvisibleButton("blend_slider", {row.w, row.h});
  if (!ImGui::IsItemActive()) draw_tip(theme, row, "More of the CT on the left, more of the ultrasound on the right");
  if (ImGui::IsItemActive())
    pictures.blend_share = std::clamp(double(ImGui::GetIO().MousePos.x - row.x) / row.w, 0.0, 1.0);
  const float y = row.y + row.h / 2, x = row.x + float(pictures.blend_share) * row.w;
  fill({row.x, y - theme.px(1.5f), row.w, theme.px(3)}, colour::kHovered, theme.px(1.5f));
  ImGui::GetWindowDrawList()->AddCircleFilled({x, y}, theme.px(6), colour::kAccent, 20);
}

}  // namespace

void CtPanel::draw_menu(const Theme& theme, const Rect& button_place, View view, CtLook& look, bool has_labels,
                        std::map<std::string, Rect>& places) {
  shown_in_ = ImGui::GetFrameCount();
  const float row = theme.px(26);
  const bool axis = axis_of(view).has_value();
  Rect menu{button_place.x, 0, theme.px(196), row * float(kWindowPresets.size() + 1 + axis) + theme.px(8)};
  menu.y = button_place.y - theme.px(4) - menu.h;
  places["ct_menu"] = menu;
  if (ImGui::IsMouseClicked(0) && !ImGui::IsMouseHoveringRect(menu.min(), menu.max()) &&
      !ImGui::IsMouseHoveringRect(button_place.min(), button_place.max()))
    menu_.reset();
  fill(menu, colour::kPanel, theme.px(4));
  outline(menu, colour::kLine, theme.px(4));
  Rect rest = menu.inset(theme.px(4), theme.px(4));
  const auto next = [&](const std::string& id, const std::string& text, bool chosen, const char* tip = "",
                        bool enabled = true) {
    const Rect place = places[id] = rest.take_top(row).inset(0, theme.px(1));
    return button(theme, id.c_str(), place, text, chosen ? ButtonKind::chosen : ButtonKind::normal, enabled, tip);
  };
  for (std::size_t i = 0; i < kWindowPresets.size(); ++i) {
    const WindowPreset& preset = kWindowPresets[i];
    if (!next("ct_preset_" + std::to_string(i), std::string(preset.name) + ",  " + grey_text(preset.grey),
              look.grey == preset.grey))
      continue;
    look.grey = preset.grey;
    menu_.reset();
  }
  if (!has_labels)
    next("ct_outlines", "Outlines of organs", false, "This patient has no labels to outline", false);
  else if (next("ct_outlines", look.outlines ? "Outlines of organs: on" : "Outlines of organs: off", look.outlines,
                "Draws the edges of labelled organs in all CT pictures  (O)"))
    look.outlines = !look.outlines;
  if (axis &&
      next("ct_cross", look.cross_hair == CrossHair::face ? "Cross: the probe's face" : "Cross: the fan's middle",
           look.cross_hair == CrossHair::face, "Where the three slices cross  (X)"))
    look.cross_hair = look.cross_hair == CrossHair::face ? CrossHair::fan : CrossHair::face;
  // Takes the clicks between the rows, which would change the picture below.
  ImGui::SetCursorScreenPos(menu.min());
  ImGui::InvisibleButton("ct_menu", {menu.w, menu.h});
}

Rect CtPanel::draw_grey_button(const Theme& theme, View view, const Rect& picture, CtLook& look, bool has_labels,
                               std::map<std::string, Rect>& places) {
  const std::string text = grey_text(look.grey);
  const float height = theme.px(24), margin = theme.px(4);
  const Rect place{picture.x + margin, picture.y + picture.h - margin - height,
                   text_width(theme.text, text) + theme.px(14), height};
  places[std::string("grey_") + name_of(view)] = place;
  if (menu_ == view) draw_menu(theme, place, view, look, has_labels, places);
  if (button(theme, "grey", place, text, menu_ == view ? ButtonKind::chosen : ButtonKind::normal, true,
             menu_ == view ? ""
                           : "Window and level of the CT, in Hounsfield units. Drag in the picture: across changes "
                             "the window, up and down the level. Click for the usual ones."))
    menu_ = menu_ == view ? std::nullopt : std::optional(view);
  return place;
}

bool CtPanel::draw(const Theme& theme, View view, const Rect& panel, Pictures& pictures, CtLook& look,
                   const Guiding* guiding, std::map<std::string, Rect>& places) {
  fill(panel, colour::kImage, theme.px(4));
  const std::optional<view::SliceAxis> axis = axis_of(view);
  const gl::Texture* picture = axis                  ? pictures.axis_slice(*axis)
                               : view == View::blend ? pictures.blend()
                                                     : pictures.slice();
  if (!picture) {
    draw_title(theme, panel, title_of(view, pictures));
    return false;
  }
  ImGui::PushID(name_of(view));
  Rect area = panel;
  const view::EdgeLetters letters = axis ? draw_axis_slice(theme, area, *axis, *picture, pictures, guiding)
                                         : draw_like_ultrasound(theme, area, *picture, pictures);
  if (view == View::blend) draw_blend_controls(theme, area.take_bottom(theme.px(24)), pictures, look, places);
  const Rect title = draw_title(theme, area, title_of(view, pictures));
  const float grey_width = text_width(theme.text, grey_text(look.grey)) + theme.px(14);
  draw_edge_letters(theme, area, letters, title, {area.x + theme.px(4), area.y, grey_width, 0});
  if (axis && pictures.slice_offset_mm(*axis) != 0) {
    const Rect place = places["to_probe"] = {area.x + area.w - theme.px(104), area.y + area.h - theme.px(28),
                                             theme.px(100), theme.px(24)};
    if (button(theme, "to_probe", place, "To the probe", ButtonKind::normal, true,
               "Moves all slices back to where the cross follows the probe  (B)"))
      pictures.slices_to_cross_hair();
  }
  draw_grey_button(theme, view, area, look, pictures.has_labels(), places);

  ImGui::SetCursorScreenPos(area.min());
  ImGui::InvisibleButton("picture", {area.w, area.h});
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActivated()) held_ = look.grey;
  if (held_ && ImGui::IsItemActive() && ImGui::IsMouseDragging(0)) {
    const ImVec2 by = ImGui::GetMouseDragDelta(0);
    const double scale = theme.px(1);
    look.grey = dragged(*held_, {by.x / scale, by.y / scale});
  }
  if (axis && ImGui::IsItemHovered() && io.MouseWheel != 0) {
    wheel_ += io.MouseWheel;
    pictures.move_slice(*axis, int(wheel_));
    wheel_ -= std::trunc(wheel_);
  }
  const bool double_clicked = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0);
  ImGui::PopID();
  return double_clicked;
}

}  // namespace insonate::ui
