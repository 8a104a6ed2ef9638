#include "app/panels/scan/author_panel.h"

#include <vector>

#include "app/panels/widgets/choice_rows.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr float kTitleWidth = 300, kKeep = 150;

/// Returns what to do next.
std::string prompt(const Author& author) {
  if (author.title().empty())
    return author.kept().empty() ? "Give the view a title, as learners are to read it." : author.kept();
  return author.ready() ? "Keep it, or move on (Space)." : "Click what the view must show.";
}

void draw_parts(const Theme& theme, const Rect& where, Author& author, std::map<std::string, Rect>& places) {
  std::vector<Choice> choices;
  for (const Author::Part& part : author.parts())
    choices.push_back({"part_" + part.name, in_words(part.name) + (part.landmark ? " (point)" : ""),
                       part.wanted ? ButtonKind::chosen : ButtonKind::normal});
  if (const auto clicked = flow_of_choices(theme, where, choices, places)) author.toggle(*clicked);
}

}  // namespace

float author_panel_height(const Theme& theme) {
  return theme.px(2 * kMargin + kChoiceRow + 2 * kSecondChoiceRow);
}

void draw_author_panel(const Theme& theme, const Rect& panel, Trainer& trainer, TextField& field,
                       std::map<std::string, Rect>& places) {
  Author& author = *trainer.author();
  fill(panel, colour::kPanel, theme.px(4));
  Rect rest = panel.inset(theme.px(16), theme.px(kMargin));
  if (author.parts().empty()) {
    field.close();
    const bool frozen = trainer.session()->frozen_picture().has_value();
    draw_text(rest.take_bottom(theme.px(kChoiceRow)), theme.small_text, colour::kMuted, author.kept());
    return draw_text(rest.take_top(theme.px(kChoiceRow)), theme.text, colour::kText,
                     frozen ? "The picture shows no structure and no landmark of this case."
                            : "Hold the probe as a learner is to hold it, then freeze the picture (Space).");
  }
  Rect title = rest.take_left(theme.px(kTitleWidth));
  title.h = theme.px(kChoiceRow);
  places["text_field"] = title;
  author.title(field.draw(theme, title, author.title(), "Title of the view"));
  draw_paragraph({title.x, title.y + theme.px(kSecondChoiceRow), title.w, rest.h - theme.px(kSecondChoiceRow)},
                 theme.small_text, author.ready() ? colour::kAccent : colour::kMuted, prompt(author));
  rest.take_left(theme.px(16));
  Rect right = rest.take_right(theme.px(kKeep));
  right.h = theme.px(kChoiceRow);
  rest.take_right(theme.px(16));
  places["keep_view"] = right;
  if (button(theme, "keep_view", right, "Keep view (Enter)", ButtonKind::primary, author.ready())) trainer.keep_view();
  draw_parts(theme, rest, author, places);
}

}  // namespace insonate::ui
