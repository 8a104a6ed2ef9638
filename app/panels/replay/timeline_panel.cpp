#include "app/panels/replay/timeline_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/panels/replay/replay_charts.h"
#include "sim/core/text.h"

namespace insonate::ui {
namespace {

constexpr float kNames = 196;  ///< width of the labels on the left, for a screen of 1280 pixels

/// Draws the meaning of the colours.
void draw_legend(const Theme& theme, Rect row, const Replay& replay) {
  const auto entry = [&](ImU32 ink, float thickness, float length, const std::string& text) {
    const Rect words = row.take_right(std::min(text_width(theme.small_text, text), theme.px(170)) + theme.px(2));
    draw_text(words, theme.small_text, colour::kMuted, text, Align::right);
    const Rect line = row.take_right(theme.px(length + 8));
    const float y = line.centre().y, x = line.x + theme.px(length);
    ImGui::GetWindowDrawList()->AddLine({line.x, y}, {x, y}, ink, theme.px(thickness));
    row.take_right(theme.px(14));
  };
  if (const RecordedRun* expert = replay.expert()) {
    entry(colour::kExpert, 2, 22, "expert: " + expert->name);
    entry(colour::kAccent, 2, 22, replay.run().name);
  }
  entry(colour::kAmber, 5, 12, "no pose");
  if (replay.run().result) entry(colour::kAccent, 5, 12, "view as asked");
}

void draw_buttons(const Theme& theme, Rect row, Replay& replay, std::map<std::string, Rect>& places) {
  const float gap = theme.px(6);
  const auto place = [&](const char* name, float width) {
    const Rect where = row.take_left(theme.px(width));
    row.take_left(gap);
    return places[name] = where;
  };
  if (button(theme, "replay_back", place("replay_back", 38), "\u2190", ButtonKind::normal, replay.time_s() > 0,
             "The sample before  (Left)"))
    replay.step(-1);
  if (button(theme, "replay_play", place("replay_play", 92), replay.playing() ? "Pause" : "Play", ButtonKind::primary,
             true, "Plays and pauses  (Space)"))
    replay.toggle();
  if (button(theme, "replay_on", place("replay_on", 38), "\u2192", ButtonKind::normal,
             replay.time_s() < replay.run().duration_s(), "The next sample  (Right)"))
    replay.step(+1);
  row.take_left(theme.px(10));
  for (std::size_t i = 0; i < Replay::kSpeeds.size(); ++i) {
    static constexpr std::array<const char*, Replay::kSpeeds.size()> kTexts{"\u00bc\u00d7", "\u00bd\u00d7", "1\u00d7",
                                                                            "2\u00d7",      "4\u00d7",      "8\u00d7"};
    const bool chosen = Replay::kSpeeds[i] == replay.speed();
    const std::string name = "replay_speed_" + std::to_string(i);
    if (button(theme, name.c_str(), place(name.c_str(), 44), kTexts[i],
               chosen ? ButtonKind::chosen : ButtonKind::normal, true, "How fast it plays  (Up and Down)"))
      while (replay.speed() != Replay::kSpeeds[i]) replay.change_speed(replay.speed() < Replay::kSpeeds[i] ? 1 : -1);
  }
  row.take_left(theme.px(10));
  const std::string time = clock_text_fine(replay.time_s());
  const Rect clock = row.take_left(theme.px(66));
  draw_text(clock, theme.strong, colour::kText, time, Align::right);
  row.take_left(theme.px(4));
  draw_text(row.take_left(theme.px(76)), theme.small_text, colour::kMuted,
            "of " + clock_text_fine(replay.run().duration_s()));

  draw_legend(theme, row, replay);
}

void draw_steps(const Theme& theme, const Rect& lane, const TimeScale& scale, const Replay& replay,
                const Scenario* scenario) {
  const RecordedRun& run = replay.run();
  const std::size_t now = run.stretch_at(replay.time_s());
  for (std::size_t i = 0; i < run.stretches.size(); ++i) {
    const RunStretch& stretch = run.stretches[i];
    const float left = scale.x(stretch.start_s), right = scale.x(stretch.end_s);
    const Rect bar{left, lane.y, std::max(right - left - 1, 1.0f), lane.h};
    fill(bar, i == now ? colour::kAccentDark : colour::kRaised, theme.px(3));
    if (!scenario) continue;
    const std::string number = std::to_string(stretch.step + 1);
    const Rect words = bar.inset(theme.px(6), 0);
    if (words.w < text_width(theme.small_text, number)) continue;
    const std::string full = number + "  " + scenario->steps[stretch.step].title;
    draw_text(words, theme.small_text, i == now ? colour::kText : colour::kMuted,
              words.w > theme.px(60) ? full : number);
  }
}

/// Draws when the picture was the view that the step asks for, and when no pose came.
void draw_condition(const Theme& theme, const Rect& strip, const TimeScale& scale, const RecordedRun& run) {
  fill(strip, colour::kRaised);
  const auto draw = [&](auto&& condition, ImU32 ink) {
    for (std::size_t i = 0; i + 1 < run.moments.size(); ++i) {
      if (!condition(run.moments[i])) continue;
      const std::size_t first = i;
      while (i + 2 < run.moments.size() && condition(run.moments[i + 1])) ++i;
      const float left = scale.x(run.moments[first].time_s), right = scale.x(run.moments[i + 1].time_s);
      fill({left, strip.y, std::max(right - left, theme.px(1)), strip.h}, ink);
    }
  };
  draw([](const RunMoment& moment) { return moment.within_tolerance && moment.view; }, colour::kAccent);
  draw([](const RunMoment& moment) { return moment.last_usable_s != moment.time_s; }, colour::kAmber);
}

/// Draws the actions. Returns the text of the one under the pointer.
std::string draw_events(const Theme& theme, const Rect& lane, const TimeScale& scale, const RecordedRun& run) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  const bool near_lane = pointer.y > lane.y - theme.px(4) && pointer.y < lane.y + lane.h + theme.px(4);
  std::string words;
  for (const RunEvent& event : run.events) {
    const float x = std::round(scale.x(event.time_s)), middle = lane.centre().y, half = lane.h / 2;
    if (event.is_marker)
      list->AddTriangleFilled({x - half, lane.y}, {x + half, lane.y}, {x, lane.y + lane.h}, colour::kText);
    else
      list->AddCircleFilled({x, middle}, half * 0.7f, colour::kFaint, 12);
    if (!near_lane || std::abs(pointer.x - x) > theme.px(5)) continue;
    words += (words.empty() ? clock_text_fine(event.time_s) + "  " : ", ") + event.words;
  }
  return words;
}

void draw_cursor(const Theme& theme, const Rect& plot, float x) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddLine({x, plot.y}, {x, plot.y + plot.h}, colour::kText, theme.px(1.5f));
  list->AddTriangleFilled({x - theme.px(6), plot.y - theme.px(2)}, {x + theme.px(6), plot.y - theme.px(2)},
                          {x, plot.y + theme.px(8)}, colour::kText);
}

}  // namespace

std::string clock_text_fine(double seconds) {
  // Rounds to tenths first; otherwise 59.96 would be shown as 0:60.0.
  const long tenths = std::lround(seconds * 10);
  return formatted("%ld:%02ld.%ld", tenths / 600, tenths / 10 % 60, tenths % 10);
}

void draw_timeline_panel(const Theme& theme, const Rect& panel, Replay& replay, const Scenario* scenario,
                         std::map<std::string, Rect>& places) {
  fill(panel, colour::kPanel, theme.px(4));
  Rect rest = panel.inset(theme.px(16), theme.px(10));
  draw_buttons(theme, rest.take_top(theme.px(32)), replay, places);
  rest.take_top(theme.px(10));
  Rect names = rest.take_left(theme.px(kNames));
  const Rect plot = places["timeline"] = rest;
  const TimeScale scale{plot.x, plot.w, std::max(replay.run().duration_s(), 1e-3)};

  ImGui::SetCursorScreenPos(plot.min());
  ImGui::InvisibleButton("timeline", {plot.w, plot.h});
  if (ImGui::IsItemActivated()) replay.pause();
  if (ImGui::IsItemActive()) replay.seek(scale.time_s(ImGui::GetIO().MousePos.x));

  const Rect lane = rest.take_top(theme.px(22)), condition = rest.take_top(theme.px(4));
  draw_steps(theme, lane, scale, replay, scenario);
  draw_condition(theme, condition, scale, replay.run());
  rest.take_top(theme.px(3));
  const Rect events = rest.take_top(theme.px(9));
  const std::string words = draw_events(theme, events, scale, replay.run());
  rest.take_top(theme.px(4));
  const float head = rest.y - plot.y;
  names.take_top(head);
  draw_replay_charts(theme, names, rest, scale, replay, scenario != nullptr);
  draw_cursor(theme, plot, scale.x(replay.time_s()));
  const Rect title{names.x, plot.y, names.w - theme.px(10), theme.px(22)};
  draw_text(title, theme.small_text, words.empty() ? colour::kMuted : colour::kText,
            words.empty() ? (scenario ? "Steps, marks and actions" : "Marks and actions") : words);
}

}  // namespace insonate::ui
