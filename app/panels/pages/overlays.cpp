#include "app/panels/pages/overlays.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "app/panels/scan/exam_panel.h"
#include "sim/core/text.h"
#include "tools/cli/about.h"

namespace insonate::ui {

Rect begin_overlay(const Theme& theme, const Rect& screen, const ImVec2& size) {
  ImGui::SetNextWindowPos(screen.min());
  ImGui::SetNextWindowSize({screen.w, screen.h});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, colour::kDim);
  if (!ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId)) ImGui::SetNextWindowFocus();
  ImGui::Begin("overlay", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::PopStyleColor();
  const Rect sheet{std::round((screen.w - size.x) / 2), std::round((screen.h - size.y) / 2), size.x, size.y};
  fill(sheet, colour::kPanel, theme.px(8));
  outline(sheet, colour::kLine, theme.px(8));
  return sheet.inset(theme.px(28), theme.px(24));
}

void end_overlay() {
  ImGui::End();
}

namespace {

/// Returns the time left in words, rounded so that it does not flicker; empty if it is not known.
std::string time_left_text(const std::optional<double>& left_s) {
  if (!left_s) return "";
  if (*left_s < 5) return "a few seconds left";
  constexpr double kRound_s = 5;
  const int seconds = int(std::ceil(*left_s / kRound_s) * kRound_s);
  if (seconds < 90) return "about " + std::to_string(seconds) + " s left";
  return "about " + std::to_string((seconds + 30) / 60) + " min left";
}

}  // namespace

bool draw_loading(const Theme& theme, const Rect& screen, const Loading::Progress& progress, bool can_stop,
                  std::map<std::string, Rect>& places) {
  Rect sheet = begin_overlay(theme, screen, {theme.px(460), theme.px(can_stop ? 204 : 176)});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kText, "Insonate");
  sheet.take_top(theme.px(10));
  Rect line = sheet.take_top(theme.px(22));
  const bool counts = progress.share > 0;  // what does not report its progress only shows that it goes on
  if (counts)
    draw_text(line.take_right(theme.px(60)), theme.text, colour::kMuted, formatted("%.0f %%", 100 * progress.share),
              Align::right);
  draw_text(line, theme.text, colour::kMuted, progress.what + (counts ? "" : "\u2026"));
  sheet.take_top(theme.px(14));
  const Rect bar = sheet.take_top(theme.px(5));
  fill(bar, colour::kRaised, theme.px(2.5f));
  constexpr double kPart = 0.25, kRound_s = 1.6;  // of the bar that runs where nothing is counted
  const double at =
      counts ? 0 : (1 - kPart) * (0.5 - 0.5 * std::cos(2 * std::numbers::pi * ImGui::GetTime() / kRound_s));
  const double part = counts ? std::min(progress.share, 1.0) : kPart;
  fill({bar.x + bar.w * float(at), bar.y, bar.w * float(part), bar.h}, colour::kAccent, theme.px(2.5f));
  Rect buttons = sheet.take_bottom(theme.px(38));
  bool stop = false;
  if (can_stop) {
    places["stop_loading"] = buttons.take_right(theme.px(140));
    stop = button(theme, "stop_loading", places["stop_loading"], "Cancel  (Esc)");
  }
  draw_text(buttons, theme.text, colour::kMuted, time_left_text(progress.left_s));
  end_overlay();
  return stop;
}

bool draw_problem(const Theme& theme, const Rect& screen, const std::string& problem, bool ends) {
  const float width = theme.px(600), margin = theme.px(28);
  const float text_height = paragraph_height(theme.text, problem, width - 2 * margin);
  const float shown = std::min(text_height, screen.h * 0.5f);
  Rect sheet = begin_overlay(theme, screen, {width, shown + theme.px(160)});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kAmber,
            ends ? "This exam cannot be taken" : "This cannot be used");
  sheet.take_top(theme.px(14));
  draw_paragraph(sheet.take_top(shown), theme.text, colour::kText, problem);
  Rect buttons = sheet.take_bottom(theme.px(38));
  const bool closed =
      button(theme, "acknowledge", buttons.take_right(theme.px(120)), ends ? "Close" : "Go on", ButtonKind::primary);
  end_overlay();
  return closed;
}

bool draw_about(const Theme& theme, const Rect& screen, const std::string& device) {
  std::vector<AboutLine> lines = about_this_build();
  lines.push_back({"OpenGL", device});
  const float width = theme.px(620), label = theme.px(90), gap = theme.px(8);
  const float text = width - 2 * theme.px(28);
  const auto height_of = [&](const AboutLine& line) { return paragraph_height(theme.text, line.text, text - label); };
  float height = theme.px(188) + paragraph_height(theme.text, kNoMedicalDevice, text);
  for (const AboutLine& line : lines) height += height_of(line) + gap;

  Rect sheet = begin_overlay(theme, screen, {width, height});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kText, "Insonate");
  draw_text(sheet.take_top(theme.px(24)), theme.text, colour::kMuted, "A bedside ultrasound trainer");
  sheet.take_top(theme.px(14));
  for (const AboutLine& line : lines) {
    Rect row = sheet.take_top(height_of(line));
    draw_paragraph(row.take_left(label), theme.text, colour::kMuted, line.name);
    draw_paragraph(row, theme.text, colour::kText, line.text);
    sheet.take_top(gap);
  }
  Rect buttons = sheet.take_bottom(theme.px(38));
  const bool closed =
      button(theme, "close_about", buttons.take_right(theme.px(140)), "Close  (Esc)", ButtonKind::primary);
  sheet.take_top(gap);
  draw_paragraph(sheet, theme.text, colour::kText, kNoMedicalDevice);
  end_overlay();
  return closed;
}

BriefingAnswer draw_briefing(const Theme& theme, const Rect& screen, const Scenario& scenario, bool counts,
                             const std::string& learner, std::map<std::string, Rect>& places) {
  const std::size_t steps = scenario.steps.size();
  const bool whole_minutes = std::fmod(scenario.time_limit_s, 60) == 0;
  char facts[160];
  std::snprintf(facts, sizeof facts, "%zu %s in at most %s minutes; %.0f %% to pass.", steps,
                steps == 1 ? "step" : "steps",
                whole_minutes ? std::to_string(int(scenario.time_limit_s / 60)).c_str()
                              : clock_text(scenario.time_limit_s).c_str(),
                scenario.pass_mark_percent);
  const std::string rules = counts ? "This exam counts. You take it once, without help, and the time runs from Start."
                                   : "This is practice. The time runs from Start; you can begin again at any time.";
  const float width = theme.px(620), text = width - 2 * theme.px(28), gap = theme.px(12);
  float height = theme.px(28 + 48 + 38 + 20 + 22) + gap;
  for (const std::string& paragraph : {scenario.briefing, std::string(facts), rules})
    if (!paragraph.empty()) height += paragraph_height(theme.text, paragraph, text) + gap;

  Rect sheet = begin_overlay(theme, screen, {width, height});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kText, scenario.title);
  const auto draw = [&](ImU32 colour, const std::string& paragraph) {
    if (paragraph.empty()) return;
    sheet.take_top(gap);
    draw_paragraph(sheet.take_top(paragraph_height(theme.text, paragraph, text)), theme.text, colour, paragraph);
  };
  draw(colour::kText, scenario.briefing);
  draw(colour::kMuted, facts);
  draw(colour::kMuted, rules);
  sheet.take_top(gap);
  places["learner"] = sheet.take_top(theme.px(22));
  draw_text(places["learner"], learner.empty() ? theme.text : theme.strong, colour::kText,
            "Learner: " + (learner.empty() ? "anonymous" : learner));
  Rect buttons = sheet.take_bottom(theme.px(38));
  BriefingAnswer answer = BriefingAnswer::none;
  places["start"] = buttons.take_right(theme.px(160));
  if (button(theme, "start", places["start"], "Start  (Enter)", ButtonKind::primary)) answer = BriefingAnswer::start;
  places["leave_briefing"] = buttons.take_left(theme.px(130));
  if (button(theme, "leave_briefing", places["leave_briefing"], "Back  (Esc)")) answer = BriefingAnswer::leave;
  end_overlay();
  return answer;
}

std::optional<bool> draw_leave(const Theme& theme, const Rect& screen, bool ends, bool steps, std::string_view sweep,
                               std::map<std::string, Rect>& places) {
  Rect sheet = begin_overlay(theme, screen, {theme.px(520), theme.px(steps && !sweep.empty() ? 200 : 176)});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kText,
            ends    ? "End the program?"
            : steps ? "Leave these steps?"
                    : "Leave without saving the sweep?");
  sheet.take_top(theme.px(10));
  if (steps)
    draw_text(sheet.take_top(theme.px(24)), theme.text, colour::kMuted,
              "The steps are not finished: nothing of them will be scored or kept.");
  if (!sweep.empty()) draw_text(sheet.take_top(theme.px(24)), theme.text, colour::kMuted, sweep);
  Rect buttons = sheet.take_bottom(theme.px(38));
  std::optional<bool> answer;
  places["leave"] = buttons.take_right(theme.px(150));
  if (button(theme, "leave", places["leave"], ends ? "End  (Enter)" : "Leave  (Enter)", ButtonKind::primary))
    answer = true;
  buttons.take_right(theme.px(8));
  places["stay"] = buttons.take_right(theme.px(150));
  if (button(theme, "stay", places["stay"], "Stay  (Esc)")) answer = false;
  end_overlay();
  return answer;
}

}  // namespace insonate::ui
