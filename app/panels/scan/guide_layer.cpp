#include "app/panels/scan/guide_layer.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "app/panels/views/space_drawing.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr float kGuideRow = 22, kBetween = 16, kKeyGap = 8;

float key_width(const Theme& theme, const std::string& key) {
  return text_width(theme.small_text, key) + theme.px(14);
}

/// Draws a key as its cap, and takes its place off the left of `rest`.
void draw_key(const Theme& theme, Rect& rest, ImU32 ink, const std::string& key) {
  rest.take_left(theme.px(kKeyGap));
  const float width = key_width(theme, key);
  const Rect cap = rest.take_left(width).inset(0, theme.px(1));
  fill(cap, colour::kRaised, theme.px(4));
  outline(cap, colour::kFaint, theme.px(4));
  draw_text(cap, theme.small_text, ink, key, Align::centre);
}

}  // namespace

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

float guide_strip_height(const Theme& theme) {
  return theme.px(2 * kMargin + 2 * kGuideRow);
}

std::size_t draw_guide_strip(const Theme& theme, const Rect& strip, const Guiding& guiding, bool counted) {
  fill(strip, colour::kPanel, theme.px(4));
  if (guiding.there) outline(strip, colour::kAccent, theme.px(4));
  Rect rest = strip.inset(theme.px(16), theme.px(kMargin));
  Rect head = rest.take_top(theme.px(kGuideRow));
  const std::string title = "Guide: " + (guiding.view->title.empty() ? guiding.view->name : guiding.view->title);
  draw_text(head.take_left(std::min(head.w, text_width(theme.strong, title))), theme.strong, colour::kText, title);
  head.take_left(theme.px(16));
  // Far away the planes' distance means little: two planes may be near where the probes are not.
  std::string facts = guiding.slides ? ""
                                     : "plane " + fixed(guiding.plane_distance_mm, 0) + " mm and " +
                                           fixed(guiding.plane_angle_deg, 0) + "\u00b0 off";
  facts += facts.empty() ? "" : "; ";
  facts += counted ? "costs no points, but the report says how long it was shown"
                   : "G leads to the next view, and after the last to none";
  draw_text(head, theme.text, colour::kMuted, facts);
  if (guiding.there) {
    draw_text(rest, theme.text, colour::kAccent, "Here it is. Hold still.");
    return 0;
  }
  const auto draw = [&](ImFont* font, ImU32 ink, const std::string& text) {
    draw_text(rest.take_left(std::min(rest.w, text_width(font, text) + 1)), font, ink, text);
  };
  for (std::size_t i = 0; i < guiding.advice.size(); ++i) {
    const float key = i < guiding.keys.size() ? theme.px(kKeyGap) + key_width(theme, guiding.keys[i]) : 0;
    const bool is_last = i + 1 == guiding.advice.size();
    std::string advice = guiding.advice[i];
    if (i > 0) advice.front() = char(std::tolower(static_cast<unsigned char>(advice.front())));
    const float needed = text_width(theme.text, "then " + advice) + 2 + key +
                         (is_last ? 0 : theme.px(kBetween) + text_width(theme.text, "\u2026"));
    // One comes after the other, so what has no room comes later.
    if (i > 0 && needed > rest.w) {
      draw(theme.text, colour::kMuted, "\u2026");
      return i;
    }
    const ImU32 ink = i == 0 ? colour::kText : colour::kMuted;
    if (i > 0) draw(theme.text, ink, "then ");
    draw(i == 0 ? theme.strong : theme.text, ink, advice);
    if (i < guiding.keys.size()) draw_key(theme, rest, ink, guiding.keys[i]);
    rest.take_left(theme.px(kBetween));
  }
  return guiding.advice.size();
}

}  // namespace insonate::ui
