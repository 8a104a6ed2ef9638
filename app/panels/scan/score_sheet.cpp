#include "app/panels/scan/score_sheet.h"

#include <algorithm>

#include "app/panels/pages/overlays.h"
#include "app/panels/scan/exam_panel.h"
#include "app/panels/widgets/scroll_area.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

std::string outcome_text(const StepResult& step) {
  const std::string after = is_done(step.outcome) ? " after " + fixed(step.end_s - step.start_s, 1) + " s" : "";
  return in_words(step.outcome) + after + "; " + score_in_words(step);
}

struct SheetColumns {
  Rect criterion, value, limits, points;
};

SheetColumns columns_of(const Theme& theme, Rect row) {
  SheetColumns columns;
  columns.points = row.take_right(theme.px(84));
  columns.limits = row.take_right(theme.px(150));
  columns.value = row.take_right(theme.px(90));
  columns.criterion = row;
  return columns;
}

void draw_verdict(const Theme& theme, Rect head, const ExamResult& result, const std::string& learner,
                  std::map<std::string, Rect>& places) {
  const ImU32 colour = result.passed ? colour::kAccent : colour::kRed;
  draw_text(head.take_right(theme.px(190)), theme.huge, colour, percentage(result) + " %", Align::right);
  draw_text(head.take_top(theme.px(26)), theme.heading, colour::kText, result.title);
  Rect verdict = head.take_top(theme.px(24));
  const std::string word = result.passed ? "Passed" : "Not passed";
  draw_text(verdict.take_left(text_width(theme.strong, word) + 1), theme.strong, colour, word);
  if (!learner.empty()) {
    verdict.take_left(theme.px(16));
    draw_text(places["learner"] = verdict, theme.strong, colour::kText, "Learner: " + learner);
  }
  std::string line = short_number(result.points) + " of " + short_number(result.points_possible) + " points; " +
                     short_number(result.pass_mark_percent) + " % are needed";
  if (result.provenance.mode == AttemptMode::practice) line += "; practice, which does not count as an exam";
  draw_text(head.take_top(theme.px(20)), theme.small_text, colour::kMuted, line);
}

/// Returns whether a line below a mark says why: where points are missing. The report says it of every mark.
bool has_reason(const CriterionScore& mark) {
  return mark.points < mark.weight && !mark.why.empty();
}

void draw_mark(const Theme& theme, const Rect& row, const CriterionScore& mark) {
  const SheetColumns columns = columns_of(theme, row);
  const double share = mark.weight > 0 ? mark.points / mark.weight : 1;
  const ImU32 ink = mark.fails_exam() ? colour::kRed : share < 0.5 ? colour::kAmber : colour::kText;
  const std::string name = (mark.critical ? "Critical: " : "") + title_of(mark.metric);
  draw_text(columns.criterion, theme.text, mark.fails_exam() ? colour::kRed : colour::kText, name);
  draw_text(columns.value, theme.text, ink, mark.value ? in_words(mark.metric, *mark.value) : "\u2013", Align::right);
  draw_text(columns.limits, theme.small_text, colour::kMuted,
            in_words(mark.metric, mark.full) + " \u2013 " + in_words(mark.metric, mark.zero), Align::right);
  draw_text(columns.points, theme.text, ink, short_number(mark.points) + " / " + short_number(mark.weight),
            Align::right);
  const std::string why = has_reason(mark) ? "" : mark.why;
  draw_tooltip(theme, row, mark.critical ? why + (why.empty() ? "" : " ") + kCriticalMeans : why);
}

float reason_indent(const Theme& theme) {
  return theme.px(16);
}

/// Returns the height of rows of text whose first line is a row, since some texts take several lines.
float height_of(const Theme& theme, const std::string& text, float row, float width) {
  return row + std::max(0.0f, paragraph_height(theme.small_text, text, width) - theme.small_text->FontSize);
}

float height_of(const Theme& theme, const std::vector<CriterionScore>& marks, float row, float width) {
  float height = row * float(marks.size());
  for (const CriterionScore& mark : marks)
    if (has_reason(mark)) height += height_of(theme, mark.why, row, width - reason_indent(theme));
  return height;
}

/// Draws a text whose first line is in the middle of a row.
/// @param width  with which height_of() has been asked
void draw_lines(const Theme& theme, Rect rows, float row, float width, ImU32 ink, const std::string& text) {
  rows.w = width;
  rows.y += (row - theme.small_text->FontSize) / 2;
  draw_paragraph(rows, theme.small_text, ink, text);
}

void draw_marks(const Theme& theme, Rect& rows, float row, const std::vector<CriterionScore>& marks, float width) {
  for (const CriterionScore& mark : marks) {
    draw_mark(theme, rows.take_top(row), mark);
    if (!has_reason(mark)) continue;
    const float indent = reason_indent(theme);
    Rect reason = rows.take_top(height_of(theme, mark.why, row, width - indent));
    reason.y -= theme.px(4);
    reason.take_left(indent);
    draw_lines(theme, reason, row, width - indent, colour::kMuted, mark.why);
  }
}

using Fact = std::pair<std::string, std::string>;

float name_width(const Theme& theme, const Fact& fact) {
  return text_width(theme.small_text, title_of_fact(fact.first, fact.second) + ": ") + 1;
}

float height_of(const Theme& theme, const Fact& fact, float row, float width) {
  return height_of(theme, fact.second, row, width - name_width(theme, fact));
}

/// What the step has found out besides values, such as what was measured.
void draw_fact(const Theme& theme, Rect rows, float row, float width, const Fact& fact) {
  Rect name = rows.take_left(name_width(theme, fact));
  draw_text(name.take_top(row), theme.small_text, colour::kMuted, title_of_fact(fact.first, fact.second) + ": ");
  draw_lines(theme, rows, row, width - name_width(theme, fact), colour::kText, fact.second);
}

void draw_column_titles(const Theme& theme, const Rect& row) {
  const SheetColumns columns = columns_of(theme, row);
  draw_text(columns.value, theme.small_text, colour::kFaint, "Value", Align::right);
  draw_text(columns.limits, theme.small_text, colour::kFaint, "All points \u2013 none", Align::right);
  draw_text(columns.points, theme.small_text, colour::kFaint, "Points", Align::right);
}

void draw_group(const Theme& theme, const Rect& row, const std::string& title, const std::string& remark) {
  Rect line = row;
  line.y += theme.px(6);
  line.h -= theme.px(6);
  draw_text(line, theme.strong, colour::kText, title);
  draw_text(line, theme.small_text, colour::kMuted, remark, Align::right);
  ImGui::GetWindowDrawList()->AddLine({row.x, row.y + row.h}, {row.x + row.w, row.y + row.h}, colour::kLine);
}

/// Returns the reasons for not passing, as many as leave room for the rows, and how many there are besides.
std::vector<std::string> shown_reasons(const std::vector<std::string>& reasons) {
  constexpr std::size_t kMax = 6;
  if (reasons.size() <= kMax) return reasons;
  std::vector<std::string> shown(reasons.begin(), reasons.begin() + kMax - 1);
  shown.push_back("and " + std::to_string(reasons.size() - shown.size()) + " more, which the report names");
  return shown;
}

float height_of(const Theme& theme, const ExamResult& result, float row, float width) {
  float height = row * float(result.steps.size() + 1) + height_of(theme, result.criteria, row, width);
  for (const StepResult& step : result.steps) {
    height += height_of(theme, step.criteria, row, width);
    for (const Fact& fact : step.facts) height += height_of(theme, fact, row, width);
  }
  return height;
}

void draw_rows(const Theme& theme, Rect rows, float height, const ExamResult& result, float width) {
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const StepResult& step = result.steps[i];
    draw_group(theme, rows.take_top(height), std::to_string(i + 1) + "  " + step.title, outcome_text(step));
    for (const Fact& fact : step.facts)
      draw_fact(theme, rows.take_top(height_of(theme, fact, height, width)), height, width, fact);
    draw_marks(theme, rows, height, step.criteria, width);
  }
  if (result.criteria.empty()) return;
  draw_group(theme, rows.take_top(height), "The whole exam", clock_text(result.motion.time_s));
  draw_marks(theme, rows, height, result.criteria, width);
}

}  // namespace

ScoreAnswer draw_score_sheet(const Theme& theme, const Rect& screen, const ExamResult& result,
                             const std::optional<ResultFiles>& files, bool writing, bool watched, bool once,
                             const std::string& learner, std::map<std::string, Rect>& places) {
  const float row = theme.px(26), head_height = theme.px(74), reason_height = theme.px(22);
  const std::vector<std::string> reasons = shown_reasons(result.reasons);
  const float sheet_width = std::min(theme.px(860), screen.w - theme.px(40));
  const float line_width = sheet_width - 2 * theme.px(28) - theme.px(14);  // without margins and a scroll bar
  const float rows_height = height_of(theme, result, row, line_width);
  const float others =
      theme.px(48) + row + head_height + theme.px(20) + reason_height * float(reasons.size()) + theme.px(104);
  const float height = std::min(screen.h - theme.px(40), rows_height + others);
  Rect sheet = begin_overlay(theme, screen, {sheet_width, height});
  draw_verdict(theme, sheet.take_top(head_height), result, learner, places);
  sheet.take_top(theme.px(8));
  for (const std::string& reason : reasons)
    draw_text(sheet.take_top(reason_height), theme.small_text, colour::kAmber, reason);
  sheet.take_top(theme.px(4));
  Rect titles = sheet.take_top(row);
  Rect bottom = sheet.take_bottom(theme.px(92));
  {
    const ScrollArea area(theme, "marks", sheet, rows_height);
    draw_rows(theme, area.content(), row, result, line_width);
    titles.w = area.content().w;  // above their columns
  }
  draw_column_titles(theme, titles);

  ScoreAnswer answer = ScoreAnswer::none;
  bottom.take_top(theme.px(12));
  draw_text(bottom.take_top(theme.px(24)), theme.small_text, files || writing ? colour::kMuted : colour::kAmber,
            files     ? "Report: " + std::filesystem::absolute(files->report).string()
            : writing ? "Writing the report \u2026"
                      : "The report could not be written.");
  bottom.take_top(theme.px(14));
  Rect buttons = bottom.take_top(theme.px(40));
  const float gap = theme.px(8);
  const float width = (buttons.w - 4 * gap) / 5;
  const auto next = [&] {
    const Rect place = buttons.take_right(width);
    buttons.take_right(gap);
    return place;
  };
  if (button(theme, "close_sheet", next(), "Close", ButtonKind::normal, true,
             "Leaves the sheet and stays with the patient  (Esc); F4 shows it again"))
    answer = ScoreAnswer::close;
  if (button(theme, "open_report", next(), "Open the report", ButtonKind::normal, files.has_value(),
             "Every step and criterion with its reason, pictures and the probe's path, in the browser"))
    answer = ScoreAnswer::open_report;
  if (!watched && button(theme, "leave_sheet", next(), "Start page",
                         result.passed && !once ? ButtonKind::primary : ButtonKind::normal))
    answer = ScoreAnswer::leave;
  if (once) {
    end_overlay();
    return answer;
  }
  if (button(theme, "practice_after", next(), "Free practice", ButtonKind::normal, true,
             "Goes on without steps, clock and score"))
    answer = ScoreAnswer::practice;
  if (watched) {
    if (button(theme, "again", next(), "Watch again")) answer = ScoreAnswer::again;
    if (button(theme, "own_try", next(), "Try it yourself", ButtonKind::primary)) answer = ScoreAnswer::own_try;
  } else if (button(theme, "again", next(), "Try again", result.passed ? ButtonKind::normal : ButtonKind::primary)) {
    answer = ScoreAnswer::again;
  }
  end_overlay();
  return answer;
}

}  // namespace insonate::ui
