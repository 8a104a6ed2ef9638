#include "app/panels/guide_layer.h"

#include <algorithm>
#include <array>

#include "app/panels/space_drawing.h"
#include "scenarios/words.h"

namespace insonate::ui {

void draw_ghost(const Theme& theme, const Rect& space, const Guiding& guiding, const view::OrbitCamera& camera) {
  const SpaceDrawing drawing(space, camera);
  const ReferenceView& view = *guiding.view;
  const Probe* probe = find_probe(view.probe);
  if (!probe) return;
  drawing.fan(view.patient_from_probe, *probe, view.depth_mm, colour::kText, IM_COL32(232, 236, 240, 44));
  // A stroke along the handle shows on which side of the plane the probe is.
  const std::array<glm::dvec3, 2> handle{view.patient_from_probe.point({0, 0, 0}),
                                         view.patient_from_probe.point({0, -80, 0})};
  drawing.path(handle, colour::kText, theme.px(2));
}

Rect draw_advice(const Theme& theme, const Rect& ultrasound, const Guiding& guiding) {
  constexpr std::size_t kMost = 4;
  const std::size_t lines = std::clamp<std::size_t>(guiding.advice.size(), 1, kMost);
  const float row = theme.px(21), margin = theme.px(12), height = row * float(lines + 1) + theme.px(18 + 16 + 4);
  float width = theme.px(300);
  for (const std::string& advice : guiding.advice)
    width = std::max(width, text_width(theme.text, advice) + 2 * margin + theme.px(2));
  const Rect plate{ultrasound.x + theme.px(16), ultrasound.y + ultrasound.h - height - theme.px(14),
                   std::min(width, ultrasound.w - theme.px(32)), height};
  fill(plate, IM_COL32(18, 22, 27, 225), theme.px(4));
  outline(plate, guiding.there ? colour::kAccent : colour::kLine, theme.px(4));
  Rect rest = plate.inset(margin, theme.px(8));
  draw_text(rest.take_top(row), theme.strong, colour::kText,
            guiding.view->title.empty() ? guiding.view->name : guiding.view->title);
  draw_text(
      rest.take_bottom(theme.px(18)), theme.small_text, colour::kMuted,
      "Plane " + fixed(guiding.plane_distance_mm, 0) + " mm and " + fixed(guiding.plane_angle_deg, 0) + "\u00b0 off");
  if (guiding.there) draw_text(rest.take_top(row), theme.text, colour::kAccent, "Here it is. Hold still.");
  for (std::size_t i = 0; i < std::min(guiding.advice.size(), kMost); ++i)
    draw_text(rest.take_top(row), theme.text, i == 0 ? colour::kText : colour::kMuted, guiding.advice[i]);
  return plate;
}

}  // namespace insonate::ui
