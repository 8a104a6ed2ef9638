#include "app/panels/scan/effects_panel.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "app/pictures/pictures.h"
#include "sim/core/text.h"
#include "sim/model/effects.h"

namespace insonate::ui {
namespace {

struct EffectWords {
  std::string_view effect;
  const char* title;
  const char* tip;
};
constexpr EffectWords kWords[] = {
    {"absorption", "Absorption", "Sound gets weaker on its way, the more so at a high frequency."},
    {"waves", "Waves", "Echoes add up as waves. Off: the sums of the paper that the model follows."},
    {"speckle", "Speckle", "The grain that scatterers smaller than the beam make. Off: their mean."},
    {"focused_beam", "Focused beam", "The beam is narrowest at its focus. Off: equally wide at every depth."},
    {"slice_thickness", "Thick slice", "The picture shows a slice of some mm. Off: a plane."},
    {"reverberation", "Reverberation", "Sound bounces between strong surfaces: comet tails, tails of ribs."},
    {"face_reverberation", "A-lines", "Sound bounces between gas or bone and the probe's face."},
    {"mirror_image", "Mirror images", "Gas shows what lies before it once more behind it."},
    {"edge_shadow", "Edge shadows", "Round edges refract the sound, and dark lines run down from them."},
    {"clutter", "Clutter", "Side lobes and layers of the body wall bring haze into fluid and shadows."},
    {"noise", "Noise", "The receiver's own noise, which shows where time gain is high."},
    {"ring_down", "Ring-down", "The transducer rings on after its pulse: a white band at its face."},
    {"two_way", "Two-way loss", "Echoes get weaker on their way back, too."},
    {"focus_mm", "Focus", "The depth at which the transmitted beam is narrowest."},
    {"f_number", "F-number", "Focus over aperture: a small one is a narrow beam at its focus."},
    {"scattering_db", "Scattering", "The echo of tissue against that of its surfaces."},
    {"grey_map", "Grey map", "How echoes become grey levels."},
};

const EffectWords& words_of(const Effect& effect) {
  return *std::ranges::find(kWords, effect.name, &EffectWords::effect);
}

std::string value_text(const Effect& effect, double value) {
  if (effect.name == "focus_mm") return formatted("%.0f mm", value);
  if (effect.name == "scattering_db") return formatted("%+.0f dB", value);
  if (effect.name == "grey_map") return std::array{"linear", "soft", "contrast", "S curve"}.at(std::size_t(value));
  return formatted("%.1f", value);
}

double step_of(const Effect& effect) {
  if (effect.whole) return 1;
  return effect.name == "focus_mm" ? 5 : effect.name == "f_number" ? 0.5 : 1;
}

}  // namespace

bool draw_effects_panel(const Theme& theme, const Rect& panel, Session& session, std::map<std::string, Rect>& places) {
  places["effects_panel"] = panel;
  fill(panel, colour::kPanel, theme.px(4));
  Rect rest = panel.inset(theme.px(10), theme.px(8));
  const float gap = theme.px(6), high = theme.px(26);
  const std::string why_not = session.why_not(ActionKind::effect);
  const Machine& machine = session.machine();
  const Settings now = settings_of(machine), usual = settings_of(with_usual_effects(machine));
  const bool changed = now != usual;

  Rect title = rest.take_top(high);
  const bool closes = button(theme, "effects_close", places["effects_close"] = title.take_right(high), "\u00d7",
                             ButtonKind::normal, true, "Closes this panel  (F8)");
  title.take_right(gap);
  if (button(theme, "effects_usual", places["effects_usual"] = title.take_right(theme.px(94)), "As usual",
             changed ? ButtonKind::primary : ButtonKind::normal, why_not.empty() && changed,
             "Takes all changes of this panel back"))
    session.set({ActionKind::effect});
  draw_text(title, theme.strong, colour::kText, "Effects in the picture");
  rest.take_top(gap);
  if (!why_not.empty()) {
    draw_paragraph(rest, theme.small_text, colour::kMuted, why_not);
    return closes;
  }

  std::vector<const Effect*> switches, numbers;
  for (const Effect& effect : effects()) (effect.is_switch() ? switches : numbers).push_back(&effect);

  constexpr std::size_t kPerRow = 4;
  const float width = (rest.w - gap * float(kPerRow - 1)) / float(kPerRow);
  const float row_high = std::min(high, (rest.h - theme.px(104)) / 4 - theme.px(4));
  for (std::size_t first = 0; first < switches.size(); first += kPerRow) {
    Rect row = rest.take_top(row_high);
    rest.take_top(theme.px(4));
    for (std::size_t i = first; i < std::min(first + kPerRow, switches.size()); ++i) {
      const Effect& effect = *switches[i];
      const std::string id = "effect_" + std::string(effect.name);
      const bool on = effect.value(now) != 0;
      if (button(theme, id.c_str(), places[id] = row.take_left(width), words_of(effect).title,
                 on ? ButtonKind::chosen : ButtonKind::normal, true, words_of(effect).tip))
        session.set({ActionKind::effect, {on ? 0.0 : 1.0}, std::string(effect.name)});
      row.take_left(gap);
    }
  }
  rest.take_top(theme.px(2));
  const float half = (rest.w - theme.px(18)) / 2, slider_high = theme.px(46);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Effect& effect = *numbers[i];
    const std::string id = "effect_" + std::string(effect.name);
    const std::size_t row = i / 2, column = i % 2;
    const Rect place{rest.x + float(column) * (half + theme.px(18)), rest.y + float(row) * (slider_high + theme.px(2)),
                     half, slider_high};
    places[id] = place;
    double value = effect.value(now);
    if (slider(theme, id.c_str(), place, words_of(effect).title, value_text(effect, value), value, effect.least,
               effect.most, step_of(effect), effect.value(usual), true, words_of(effect).tip))
      session.set({ActionKind::effect, {value}, std::string(effect.name)});
  }
  return closes;
}

}  // namespace insonate::ui
