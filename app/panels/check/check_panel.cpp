#include "app/panels/check/check_panel.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "app/panels/widgets/scroll_area.h"
#include "sim/core/text.h"

namespace insonate::ui {
namespace {

constexpr float kLine = 23;

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Returns a sentence of what begins in small letters and ends without a full stop.
std::string sentence(std::string text) {
  if (text.empty()) return text;
  text.front() = char(std::toupper(static_cast<unsigned char>(text.front())));
  return text.back() == '?' ? text : text + ".";
}

std::string place_of(const Mistake& problem) {
  if (problem.place.line <= 0) return "The whole file";
  return "Line " + std::to_string(problem.place.line) + ", column " + std::to_string(problem.place.column);
}

struct Verdict {
  std::string text;
  ImU32 edge = 0, ink = 0;
};

Verdict verdict_of(const CheckPage& page) {
  if (!page.failure().empty()) return {page.failure(), colour::kAmber, colour::kAmber};
  if (!page.problems().empty())
    return {counted(page.problems().size(), "problem", "problems") +
                (page.state() == CheckPage::State::checking ? " so far" : ""),
            colour::kAmber, colour::kAmber};
  if (page.state() == CheckPage::State::checking) return {"Checking\u2026", colour::kLine, colour::kText};
  return {"No problems found: \"" + page.title() + "\", " + counted(page.steps(), "step", "steps"), colour::kAccent,
          colour::kText};
}

std::string progress_text(const Loading::Progress& progress) {
  std::string text = progress.what + formatted(", %.0f %%", 100 * progress.share);
  if (progress.left_s) text += formatted("; about %.0f s left", std::max(1.0, *progress.left_s));
  return text;
}

}  // namespace

CheckAnswer CheckPanel::draw(const Theme& theme, const Rect& screen, CheckPage& page,
                             std::map<std::string, Rect>& places) {
  places_ = &places;
  Rect rest = screen.inset(theme.px(24), theme.px(16));
  const CheckAnswer answer = draw_head(theme, rest.take_top(theme.px(48)), page);
  rest.take_top(theme.px(12));
  const Rect foot = rest.take_bottom(theme.px(24));
  rest.take_bottom(theme.px(8));
  draw_text(
      foot, theme.small_text, colour::kMuted,
      "Edit the file in any editor: it is checked again whenever it is saved.    \u2191 \u2193 choose a problem    "
      "Enter practise    Esc start page");
  const Rect right = rest.take_right(std::round(rest.w * 0.4f));
  rest.take_right(theme.px(16));
  draw_text_of(theme, rest, page);
  draw_problems(theme, right, page);
  return answer;
}

CheckAnswer CheckPanel::draw_head(const Theme& theme, Rect head, const CheckPage& page) {
  CheckAnswer answer = CheckAnswer::none;
  const auto next = [&](const char* id, float width, const char* text, CheckAnswer means,
                        ButtonKind kind = ButtonKind::normal, bool enabled = true, std::string_view tip = {}) {
    const Rect place = (*places_)[id] = head.take_right(theme.px(width)).inset(0, theme.px(6));
    head.take_right(theme.px(8));
    if (button(theme, id, place, text, kind, enabled, tip)) answer = means;
  };
  next("help_page", 110, "Help  (F1)", CheckAnswer::help);
  next("start_page", 150, "Start page  (Esc)", CheckAnswer::leave);
  next("open_page", 100, "Open\u2026", CheckAnswer::open, ButtonKind::normal, true,
       "Checks another scenario file  (Ctrl O)");
  next("practise", 160, "Practise  (Enter)", CheckAnswer::practise, ButtonKind::primary,
       page.state() == CheckPage::State::right, "Begins this scenario as a learner practises it  (Enter)");
  const std::string name = page.file().filename().string();
  draw_text(head.take_left(std::min(head.w, text_width(theme.title, name) + theme.px(16))), theme.title, colour::kText,
            name);
  head.y += theme.px(4);
  const std::string where = "In " + std::filesystem::absolute(page.file()).parent_path().string() +
                            (page.case_folder().empty() ? "" : ", on " + page.case_folder().string());
  draw_text(head, theme.text, colour::kMuted, where);
  draw_tooltip(theme, head, where);
  return answer;
}

void CheckPanel::draw_text_of(const Theme& theme, const Rect& panel, const CheckPage& page) {
  fill(panel, colour::kPanel, theme.px(8));
  std::set<int> wrong;
  for (const Mistake& problem : page.problems()) wrong.insert(problem.place.line);
  const std::optional<std::size_t> chosen = page.chosen();
  const int chosen_line = chosen ? page.problems()[*chosen].place.line : 0;
  // A text that has changed elsewhere stays where it is.
  const bool moved = chosen && std::exchange(shown_, chosen) != chosen;
  const float height = theme.px(kLine);
  const ScrollArea area(theme, "text", whole_rows(panel.inset(theme.px(8), theme.px(10)), height),
                        height * float(page.lines().size()));
  const float numbers = text_width(theme.small_text, "0000") + theme.px(10);
  Rect rest = area.content();
  for (std::size_t i = 0; i < page.lines().size(); ++i) {
    Rect row = rest.take_top(height);
    const int number = int(i) + 1;
    if (number == chosen_line && moved) area.bring_into_view(row);
    if (!area.shows(row)) continue;
    const bool is_wrong = wrong.contains(number);
    if (is_wrong) {
      fill(row, number == chosen_line ? colour::kAccentDark : colour::kRaised, theme.px(3));
      fill({row.x, row.y, theme.px(4), row.h}, colour::kAmber, theme.px(2));
      if (area.shows_all_of(row)) (*places_)["line_" + std::to_string(number)] = row;
    }
    draw_text(row.take_left(numbers), theme.small_text, is_wrong ? colour::kText : colour::kFaint,
              std::to_string(number), Align::right);
    row.take_left(theme.px(12));
    draw_text(row, theme.text, colour::kText, page.lines()[i]);
  }
}

void CheckPanel::draw_problems(const Theme& theme, Rect panel, CheckPage& page) {
  const Verdict verdict = verdict_of(page);
  const float edge = theme.px(6), dx = theme.px(16), dy = theme.px(12);
  const float wide = panel.w - edge - 2 * dx;
  const float text = paragraph_height(theme.heading, verdict.text, wide);
  const std::optional<Loading::Progress> progress = page.progress();
  const std::string how_far = progress ? progress_text(*progress) : "";
  const float gap = theme.px(8), below = progress ? gap + paragraph_height(theme.small_text, how_far, wide) : 0;
  Rect plate = panel.take_top(text + below + 2 * dy);
  panel.take_top(theme.px(12));
  fill(plate, colour::kRaised, theme.px(4));
  fill(plate.take_left(edge), verdict.edge, theme.px(3));
  plate = plate.inset(dx, dy);
  draw_paragraph(plate.take_top(text), theme.heading, verdict.ink, verdict.text);
  plate.take_top(gap);
  if (progress) draw_paragraph(plate, theme.small_text, colour::kMuted, how_far);

  const float line = theme.px(22), between = theme.px(8), inner = panel.w - 2 * dx - theme.px(14);
  const auto height_of = [&](const Mistake& problem) {
    return line + paragraph_height(theme.text, sentence(problem.problem), inner) +
           paragraph_height(theme.text, sentence(problem.remedy), inner) + theme.px(20);
  };
  float height = 0;
  for (const Mistake& problem : page.problems()) height += height_of(problem) + between;
  const std::optional<std::size_t> chosen = page.chosen();
  std::optional<std::size_t> clicked;
  const ScrollArea area(theme, "problems", panel, height);
  Rect rest = area.content();
  for (std::size_t i = 0; i < page.problems().size(); ++i) {
    const Mistake& problem = page.problems()[i];
    const Rect card = rest.take_top(height_of(problem));
    rest.take_top(between);
    if (!area.shows(card)) continue;
    const std::string id = "problem_" + std::to_string(i);
    if (area.shows_all_of(card)) (*places_)[id] = card;
    ImGui::SetCursorScreenPos(card.min());
    if (ImGui::InvisibleButton(id.c_str(), {card.w, card.h})) clicked = i;
    fill(card,
         i == chosen              ? colour::kAccentDark
         : ImGui::IsItemHovered() ? colour::kRaised
                                  : colour::kPanel,
         theme.px(6));
    Rect lines = card.inset(dx, theme.px(10));
    lines.w = inner;
    draw_text(lines.take_top(line), theme.strong, colour::kText, place_of(problem));
    lines.h += theme.px(4);  // a paragraph is not drawn below its rectangle
    lines.take_top(draw_paragraph(lines, theme.text, colour::kText, sentence(problem.problem)));
    draw_paragraph(lines, theme.text, i == chosen ? colour::kText : colour::kMuted, sentence(problem.remedy));
  }
  if (clicked) page.choose(*clicked);
}

}  // namespace insonate::ui
