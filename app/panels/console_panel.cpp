#include "app/panels/console_panel.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

namespace insonate::ui {
namespace {

std::string formatted(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void draw_probe_choice(const Theme& theme, Rect where, Session& session) {
  Console& console = session.console();
  draw_text(where.take_top(theme.px(20)), theme.small_text, colour::kMuted, "Probe");
  where.take_top(theme.px(4));
  const float between = theme.px(5), count = float(probes().size());
  const float height = std::min((where.h - (count - 1) * between) / count, theme.px(30));
  for (const Probe& probe : probes()) {
    const Rect place = where.take_top(height);
    where.take_top(between);
    const bool chosen = console.probe.name == probe.name;
    if (button(theme, probe.name.c_str(), place, probe.title.c_str(), chosen ? ButtonKind::chosen : ButtonKind::normal,
               chosen || !session.locks(ActionKind::probe)) &&
        !chosen)
      console.choose(probe);
  }
}

void draw_knobs(const Theme& theme, Rect where, Session& session) {
  Console& console = session.console();
  const float gap = theme.px(24);
  const float width = (where.w - gap) / 2, height = theme.px(46);
  const Rect left{where.x, where.y, width, height}, right{where.x + width + gap, where.y, width, height};
  const float next = theme.px(50);
  slider(theme, "depth", left, "Depth", formatted("%.1f cm", console.depth_mm / 10), console.depth_mm,
         Console::kLeastDepth_mm, Console::kMostDepth_mm, 5, console.probe.depth_mm, !session.locks(ActionKind::depth));
  slider(theme, "gain", right, "Gain", formatted("%+.0f dB", console.gain_db), console.gain_db, -30, 30, 1, 0,
         !session.locks(ActionKind::gain));
  slider(theme, "frequency", {left.x, left.y + next, width, height}, "Frequency",
         formatted("%.1f MHz", console.frequency_mhz), console.frequency_mhz, 1.5, 12, 0.5, console.probe.frequency_mhz,
         !session.locks(ActionKind::frequency));
  slider(theme, "range", {right.x, right.y + next, width, height}, "Dynamic range",
         formatted("%.0f dB", console.dynamic_range_db), console.dynamic_range_db, 30, 90, 5, 60,
         !session.locks(ActionKind::gain));
}

void draw_time_gain(const Theme& theme, Rect where, Session& session) {
  Console& console = session.console();
  constexpr double kReach_db = 20;
  Rect head = where.take_top(theme.px(20));
  draw_text(head, theme.small_text, colour::kMuted, "Time gain");
  draw_text(head, theme.small_text, colour::kFaint, "near to far", Align::right);
  where.take_top(theme.px(4));
  const float width = where.w / float(console.tgc_db.size());
  for (std::size_t i = 0; i < console.tgc_db.size(); ++i) {
    const std::string id = "tgc" + std::to_string(i);
    upright_slider(theme, id.c_str(), where.take_left(width), console.tgc_db[i], kReach_db,
                   !session.locks(ActionKind::gain));
  }
}

}  // namespace

ConsoleRequest draw_console_panel(const Theme& theme, const Rect& panel, Session& session,
                                  const std::function<void(const std::function<void()>&)>& attempt) {
  fill(panel, colour::kPanel, theme.px(4));
  Console& console = session.console();
  Rect rest = panel.inset(theme.px(16), theme.px(10));
  const float gap = theme.px(28);
  draw_probe_choice(theme, rest.take_left(theme.px(112)), session);
  rest.take_left(gap);

  Rect buttons = rest.take_right(theme.px(276));
  rest.take_right(gap);
  draw_time_gain(theme, rest.take_right(theme.px(190)), session);
  rest.take_right(gap);
  draw_knobs(theme, rest, session);

  ConsoleRequest request = ConsoleRequest::none;
  const float height = theme.px(44), between = theme.px(8);
  buttons.take_top((buttons.h - 2 * height - between) / 2);
  Rect upper = buttons.take_top(height);
  buttons.take_top(between);
  Rect lower = buttons.take_top(height);
  if (button(theme, "freeze", upper.take_left(theme.px(86)), console.frozen ? "Live" : "Freeze",
             console.frozen ? ButtonKind::chosen : ButtonKind::normal))
    console.frozen = !console.frozen;
  upper.take_left(between);
  const bool learner = session.holder() == Holder::learner;
  if (session.only_learner()) {
    if (button(theme, "restart", upper, session.study().scenario ? "Start over" : "Back to the start",
               ButtonKind::normal, !session.strict()))
      attempt([&] { session.start_over(); });
  } else if (button(theme, "hands", upper, learner ? "Give the probe back" : "Take the probe",
                    learner ? ButtonKind::chosen : ButtonKind::normal, !session.strict())) {
    attempt([&] { learner ? session.give_back_probe() : session.take_probe(); });
  }
  if (button(theme, "help", lower.take_left(theme.px(86)), "Keys")) request = ConsoleRequest::help;
  lower.take_left(between);
  const bool practising = session.activity() == Activity::practice && session.study().scenario;
  const Rect first = lower.take_left((lower.w - between) / 2);
  lower.take_left(between);
  if (practising) {
    if (button(theme, "exam", first, "Scored")) attempt([&] { session.start_over(); });
  } else if (button(theme, "practice", first, "Unscored", ButtonKind::normal,
                    session.study().scenario.has_value() && !session.strict())) {
    // Nobody leads the probe of a recorded scan.
    std::as_const(session).source().recording() ? session.take_probe() : session.practise();
  }
  if (button(theme, "open", lower, "Open", ButtonKind::normal, !session.strict())) request = ConsoleRequest::open;
  return request;
}

}  // namespace insonate::ui
