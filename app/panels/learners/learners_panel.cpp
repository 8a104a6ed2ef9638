#include "app/panels/learners/learners_panel.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "app/panels/learners/criteria_list.h"
#include "app/panels/learners/score_chart.h"
#include "app/panels/scan/exam_panel.h"
#include "app/panels/start/start_list.h"
#include "app/panels/widgets/choice_rows.h"
#include "app/panels/widgets/scroll_area.h"
#include "app/trainer/folder_list.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr float kLearnerRow = 46;  // of two lines

std::string counted(int count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

const char* name_of_choice(AttemptMode mode) {
  switch (mode) {
    case AttemptMode::exam:
      return "Exams";
    case AttemptMode::practice:
      return "Practice";
    case AttemptMode::recording:
      return "Recorded";
  }
  return "";
}

/// Draws a panel with its title, and returns what is left of it.
Rect begin_panel(const Theme& theme, const Rect& panel, std::string_view title) {
  fill(panel, colour::kPanel, theme.px(8));
  Rect rest = panel.inset(theme.px(18), theme.px(14));
  draw_text(rest.take_top(theme.px(22)), theme.strong, colour::kText, title);
  rest.take_top(theme.px(8));
  return rest;
}

/// Texts of a row: two lines, each with a part on the left and one on the right.
struct RowTexts {
  std::string upper, upper_right, lower, lower_right;
  std::size_t comments = 0;  ///< shown as a speech bubble and their number, before lower_right
  ImU32 right_ink = colour::kText;
};

/// Draws a speech bubble in the middle of `where`.
void draw_bubble(const Theme& theme, const Rect& where, ImU32 ink) {
  const ImVec2 centre = where.centre();
  const float half = theme.px(6), top = std::round(centre.y - theme.px(5)), bottom = std::round(centre.y + theme.px(3));
  fill({centre.x - half, top, 2 * half, bottom - top}, ink, theme.px(2));
  ImGui::GetWindowDrawList()->AddTriangleFilled({centre.x - theme.px(3), bottom}, {centre.x + theme.px(1), bottom},
                                                {centre.x - theme.px(3), bottom + theme.px(4)}, ink);
}

/// Draws a row of two lines that can be clicked. Returns whether it was.
bool draw_row(const Theme& theme, const Rect& row, const char* id, const RowTexts& texts, bool chosen) {
  ImGui::SetCursorScreenPos(row.min());
  const bool clicked = ImGui::InvisibleButton(id, {row.w, row.h});
  if (chosen)
    fill(row, colour::kAccentDark, theme.px(4));
  else if (ImGui::IsItemHovered())
    fill(row, colour::kRaised, theme.px(4));
  const auto line = [&](Rect where, ImFont* left_font, ImFont* right_font, ImU32 left_ink, ImU32 right_ink,
                        const std::string& left, const std::string& right) {
    if (!right.empty()) {
      draw_text(where.take_right(text_width(right_font, right) + 1), right_font, right_ink, right, Align::right);
      where.take_right(theme.px(10));
    }
    draw_text(where, left_font, left_ink, left);
  };
  const ImU32 quiet = chosen ? colour::kText : colour::kMuted;
  Rect lines = row.inset(theme.px(10), theme.px(3));
  line(lines.take_top(theme.px(21)), theme.text, theme.strong, colour::kText, chosen ? colour::kText : texts.right_ink,
       texts.upper, texts.upper_right);
  Rect lower = lines.take_top(theme.px(19));
  if (texts.comments > 0) {
    Rect rest = lower;
    rest.take_right(theme.px(44));  // of the time
    const std::string number = std::to_string(texts.comments);
    draw_text(rest.take_right(text_width(theme.small_text, number) + 1), theme.small_text, quiet, number);
    rest.take_right(theme.px(4));
    draw_bubble(theme, rest.take_right(theme.px(13)), quiet);
    lower.w = rest.x + rest.w - theme.px(8) - lower.x;
    line({rest.x + rest.w, lower.y, lines.x + lines.w - rest.x - rest.w, lower.h}, theme.small_text, theme.small_text,
         quiet, quiet, "", texts.lower_right);
  }
  line(lower, theme.small_text, theme.small_text, quiet, quiet, texts.lower,
       texts.comments > 0 ? "" : texts.lower_right);
  return clicked;
}

/// Returns the best score of each kind of attempt. Recorded scans are somebody's only where there is nothing else.
std::string best_of(const LearnerLine& learner) {
  std::string text;
  for (const auto& [mode, percent] : learner.best_percent)
    if (mode != AttemptMode::recording || learner.best_percent.size() == 1)
      text += (text.empty() ? "" : ", ") + name_of(mode) + " " + fixed(percent, 1);
  return text + " %";
}

RowTexts texts_of(const LearnerLine& learner) {
  RowTexts texts;
  texts.upper = learner.id.empty() ? "All learners" : learner.id;
  texts.lower = counted(learner.attempts, "attempt", "attempts");
  if (learner.exams > 0)
    texts.lower +=
        ", " + std::to_string(learner.passed_exams) + "/" + counted(learner.exams, "exam", "exams") + " passed";
  if (learner.attempts > 0) {
    if (!learner.id.empty()) texts.upper_right = best_of(learner);  // the best of all is nobody's in particular
    texts.lower_right = time_text(learner.last_ms / 1000).substr(0, 10);
  }
  return texts;
}

RowTexts texts_of(const AttemptSummary& attempt, const LearnersPage& page) {
  RowTexts texts;
  texts.upper = (page.choice().learner.empty() ? attempt.learner + ", " : "") + attempt.title;
  texts.upper_right = fixed(attempt.percent, 1) + " %";
  if (attempt.passed) texts.right_ink = colour::kAccent;
  texts.lower = time_text(attempt.finished_ms / 1000) + (attempt.mode ? ", " + name_of(attempt.mode) : "") +
                (attempt.passed ? ", passed" : ", not passed");
  if (const std::optional<double> time_s = page.time_s(attempt.number)) texts.lower_right = clock_text(*time_s);
  if (const std::size_t comments = page.comments_on(attempt.number); comments > 0) texts.comments = comments;
  return texts;
}

}  // namespace

LearnersAnswer LearnersPanel::draw(const Theme& theme, const Rect& screen, LearnersPage& page, const Run& run,
                                   std::map<std::string, Rect>& places) {
  places_ = &places;
  Rect rest = screen.inset(theme.px(24), theme.px(16));
  const Rect head = rest.take_top(theme.px(48));
  rest.take_top(theme.px(12));
  LearnersAnswer answer = draw_head(theme, head, page);
  const Rect foot = rest.take_bottom(theme.px(24));
  rest.take_bottom(theme.px(8));
  draw_text(foot, theme.small_text, page.problem().empty() ? colour::kMuted : colour::kAmber,
            page.problem().empty() ? "\u2191 \u2193 choose a learner    Enter review the attempt    Esc start page"
                                   : page.problem());
  draw_tooltip(theme, foot, page.problem());

  const float gap = theme.px(16);
  const Rect left = rest.take_left(theme.text_px(300));
  rest.take_left(gap);
  Rect right = rest.take_right(theme.text_px(372));
  rest.take_right(gap);
  draw_learners(theme, left, page);
  const Rect scores = rest.take_top(std::round(rest.h * 0.45f));
  rest.take_top(gap);
  draw_scores(theme, scores, page);
  draw_criteria(theme, rest, page);
  const Rect attempts = right.take_top(std::round(right.h * 0.45f));
  right.take_top(gap);
  draw_attempts(theme, attempts, page);
  if (const LearnersAnswer of_attempt = draw_attempt(theme, right, page, run); of_attempt != LearnersAnswer::none)
    answer = of_attempt;
  return answer;
}

LearnersAnswer LearnersPanel::draw_head(const Theme& theme, Rect head, const LearnersPage& page) {
  LearnersAnswer answer = LearnersAnswer::none;
  const auto next = [&](const char* id, float width, const char* text, LearnersAnswer means) {
    const Rect place = (*places_)[id] = head.take_right(theme.text_px(width)).inset(0, theme.px(6));
    head.take_right(theme.px(8));
    if (button(theme, id, place, text)) answer = means;
  };
  next("help_page", 110, "Help  (F1)", LearnersAnswer::help);
  next("start_page", 150, "Start page  (Esc)", LearnersAnswer::leave);
  next("write_tables", 210, "Write all as CSV tables", LearnersAnswer::tables);
  draw_text(head.take_left(text_width(theme.title, "Learners") + theme.px(16)), theme.title, colour::kText, "Learners");
  head.y += theme.px(4);
  draw_text(head, theme.text, colour::kMuted, "In " + page.database().string());
  draw_tooltip(theme, head, page.database().string());
  return answer;
}

void LearnersPanel::draw_learners(const Theme& theme, const Rect& panel, LearnersPage& page) {
  fill(panel, colour::kPanel, theme.px(8));
  const float height = theme.px(kLearnerRow);
  const ScrollArea area(theme, "learners", whole_rows(panel.inset(theme.px(8), theme.px(8)), height),
                        height * float(page.learners().size()));
  Rect rest = area.content();
  std::optional<std::string> clicked;
  const bool moved = std::exchange(seen_learner_, page.choice().learner) != page.choice().learner;
  for (const LearnerLine& learner : page.learners()) {
    const Rect row = rest.take_top(height);
    const bool chosen = learner.id == page.choice().learner;
    if (chosen && moved) area.bring_into_view(row);
    if (!area.shows(row)) continue;
    const std::string id = learner.id.empty() ? "all_learners" : "learner_" + learner.id;
    if (area.shows_all_of(row)) (*places_)[id] = row;
    if (draw_row(theme, row, id.c_str(), texts_of(learner), chosen)) clicked = learner.id;
    draw_tooltip(theme, row, "The best score of each kind of attempt");
  }
  if (clicked) page.choose_learner(*clicked);
}

void LearnersPanel::draw_scores(const Theme& theme, const Rect& panel, LearnersPage& page) {
  fill(panel, colour::kPanel, theme.px(8));
  Rect rest = panel.inset(theme.px(18), theme.px(14));
  if (page.attempts().empty())
    return void(draw_paragraph(rest, theme.text, colour::kMuted, "Nobody has finished a scenario yet."));
  const std::vector<AttemptedScenario>& scenarios = page.scenarios();
  const auto shown = std::size_t(
      std::find_if(scenarios.begin(), scenarios.end(),
                   [&](const AttemptedScenario& scenario) { return scenario.digest == page.choice().scenario; }) -
      scenarios.begin());
  const std::size_t count = scenarios.size();
  Rect line = rest.take_top(theme.px(kChoiceRow));
  rest.take_top(theme.px(8));
  const auto arrow = [&](const char* id, const char* text, std::size_t leads_to) {
    const Rect place = (*places_)[id] = line.take_left(theme.px(36));
    line.take_left(theme.px(8));
    if (button(theme, id, place, text, ButtonKind::normal, count > 1)) page.choose_scenario(scenarios[leads_to].digest);
  };
  // A copy, because choosing another scenario lists them anew.
  const std::string title = scenarios[shown].title +
                            (count > 1 ? "  (" + std::to_string(shown + 1) + " of " + std::to_string(count) + ")" : "");
  arrow("scenario_before", "\u2190", (shown + count - 1) % count);
  arrow("scenario_after", "\u2192", (shown + 1) % count);
  draw_text(line, theme.heading, colour::kText, title);
  if (page.modes().size() > 1) {
    std::vector<Choice> choices{{"mode_all", "All", page.choice().mode ? ButtonKind::normal : ButtonKind::chosen}};
    for (const AttemptMode mode : page.modes())
      choices.push_back({"mode_" + name_of(mode), name_of_choice(mode),
                         page.choice().mode == mode ? ButtonKind::chosen : ButtonKind::normal});
    const Rect row = rest.take_top(theme.px(kChoiceRow));
    rest.take_top(theme.px(8));
    if (const auto clicked = row_of_choices(theme, row, choices, *places_))
      page.choose_mode(*clicked == 0 ? std::nullopt : std::optional(page.modes()[*clicked - 1]));
  }
  const bool group = page.choice().learner.empty();
  if (group && page.trend().mixes_modes) {
    draw_text(rest.take_bottom(theme.px(20)), theme.small_text, colour::kMuted,
              "Median and quartiles are of one kind of attempt: choose it above.");
    rest.take_bottom(theme.px(2));
  }
  (*places_)["score_chart"] = rest;
  if (const std::int64_t clicked = draw_score_chart(theme, rest, page.trend(), page.choice().attempt, group))
    page.choose_attempt(clicked);
}

void LearnersPanel::draw_criteria(const Theme& theme, const Rect& panel, const LearnersPage& page) {
  const Rect rest = begin_panel(theme, panel, "Where points are lost");
  draw_criteria_list(theme, rest, page.trend());
}

void LearnersPanel::draw_attempts(const Theme& theme, const Rect& panel, LearnersPage& page) {
  Rect rest = begin_panel(theme, panel, "Attempts");
  rest = {rest.x - theme.px(10), rest.y, rest.w + theme.px(20), rest.h};
  const float height = theme.px(kLearnerRow);
  const ScrollArea area(theme, "attempts", whole_rows(rest, height), height * float(page.attempts().size()));
  std::int64_t clicked = 0;
  const LearnersChoice& choice = page.choice();
  const std::string list = choice.learner + " " + name_of(choice.mode) + " " + std::to_string(choice.attempt);
  const bool moved = std::exchange(seen_list_, list) != list;
  for (std::size_t i = 0; i < page.attempts().size(); ++i) {
    const AttemptSummary& attempt = page.attempts()[i];
    const Rect row{area.content().x, area.content().y + height * float(i), area.content().w, height};
    const bool chosen = attempt.number == choice.attempt;
    if (chosen && moved) area.bring_into_view(row);
    if (!area.shows(row)) continue;
    const std::string id = "attempt_" + std::to_string(attempt.number);
    if (area.shows_all_of(row)) (*places_)[id] = row;
    if (draw_row(theme, row, id.c_str(), texts_of(attempt, page), chosen)) clicked = attempt.number;
  }
  if (clicked != 0) page.choose_attempt(clicked);
}

LearnersAnswer LearnersPanel::draw_attempt(const Theme& theme, const Rect& panel, LearnersPage& page, const Run& run) {
  const AttemptSummary* attempt = page.attempt();
  const std::string title =
      attempt ? "No. " + std::to_string(attempt->number) + " of the results, by " + attempt->learner : "Comments";
  const Rect rest = begin_panel(theme, panel, title);
  switch (attempt_.draw(theme, rest, page, run, *places_)) {
    case AttemptRequest::none:
      break;
    case AttemptRequest::review:
      return LearnersAnswer::review;
    case AttemptRequest::report:
      return LearnersAnswer::report;
  }
  return LearnersAnswer::none;
}

}  // namespace insonate::ui
