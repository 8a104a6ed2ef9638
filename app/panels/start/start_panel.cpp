#include "app/panels/start/start_panel.h"

#include <algorithm>
#include <utility>

#include "app/panels/start/start_list.h"
#include "app/panels/widgets/choice_rows.h"
#include "app/panels/widgets/scroll_area.h"
#include "scenarios/words.h"
#include "sim/core/text.h"

namespace insonate::ui {
namespace {

Rect draw_column_panel(const Theme& theme, const Rect& panel, std::string_view title) {
  fill(panel, colour::kPanel, theme.px(8));
  Rect rest = panel.inset(theme.px(18), theme.px(14));
  draw_text(rest.take_top(theme.px(22)), theme.strong, colour::kText, title);
  rest.take_top(theme.px(8));
  return rest;
}

ImU32 light_of(FoundTracker::State state) {
  switch (state) {
    case FoundTracker::State::ready:
      return colour::kAccent;
    case FoundTracker::State::hindered:
      return colour::kAmber;
    case FoundTracker::State::absent:
      return colour::kLine;
  }
  return colour::kLine;
}

/// A reason is shown so far; the rest beside the pointer.
constexpr float kReasonLines = 3;

float reason_height(const Theme& theme) {
  return kReasonLines * theme.small_text->FontSize + theme.px(6);
}

const char* words_of(FoundTracker::State state) {
  switch (state) {
    case FoundTracker::State::ready:
      return "ready";
    case FoundTracker::State::hindered:
      return "cannot be used";
    case FoundTracker::State::absent:
      return "not plugged in";
  }
  return "";
}

}  // namespace

StartAnswer StartPanel::draw(const Theme& theme, const Rect& screen, StartPage& page, const Attempt& attempt,
                             std::map<std::string, Rect>& places) {
  places_ = &places;
  StartAnswer answer;
  Rect rest = screen.inset(theme.px(24), theme.px(16));
  Rect head = rest.take_top(theme.px(48));
  rest.take_top(theme.px(12));
  places["about_page"] = head.take_right(theme.px(90)).inset(0, theme.px(6));
  if (button(theme, "about_page", places["about_page"], "About")) answer.kind = StartAnswer::Kind::about;
  head.take_right(theme.px(8));
  places["settings_page"] = head.take_right(theme.px(130)).inset(0, theme.px(6));
  if (button(theme, "settings_page", places["settings_page"], "Settings  (F3)"))
    answer.kind = StartAnswer::Kind::settings;
  head.take_right(theme.px(8));
  places["help_page"] = head.take_right(theme.px(110)).inset(0, theme.px(6));
  if (button(theme, "help_page", places["help_page"], "Help  (F1)")) answer.kind = StartAnswer::Kind::help;
  draw_text(head.take_left(text_width(theme.title, "Insonate") + theme.px(16)), theme.title, colour::kText, "Insonate");
  head.y += theme.px(4);
  draw_text(head, theme.text, colour::kMuted, "Bedside ultrasound trainer");

  const Rect foot = rest.take_bottom(theme.px(24));
  rest.take_bottom(theme.px(8));
  draw_text(foot, theme.small_text, page.problem().empty() ? colour::kMuted : colour::kAmber,
            page.problem().empty()
                ? "\u2191 \u2193 choose    Enter begin    Ctrl O open a file; or drop it on the window"
                : page.problem());

  const float gap = theme.px(16);
  Rect tasks = rest.take_left(theme.px(268));
  rest.take_left(gap);
  Rect side = rest.take_right(theme.text_px(336));
  rest.take_right(gap);
  const float between = theme.px(8);
  const std::vector<Task> offered = page.tasks();
  const auto count = float(offered.size());
  const float height = std::min(theme.px(76), (tasks.h - between * (count - 1)) / count);
  for (const Task task : offered) {
    const TaskText& text = text_of(task);
    const std::string id = std::string("task_") + to_string(text.task);
    const Rect row = tasks.take_top(height);
    tasks.take_top(between);
    places[id] = row;
    const bool chosen = page.task == text.task;
    if (button(theme, id.c_str(), row, "", chosen ? ButtonKind::chosen : ButtonKind::normal)) page.task = text.task;
    if (chosen) fill({row.x, row.y, theme.px(5), row.h}, colour::kAccent, theme.px(2));
    Rect lines = row.inset(theme.px(18), (row.h - theme.px(44)) / 2);
    draw_text(lines.take_top(theme.px(24)), theme.heading, colour::kText, text.title);
    draw_text(lines, theme.small_text, chosen ? colour::kText : colour::kMuted, text.summary);
  }

  const StartAnswer of_task = draw_task(theme, rest, page, places);
  if (of_task.kind != StartAnswer::Kind::none) answer = of_task;
  draw_learner(theme, side.take_top(theme.px(178)), page, attempt);
  side.take_top(gap);
  float trackers = theme.px(14 + 22 + 8 + 8 + 38 + 14);
  for (const OfferedTracker& tracker : page.trackers())
    trackers += theme.px(kListRow) + (tracker.state == FoundTracker::State::hindered ? reason_height(theme) : 0);
  draw_trackers(theme, side.take_top(trackers), page, attempt);
  side.take_top(gap);
  if (side.h > theme.px(90)) draw_attempts(theme, side, page);
  return answer;
}

void StartPanel::close_fields(bool keep) {
  if (!keep) learner_was_open_ = address_was_open_ = false;
  learner_.close();
  address_.close();
}

void StartPanel::draw_learner(const Theme& theme, Rect panel, StartPage& page, const Attempt& attempt) {
  Rect rest = draw_column_panel(theme, panel, "Who is learning");
  const bool nobody = page.learner() == kNobodyInParticular;
  if (std::exchange(learner_was_open_, learner_.is_open()) && !learner_.is_open())
    attempt([&] { page.choose_learner(typed_learner_); });
  const bool refused = !page.refused_learner().empty();
  if (!learner_.is_open()) typed_learner_ = refused ? page.refused_learner() : nobody ? "" : page.learner();
  const Rect field = rest.take_top(theme.px(36));
  (*places_)["learner_field"] = field;
  ImGui::PushID("learner");
  typed_learner_ = learner_.draw(theme, field, typed_learner_, "An id that is not a name, such as L-07");
  ImGui::PopID();
  page.learner_is_typed = learner_.is_open() && !typed_learner_.empty();
  if (refused && !learner_.is_open()) outline(field, colour::kAmber, theme.px(4));
  rest.take_top(theme.px(8));
  std::vector<Choice> choices{
      {"learner_nobody", "Anonymous", nobody && !refused ? ButtonKind::chosen : ButtonKind::normal}};
  std::vector<std::string> ids{""};
  constexpr std::size_t kMax = 24;  // what flows into the rows
  for (const std::string& id : page.learners()) {
    if (choices.size() > kMax) break;
    if (learner_.is_open() && id.find(typed_learner_) == std::string::npos) continue;
    choices.push_back(
        {"learner_" + id, id, id == page.learner() && !refused ? ButtonKind::chosen : ButtonKind::normal});
    ids.push_back(id);
  }
  if (const auto clicked = flow_of_choices(theme, rest, choices, *places_)) {
    close_fields(false);
    attempt([&] { page.choose_learner(ids[*clicked]); });
  }
}

void StartPanel::draw_trackers(const Theme& theme, Rect panel, StartPage& page, const Attempt& attempt) {
  Rect rest = draw_column_panel(theme, panel, "Tracker");
  std::string chosen;
  for (const OfferedTracker& tracker : page.trackers()) {
    const bool hindered = tracker.state == FoundTracker::State::hindered, current = tracker.uri == page.tracker();
    Rect row = rest.take_top(theme.px(kListRow));
    const std::string id = "tracker_" + tracker.uri;
    (*places_)[id] = row;
    ImGui::SetCursorScreenPos(row.min());
    if (ImGui::InvisibleButton(id.c_str(), {row.w, row.h}) && tracker.usable()) chosen = tracker.uri;
    if (current)
      fill(row, colour::kAccentDark, theme.px(4));
    else if (ImGui::IsItemHovered() && tracker.usable())
      fill(row, colour::kRaised, theme.px(4));
    draw_tooltip(theme, row, tracker.why);
    Rect line = row.inset(theme.px(10), 0);
    const Rect light = line.take_left(theme.px(22));
    const ImVec2 middle{light.x + theme.px(6), light.centre().y};
    if (tracker.checked)
      ImGui::GetWindowDrawList()->AddCircleFilled(middle, theme.px(6), light_of(tracker.state), 20);
    else
      ImGui::GetWindowDrawList()->AddCircle(middle, theme.px(5), colour::kMuted, 20, theme.px(1.5f));
    const char* words = tracker.checked                    ? words_of(tracker.state)
                        : tracker.uri.starts_with("igtl:") ? "on the network"
                                                           : "not looked for";
    draw_text(line.take_right(text_width(theme.small_text, words) + 1), theme.small_text,
              current ? colour::kText : colour::kMuted, words, Align::right);
    line.take_right(theme.px(8));
    draw_text(line, theme.text, tracker.state == FoundTracker::State::absent ? colour::kMuted : colour::kText,
              tracker.name);
    if (hindered) {
      Rect why = rest.take_top(reason_height(theme));
      draw_tooltip(theme, why, tracker.why);
      why = {why.x + theme.px(32), why.y, why.w - theme.px(32), kReasonLines * theme.small_text->FontSize};
      draw_paragraph(why, theme.small_text, colour::kAmber, tracker.why);
    }
  }
  rest.take_top(theme.px(8));
  if (std::exchange(address_was_open_, address_.is_open()) && !address_.is_open() && !typed_address_.empty())
    attempt([&] {
      page.choose_tracker(tracker_uri_of(trimmed(typed_address_)));
      typed_address_.clear();
    });
  const Rect field = rest.take_top(theme.px(36));
  (*places_)["tracker_address"] = field;
  ImGui::PushID("address");
  typed_address_ = address_.draw(theme, field, typed_address_, "On the network: HOST:18944");
  draw_tooltip(theme, field, "A computer that sends poses by OpenIGTLink, such as one with PLUS or 3D Slicer");
  ImGui::PopID();
  if (!chosen.empty()) attempt([&] { page.choose_tracker(chosen); });
}

void StartPanel::draw_attempts(const Theme& theme, Rect panel, StartPage& page) {
  Rect rest = draw_column_panel(theme, panel, "Done before");
  const std::vector<AttemptSummary> attempts = page.attempts();
  if (!page.database().empty()) {
    const std::string file = "In " + page.database().string();
    draw_paragraph(rest.take_bottom(paragraph_height(theme.small_text, file, rest.w)), theme.small_text, colour::kMuted,
                   file);
    rest.take_bottom(theme.px(4));
  }
  if (attempts.empty())
    return void(draw_paragraph(rest, theme.text, colour::kMuted, "Nothing yet. What you practise is kept here."));
  const float height = theme.px(46);
  const ScrollArea area(theme, "done_before", whole_rows(rest, height), height * float(attempts.size()));
  Rect content = area.content();
  for (const AttemptSummary& attempt : attempts) {
    const Rect row = content.take_top(height);
    if (!area.shows(row)) continue;
    const std::string id = "attempt_" + std::to_string(attempt.number);
    if (area.shows_all_of(row)) (*places_)[id] = row;
    ImGui::SetCursorScreenPos(row.min());
    const bool clicked = ImGui::InvisibleButton(id.c_str(), {row.w, row.h});
    if (ImGui::IsItemHovered()) fill(row, colour::kRaised, theme.px(4));
    draw_tooltip(theme, row, "Replay this run");
    if (clicked)
      for (std::size_t i = 0; i < page.runs().size(); ++i)
        if (page.runs()[i].replay.attempt == attempt.number) {
          page.task = Task::replay;
          page.run = i;
        }
    Rect lines = row.inset(theme.px(8), theme.px(3));
    Rect upper = lines.take_top(theme.px(21));
    draw_text(upper.take_right(theme.px(64)), theme.strong, attempt.passed ? colour::kAccent : colour::kText,
              fixed(attempt.percent, 1) + " %", Align::right);
    draw_text(upper, theme.text, colour::kText, attempt.title);
    const std::string who = attempt.learner == kNobodyInParticular ? "" : attempt.learner + ", ";
    draw_text(lines, theme.small_text, colour::kMuted,
              who + (attempt.mode ? name_of(attempt.mode) + ", " : "") + time_text(attempt.finished_ms / 1000));
  }
}

}  // namespace insonate::ui
