#include "app/panels/scan/task_panel.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "app/panels/scan/annotation_layer.h"
#include "app/panels/widgets/choice_rows.h"
#include "scenarios/caliper.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr float kStripLine = 24, kTurns = 36;
constexpr float kRight = 320;  ///< of hint and going on

/// What a step lets the learner choose from, as it is shown.
std::vector<std::string> choice_texts(const StepInput& input) {
  if (const auto* question = std::get_if<AnswerInput>(&input)) return question->choices;
  std::vector<std::string> texts;
  if (const auto* labels = std::get_if<LabelInput>(&input))
    for (const std::string& name : labels->names) texts.push_back(in_words(name));
  return texts;
}

void draw_slots(const Theme& theme, Rect where, PictureTools& tools, std::map<std::string, Rect>& places) {
  const MeasureInput& measure = *tools.measuring();
  std::vector<Choice> choices;
  for (int slot = 1; slot <= int(measure.slots.size()); ++slot) {
    const auto placed = tools.annotations().measured().find(slot);
    const std::string value =
        placed == tools.annotations().measured().end() ? "\u2013" : value_text(placed->second.action);
    // The number stands beside the caliper too.
    const std::string number = measure.slots.size() > 1 ? std::to_string(slot) + "  " : "";
    choices.push_back({"slot_" + std::to_string(slot), number + tools.slot_name(slot) + "   " + value,
                       slot == tools.slot() ? ButtonKind::chosen : ButtonKind::normal});
  }
  const float convention = text_width(theme.text, measure.convention);
  draw_text(where.take_left(convention), theme.text, colour::kMuted, measure.convention);
  where.take_left(theme.px(16));
  if (const auto clicked = row_of_choices(theme, where, choices, places)) tools.choose_slot(int(*clicked) + 1);
}

void draw_settings(const Theme& theme, Rect where, const std::vector<SettingsInput::Setting>& settings) {
  const float gap = theme.px(8);
  for (const SettingsInput::Setting& setting : settings) {
    const std::string is = setting.name + "  " + setting.now, asked = "asked: " + setting.wanted;
    const float width = text_width(theme.strong, is) + text_width(theme.small_text, asked) + theme.px(40);
    Rect plate = where.take_left(std::min(width, (where.w - gap)));
    where.take_left(gap);
    fill(plate, setting.right ? colour::kAccentDark : colour::kRaised, theme.px(4));
    Rect text = plate.inset(theme.px(12), 0);
    draw_text(text.take_left(text_width(theme.strong, is) + theme.px(14)), theme.strong, colour::kText, is);
    draw_text(text, theme.small_text, setting.right ? colour::kText : colour::kMuted,
              setting.right ? "as asked" : asked);
  }
}

void draw_question(const Theme& theme, Rect where, StepControls& controls, TextField& field,
                   std::map<std::string, Rect>& places) {
  const AnswerInput& question = *controls.question();
  if (question.is_typed()) {
    const bool number = question.form == AnswerInput::Form::number;
    const float unit = question.unit.empty() ? 0 : text_width(theme.text, question.unit) + theme.px(8);
    const Rect row = where.take_top(theme.px(kChoiceRow));
    const Rect box{row.x, row.y, std::min(row.w, number ? theme.px(180) + unit : theme.px(700)), row.h};
    places["text_field"] = box;
    return controls.draft(
        field.draw(theme, box, controls.draft(), number ? "Type a number" : "Type your answer", question.unit));
  }
  std::vector<Choice> choices;
  for (const std::string& choice : question.choices)
    choices.push_back({"choice_" + std::to_string(choices.size() + 1), choice,
                       choice == controls.draft() ? ButtonKind::chosen : ButtonKind::normal});
  if (const auto clicked = rows_of_choices(theme, where, choices, places)) controls.draft(question.choices[*clicked]);
}

void draw_names(const Theme& theme, const Rect& where, Session& session, PictureTools& tools,
                std::map<std::string, Rect>& places) {
  std::vector<Choice> choices;
  for (const std::string& name : tools.names())
    choices.push_back({"name_" + name, in_words(name),
                       tools.annotations().labels().contains(name) ? ButtonKind::chosen : ButtonKind::normal,
                       tools.unnamed_place().has_value()});
  if (const auto clicked = rows_of_choices(theme, where, choices, places))
    tools.name_place(session, tools.names()[*clicked]);
}

void draw_turns(const Theme& theme, Rect where, Session& session, StepControls& controls,
                const std::vector<StepControls::Turn>& turns, std::map<std::string, Rect>& places) {
  draw_text(where.take_left(theme.px(56)), theme.small_text, colour::kMuted, "Steps");
  std::vector<Choice> choices;
  for (const StepControls::Turn& turn : turns)
    choices.push_back({"turn_" + std::to_string(turn.step + 1), turn.title + (turn.ended ? " (over)" : ""),
                       turn.current ? ButtonKind::chosen : ButtonKind::normal, turn.can_turn || turn.current});
  if (const auto clicked = row_of_choices(theme, where, choices, places))
    controls.turn_to(session, turns[*clicked].step);
}

/// What earlier steps have measured, which a question may be about.
std::string measured_before(const Session& session) {
  std::string words;
  for (const std::string& measured : session.runner()->live().measured)
    words += (words.empty() ? "  You measured " : "; ") + measured;
  return words;
}

/// What to do now, where the instruction does not say it.
std::string prompt(const Session& session, const PictureTools& tools, const StepControls& controls, const Step& step) {
  if (const AnswerInput* question = controls.question())
    return (question->is_typed() ? "Type, then answer. The first answer counts."
                                 : "Choose, then answer. The first answer counts.") +
           measured_before(session);
  if (std::string own = step.task->words().prompt; !own.empty()) return own;
  if (!PictureTools::ready(session)) return "Freeze the picture (Space) first.";
  return tool_prompt(tools) + ". Drag moves what is placed, Backspace takes it back.";
}

std::string hint_text(double cost) {
  if (cost == 0) return "Hint (free)";
  return "Hint (\u2212" + short_number(cost) + (cost == 1 ? " point)" : " points)");
}

/// Returns whether the step has a row of controls above its words.
bool has_controls(const StepInput& input) {
  return !std::holds_alternative<std::monostate>(input) && !std::holds_alternative<PointInput>(input);
}

struct StripWords {
  std::string text;
  ImU32 ink;
};

/// What the strip says: that the step is not done, the hints, or else what to do now.
StripWords words_of(const Session& session, const PictureTools& tools, const StepControls& controls) {
  if (controls.asks_again())
    return {"This step is not done yet. Enter goes on and leaves it as it is, for good; Escape stays.", colour::kAmber};
  const LiveExam& live = session.runner()->live();
  std::string hints;
  for (const std::string& hint : live.hints) hints += (hints.empty() ? "Hint: " : "  ") + hint;
  if (!hints.empty()) return {hints, colour::kAccent};
  const Step& step = session.runner()->scenario().steps[live.step];
  return {prompt(session, tools, controls, step), has_controls(step.task->input()) ? colour::kMuted : colour::kText};
}

float words_width(const Theme& theme, float panel_width) {
  return panel_width - theme.px(2 * 16 + kRight + 16);
}

/// Returns the height of the words, in a line of their own below controls, or in place of them, where they are larger.
float words_height(const Theme& theme, const std::string& text, bool below_controls, float width) {
  return std::max(paragraph_height(below_controls ? theme.small_text : theme.text, text, width),
                  theme.px(below_controls ? kStripLine : kChoiceRow));
}

/// Draws one line in the middle of its height, several from the top on.
void draw_words(const Rect& where, ImFont* font, const StripWords& words) {
  const float height = paragraph_height(font, words.text, where.w);
  draw_paragraph({where.x, where.y + std::round((where.h - height) / 2), where.w, height}, font, words.ink, words.text);
}

}  // namespace

bool has_task_panel(const Session& session) {
  return session.runner() && !session.source().recording();
}

float task_panel_height(const Theme& theme, const Session& session, const PictureTools& tools,
                        const StepControls& controls, float width) {
  if (!StepControls::active(session)) return theme.px(2 * kMargin + kChoiceRow);
  const Scenario& scenario = session.runner()->scenario();
  const StepInput input = scenario.steps[session.runner()->live().step].task->input();
  const float usable = words_width(theme, width);
  float height =
      theme.px(2 * kMargin) + words_height(theme, words_of(session, tools, controls).text, has_controls(input), usable);
  if (has_controls(input)) height += theme.px(kChoiceRow);
  if (need_two_rows(theme, usable, choice_texts(input))) height += theme.px(kSecondChoiceRow);
  if (scenario.order == Scenario::Order::free) height += theme.px(kTurns);
  return height;
}

void draw_task_panel(const Theme& theme, const Rect& panel, Session& session, PictureTools& tools,
                     StepControls& controls, TextField& field, std::map<std::string, Rect>& places) {
  fill(panel, colour::kPanel, theme.px(4));
  const bool typed = controls.question() && controls.question()->is_typed();
  if (!typed) field.close();
  Rect rest = panel.inset(theme.px(16), theme.px(kMargin));
  if (!StepControls::active(session))
    return draw_text(rest, theme.text, colour::kMuted,
                     "The steps are over. You can go on measuring; it no longer counts.");
  const LiveExam& live = session.runner()->live();
  const StepInput input = session.runner()->scenario().steps[live.step].task->input();

  if (const auto turns = StepControls::turns(session); !turns.empty()) {
    draw_turns(theme, rest.take_bottom(theme.px(kTurns - 6)), session, controls, turns, places);
    rest.take_bottom(theme.px(6));
  }
  Rect right = rest.take_right(theme.px(kRight));
  right.h = theme.px(kChoiceRow);
  places["go_on"] = right.take_right(theme.px(150));
  const bool ready = controls.question() ? controls.can_answer() : live.counts_as_done;
  const char* text = controls.question() ? "Answer (Enter)" : controls.asks_again() ? "Go on anyway" : "Go on (Enter)";
  if (button(theme, "go_on", places["go_on"], text,
             controls.asks_again() ? ButtonKind::warning
             : ready               ? ButtonKind::primary
                                   : ButtonKind::normal,
             !controls.question() || ready, controls.question() ? "" : "Ends this step and begins the next  (Enter)"))
    controls.go_on(session);
  right.take_right(theme.px(8));
  if (const auto cost = StepControls::hint_cost(session)) {
    places["hint"] = right;
    if (button(theme, "hint", right, hint_text(*cost), ButtonKind::normal, true,
               "Says more about how to find the view. What it costs is taken off this step's points."))
      controls.take_hint(session);
  }
  rest.take_right(theme.px(16));

  const StripWords words = words_of(session, tools, controls);
  if (!has_controls(input)) return draw_words(rest, theme.text, words);
  draw_words(rest.take_bottom(words_height(theme, words.text, true, rest.w)), theme.small_text, words);
  Rect row = rest;
  row.h = theme.px(kChoiceRow);
  if (controls.question())
    draw_question(theme, rest, controls, field, places);
  else if (tools.measuring())
    draw_slots(theme, row, tools, places);
  else if (tools.labelling())
    draw_names(theme, rest, session, tools, places);
  else
    draw_settings(theme, row, controls.settings(session));
}

}  // namespace insonate::ui
