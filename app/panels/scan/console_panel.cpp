#include "app/panels/scan/console_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include "sim/core/text.h"

namespace insonate::ui {
namespace {

std::string tip_of(const Theme& theme, const Probe& probe) {
  return probe.title + " probe, " + formatted("%.1f MHz, ", probe.frequency_mhz) +
         depth_text(theme.look(), probe.depth_mm) + " deep";
}

/// Widths of the console's parts, and the gaps between them.
constexpr float kProbes = 112, kButtons = 276, kTimeGain = 150, kColumnGap = 28, kKnobGap = 18;
constexpr int kColumns = 4, kRows = 2;

void draw_probe_choice(const Theme& theme, Rect where, Session& session, std::map<std::string, Rect>& places) {
  draw_text(where.take_top(theme.px(20)), theme.small_text, colour::kMuted, "Probe");
  where.take_top(theme.px(4));
  const float between = theme.px(5), count = float(probes().size());
  const float height = std::min((where.h - (count - 1) * between) / count, theme.px(30));
  for (const Probe& probe : probes()) {
    const Rect place = places["probe_" + probe.name] = where.take_top(height);
    where.take_top(between);
    const bool chosen = session.machine().probe == probe.name;
    const std::string why_not = chosen ? "" : session.why_not(ActionKind::probe);
    if (button(theme, probe.name.c_str(), place, probe.title.c_str(), chosen ? ButtonKind::chosen : ButtonKind::normal,
               why_not.empty(), why_not.empty() ? tip_of(theme, probe) : "") &&
        !chosen)
      session.choose_probe(probe.name);
    if (!why_not.empty()) draw_tooltip(theme, place, why_not);
  }
}

/// A knob of the console. What it shows, turns by and goes back to is in the slider's own unit.
struct Knob {
  const char* id;
  ActionKind kind;
  const char* name;
  std::string text;
  double value, least, most, step, normal;
  const char* tip;
  double offset = 0, scale = 1;  ///< the action's number is offset + scale * value
};

std::vector<Knob> knobs_of(const Theme& theme, const Machine& machine) {
  const Probe& probe = machine.transducer();
  const Machine usual;
  // One angle, and pairs of others beside it.
  constexpr int kMaxPairs = Machine::kMaxSteeringAngles / 2;
  const int pairs = machine.steering_angles / 2, usual_pairs = usual.steering_angles / 2;
  const auto percent = [](double share) { return share > 0 ? formatted("%.0f %%", 100 * share) : std::string("off"); };
  return {
      {"depth", ActionKind::depth, "Depth", depth_text(theme.look(), machine.depth_mm), machine.depth_mm,
       Machine::kMinDepth_mm, Machine::kMaxDepth_mm, 5, probe.depth_mm,
       "How deep the picture goes. A double click takes the probe's own depth.  ([ and ])"},
      {"gain", ActionKind::gain, "Gain", formatted("%+.0f dB", machine.gain_db), machine.gain_db, -Machine::kMaxGain_db,
       Machine::kMaxGain_db, 1, 0,
       "Makes all echoes brighter or darker. A double click takes it back.  (+ and \u2212)"},
      {"compounding", ActionKind::compounding, "Compound",
       machine.steering_angles > 1 ? formatted("%d angles", machine.steering_angles) : std::string("off"),
       double(pairs), 0, double(kMaxPairs), 1, double(usual_pairs),
       "Averages pictures from several directions: less speckle, softer shadows, and outlines that are whole.", 1, 2},
      {"edges", ActionKind::edge_enhancement, "Edges", formatted("%.2g", machine.edge_enhancement),
       machine.edge_enhancement, 0, Machine::kMaxEdgeEnhancement, 0.25, usual.edge_enhancement,
       "Sharpens outlines. A double click takes the usual amount."},
      {"frequency", ActionKind::frequency, "Frequency", formatted("%.1f MHz", machine.frequency_mhz),
       machine.frequency_mhz, 1.5, 12, 0.5, probe.frequency_mhz,
       "A high frequency shows finer detail and reaches less deep. A double click takes the probe's own."},
      {"range", ActionKind::dynamic_range, "Range", formatted("%.0f dB", machine.dynamic_range_db),
       machine.dynamic_range_db, Machine::kMinDynamicRange_db, Machine::kMaxDynamicRange_db, 5, kUsualDynamicRange_db,
       "How weak an echo is still grey. A small range is rich in contrast, a large one shows weak echoes."},
      {"persistence", ActionKind::persistence, "Persistence", percent(machine.persistence), machine.persistence, 0,
       Machine::kMaxPersistence, 0.1, usual.persistence,
       "How much of the frame before stays in a moving picture: less noise, but a fast move smears."},
      {"smoothing", ActionKind::speckle_reduction, "Smoothing", percent(machine.speckle_reduction),
       machine.speckle_reduction, 0, 1, 0.1, usual.speckle_reduction, "Reduces speckle where the tissue is even."},
  };
}

void draw_knobs(const Theme& theme, const Rect& where, Session& session) {
  const float gap = theme.px(kKnobGap), width = (where.w - (kColumns - 1) * gap) / kColumns;
  const float height = where.h / kRows;
  const std::vector<Knob> knobs = knobs_of(theme, session.machine());
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const Knob& knob = knobs[i];
    const int row = int(i) / kColumns, column = int(i) % kColumns;
    const Rect place{where.x + float(column) * (width + gap), where.y + float(row) * height, width,
                     height - theme.px(4)};
    const std::string why_not = session.why_not(knob.kind);
    double value = knob.value;
    if (slider(theme, knob.id, place, knob.name, knob.text, value, knob.least, knob.most, knob.step, knob.normal,
               why_not.empty(), knob.tip))
      session.set(knob.kind, knob.offset + knob.scale * value);
    if (!why_not.empty()) draw_tooltip(theme, place, why_not);
  }
}

/// Returns whether names and values of all knobs fit beside each other, whatever the values are.
bool knobs_fit(const Theme& theme, float panel_width) {
  Machine widest;
  widest.probe = probes().front().name;
  widest.depth_mm = Machine::kMaxDepth_mm;
  widest.gain_db = -Machine::kMaxGain_db;
  widest.steering_angles = Machine::kMaxSteeringAngles;
  widest.edge_enhancement = Machine::kMaxEdgeEnhancement - 0.25;
  widest.frequency_mhz = 12;
  widest.dynamic_range_db = Machine::kMaxDynamicRange_db;
  widest.persistence = Machine::kMaxPersistence;
  widest.speckle_reduction = 1;
  const float others = kProbes + kButtons + kTimeGain + 3 * kColumnGap + 2 * kWideMargin + (kColumns - 1) * kKnobGap;
  const float width = (panel_width - theme.px(others)) / kColumns;
  const std::vector<Knob> knobs = knobs_of(theme, widest);
  return std::all_of(knobs.begin(), knobs.end(),
                     [&](const Knob& knob) { return fits_one_line(theme, width, knob.name, knob.text); });
}

void draw_time_gain(const Theme& theme, Rect where, Session& session) {
  Rect head = where.take_top(theme.px(20));
  draw_text(head, theme.small_text, colour::kMuted, "Time gain");
  draw_text(head, theme.small_text, colour::kFaint, "near to far", Align::right);
  where.take_top(theme.px(4));
  const std::string why_not = session.why_not(ActionKind::time_gain);
  if (!why_not.empty()) draw_tooltip(theme, where, why_not);
  const auto& sliders = session.machine().time_gain_db;
  const float width = where.w / float(sliders.size());
  for (std::size_t i = 0; i < sliders.size(); ++i) {
    const std::string id = "tgc" + std::to_string(i);
    double value = sliders[i];
    if (upright_slider(theme, id.c_str(), where.take_left(width), value, Machine::kMaxTimeGain_db, why_not.empty(),
                       "Gain at this depth. A double click takes it back."))
      session.set({ActionKind::time_gain, {double(i + 1), value}});
  }
}

}  // namespace

float console_height(const Theme& theme, float width) {
  return kRows * (slider_height(theme, !knobs_fit(theme, width)) + theme.px(4)) + theme.px(20);
}

ConsoleRequest draw_console_panel(const Theme& theme, const Rect& panel, Session& session,
                                  const std::function<void(const std::function<void()>&)>& attempt,
                                  std::map<std::string, Rect>& places) {
  fill(panel, colour::kPanel, theme.px(4));
  Rect rest = panel.inset(theme.px(kWideMargin), theme.px(10));
  const float gap = theme.px(kColumnGap);
  draw_probe_choice(theme, rest.take_left(theme.px(kProbes)), session, places);
  rest.take_left(gap);

  Rect buttons = rest.take_right(theme.px(kButtons));
  rest.take_right(gap);
  draw_time_gain(theme, rest.take_right(theme.px(kTimeGain)), session);
  rest.take_right(gap);
  draw_knobs(theme, rest, session);

  ConsoleRequest request = ConsoleRequest::none;
  const float height = theme.px(44), between = theme.px(8);
  buttons.take_top((buttons.h - 2 * height - between) / 2);
  Rect upper = buttons.take_top(height);
  buttons.take_top(between);
  Rect lower = buttons.take_top(height);
  if (button(theme, "freeze", upper.take_left(theme.px(86)), session.machine().frozen ? "Live" : "Freeze",
             session.machine().frozen ? ButtonKind::chosen : ButtonKind::normal, true,
             session.machine().frozen ? "Lets the picture run again  (Space)"
                                      : "Holds the picture, to measure in it or to save it  (Space)"))
    session.freeze(!session.machine().frozen);
  upper.take_left(between);
  const bool learner = session.holder() == Holder::learner;
  const bool steps = session.activity() == Activity::exam;
  if (session.only_learner()) {
    if (button(theme, "restart", upper, steps ? "Start over" : "Reset the probe", ButtonKind::normal, !session.strict(),
               "Begins again: the probe goes back to where it started"))
      attempt([&] { session.start_over(session.activity()); });
  } else if (button(theme, "hands", upper, learner ? "Give the probe back" : "Take the probe",
                    learner ? ButtonKind::chosen : ButtonKind::normal, !session.strict(),
                    session.strict() ? "This exam counts: the probe stays with the tracker."
                    : learner        ? "The tracker moves the probe again, from the beginning  (Tab)"
                                     : "Mouse and keys move the probe from here on  (Tab)")) {
    request = ConsoleRequest::switch_holder;
  }
  if (button(theme, "help", lower.take_left(theme.px(86)), "Help", ButtonKind::normal, true,
             "What the keys and the mouse do  (F1)"))
    request = ConsoleRequest::help;
  lower.take_left(between);
  const Rect first = lower.take_left((lower.w - between) / 2);
  lower.take_left(between);
  places[steps ? "practice" : "steps"] = first;
  if (!steps) {
    const auto& scenario = session.loaded_case().scenario;
    if (button(theme, "steps", first, "Steps", ButtonKind::normal, session.can_take_steps(),
               scenario && !session.can_take_steps() ? "The made-up hand takes no steps"
               : scenario ? "Scored steps: the briefing of \"" + scenario->title + "\", and then Start"
                          : "This patient has no scored steps"))
      request = ConsoleRequest::brief;
  } else if (button(theme, "practice", first, "Practice", ButtonKind::normal,
                    session.loaded_case().scenario.has_value() && !session.strict(),
                    session.strict() ? "This exam counts: practice is there when it is over."
                                     : "Scans without steps, clock and score")) {
    request = ConsoleRequest::practise;
  }
  if (button(theme, "open", lower, "Open", ButtonKind::normal, !session.strict(),
             session.strict() ? "This exam counts: go on to its end, then something else can be opened."
                              : "Opens a case, CT, scenario or recorded scan  (Ctrl O)"))
    request = ConsoleRequest::open;
  return request;
}

}  // namespace insonate::ui
