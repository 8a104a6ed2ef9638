#include "app/panels/start/task_details.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "app/panels/start/start_list.h"
#include "app/panels/widgets/choice_rows.h"
#include "app/panels/widgets/scroll_area.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {
namespace {

constexpr float kPatientWord = 64;  ///< width of the word before the buttons of patients

constexpr std::array<TaskText, kTasks> kTaskTexts{{
    {Task::first_scan, "First scan", "Two minutes, with a guide", "Start"},
    {Task::demonstration, "Demonstration", "Watch a recorded scan", "Watch"},
    {Task::practice, "Practice", "With help, as often as you like", "Practise"},
    {Task::exam, "Exam", "Counts: once, without help", "Take the exam"},
    {Task::patients, "Patients", "Scan freely, or open your own CT", "Scan"},
    {Task::replay, "Replay", "Look at a run again", "Replay"},
    {Task::setup, "Set up a tracker", "Fit it to probe and mannequin", "Set up"},
    {Task::learners, "Learners", "For instructors: how it went", "Open"},
}};

std::string facts_of(const OfferedScenario& scenario) {
  const int minutes = int(std::ceil(scenario.time_limit_s / 60));
  return std::to_string(scenario.steps) + (scenario.steps == 1 ? " step, " : " steps, ") + std::to_string(minutes) +
         " min";
}

/// Draws a paragraph at the top of what is left.
void paragraph(const Theme& theme, Rect& rest, ImU32 ink, std::string_view text) {
  const float height = paragraph_height(theme.text, text, rest.w);
  draw_paragraph(rest.take_top(height), theme.text, ink, text);
  rest.take_top(theme.px(12));
}

/// Returns places for two buttons at the left of a row, as wide as their text needs if there is room.
std::array<Rect, 2> two_buttons(const Theme& theme, Rect row) {
  const float gap = theme.px(8), width = std::min(theme.text_px(220), (row.w - gap) / 2);
  const Rect first = row.take_left(width);
  row.take_left(gap);
  return {first, row.take_left(width)};
}

/// Draws keys and what they do.
void draw_keys(const Theme& theme, Rect& rest, std::initializer_list<std::array<const char*, 2>> keys) {
  for (const auto& [key, meaning] : keys) {
    const float left = theme.text_px(170), height = std::max(paragraph_height(theme.strong, key, left),
                                                             paragraph_height(theme.text, meaning, rest.w - left));
    Rect line = rest.take_top(std::max(theme.px(28), height + theme.px(6)));
    draw_paragraph(line.take_left(left), theme.strong, colour::kText, key);
    draw_paragraph(line, theme.text, colour::kMuted, meaning);
  }
  rest.take_top(theme.px(12));
}

std::vector<Choice> variants_of(const OfferedScenario& scenario, std::optional<std::size_t> chosen) {
  std::vector<Choice> choices{{"variant_any", "By chance", chosen ? ButtonKind::normal : ButtonKind::chosen}};
  for (std::size_t i = 0; i < scenario.variants.size(); ++i)
    choices.push_back({"variant_" + std::to_string(i), scenario.variants[i].name,
                       chosen == i ? ButtonKind::chosen : ButtonKind::normal});
  return choices;
}

/// Returns the height of the buttons of a scenario's patients; 0 if there is nothing to choose.
float variants_height(const Theme& theme, const OfferedScenario& scenario, float width) {
  return scenario.variants.empty() ? 0
                                   : height_of_flow(theme, width - theme.px(kPatientWord), variants_of(scenario, {}));
}

StartAnswer draw_scenarios(const Theme& theme, Rect rest, StartPage& page, std::map<std::string, Rect>& places) {
  StartAnswer answer;
  const bool practice = page.task == Task::practice;
  paragraph(theme, rest, colour::kMuted,
            practice ? "The steps are scored, with hints and a guide, as often as you like. Nothing counts."
                     : "It counts: once per learner, without help, and the patient's inside is hidden. The time runs "
                       "from Start. The patient is drawn by chance.");
  // As much as the longest briefing needs, so that the list stays where it is.
  float height = 0;
  for (const OfferedScenario& scenario : page.scenarios())
    height = std::max(height, paragraph_height(theme.text, scenario.briefing, rest.w) +
                                  (practice ? variants_height(theme, scenario, rest.w) + theme.px(8) : 0));
  Rect details = rest.take_bottom(std::min(height + theme.px(34 + 8 + 4), rest.h * 0.5f));
  rest.take_bottom(theme.px(12));
  std::vector<ListRow> rows;
  for (std::size_t i = 0; i < page.scenarios().size(); ++i) {
    const OfferedScenario& offered = page.scenarios()[i];
    const bool taken = !practice && page.taken_in(offered) != 0;
    rows.push_back(
        {"scenario_" + std::to_string(i), offered.title, taken ? "taken by " + page.learner() : facts_of(offered)});
  }
  const std::size_t free = rows.size();
  if (practice) rows.push_back({"scenario_free", "Free practice", "no steps"});
  const std::size_t chosen = page.scenario.value_or(free);
  if (const auto clicked = draw_list(theme, "scenarios", whole_rows(rest, theme.px(kListRow)), rows, chosen, places);
      clicked && *clicked != chosen) {
    page.scenario = *clicked == free ? std::nullopt : clicked;
    page.variant.reset();
  }

  Rect buttons = details.take_bottom(theme.px(34));
  details.take_bottom(theme.px(8));
  const auto [browse, check] = two_buttons(theme, buttons);
  places["browse"] = browse;
  places["check"] = check;
  if (button(theme, "browse", places["browse"], "Open a scenario\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::scenario};
  if (button(theme, "check", places["check"], "Check a scenario\u2026", ButtonKind::normal, true,
             "For authors: shows what is wrong with a scenario file, again whenever it is saved"))
    answer = {StartAnswer::Kind::browse, Wanted::checked};
  if (!page.scenario) {
    draw_paragraph(
        details, theme.text, colour::kText,
        "Scan the built-in patient, who has free fluid beside the right kidney. Others are under Patients. Key "
        "G shows the way to the views.");
    return answer;
  }
  const OfferedScenario& scenario = page.scenarios()[*page.scenario];
  if (practice && !scenario.variants.empty()) {
    Rect rows_of_variants = details.take_bottom(variants_height(theme, scenario, details.w));
    details.take_bottom(theme.px(8));
    Rect word = rows_of_variants.take_left(theme.px(kPatientWord));
    draw_text(word.take_top(theme.px(kChoiceRow)), theme.text, colour::kMuted, "Patient");
    if (const auto clicked = flow_of_choices(theme, rows_of_variants, variants_of(scenario, page.variant), places))
      page.variant = *clicked == 0 ? std::nullopt : std::optional(*clicked - 1);
  }
  draw_paragraph(details, theme.text, colour::kText, scenario.briefing);
  return answer;
}

StartAnswer draw_patients(const Theme& theme, Rect rest, StartPage& page, std::map<std::string, Rect>& places) {
  StartAnswer answer;
  paragraph(theme, rest, colour::kMuted,
            "Free practice, without steps. A patient of your own is a CT (NIfTI, NRRD, MetaImage or a DICOM folder) or "
            "a case. Drop it on the window, or open it here.");
  Rect buttons = rest.take_bottom(theme.px(34));
  rest.take_bottom(theme.px(10));
  const auto [browse, cases] = two_buttons(theme, buttons);
  places["browse"] = browse;
  places["cases"] = cases;
  if (button(theme, "browse", places["browse"], "Open a CT or case\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::patient};
  if (button(theme, "cases", places["cases"], "List a folder of cases\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::cases};
  std::vector<ListRow> rows;
  for (std::size_t i = 0; i < page.patients().size(); ++i)
    rows.push_back({"patient_" + std::to_string(i), page.patients()[i].name, page.patients()[i].about});
  if (const auto clicked =
          draw_list(theme, "patients", whole_rows(rest, theme.px(kListRow)), rows, page.patient, places))
    page.patient = *clicked;
  return answer;
}

StartAnswer draw_runs(const Theme& theme, Rect rest, StartPage& page, std::map<std::string, Rect>& places) {
  StartAnswer answer;
  paragraph(theme, rest, colour::kMuted,
            "Any moment of a run, with its picture, the probe's path and curves of how it moved. Nothing is scored.");
  Rect buttons = rest.take_bottom(theme.px(34));
  rest.take_bottom(theme.px(10));
  const auto [browse, beside] = two_buttons(theme, buttons);
  places["browse"] = browse;
  places["beside"] = beside;
  if (button(theme, "browse", places["browse"], "Open a recorded scan\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::recording};
  const bool expert = !page.expert().empty();
  const bool is_beside = expert && page.beside_expert;
  if (button(theme, "beside", places["beside"], is_beside ? "Skilled scan beside: on" : "Skilled scan beside: off",
             is_beside ? ButtonKind::chosen : ButtonKind::normal, expert))
    page.beside_expert = !page.beside_expert;
  if (!expert)
    draw_tooltip(theme, places["beside"],
                 page.run < page.runs().size() && page.runs()[page.run].is_skilled
                     ? "This is the skilled scan of its exam."
                     : "There is no skilled scan of this run's exam to compare it with.");
  if (page.run < page.runs().size() && page.runs()[page.run].needs_scenario()) {
    Rect of = rest.take_bottom(theme.px(kChoiceRow + kSecondChoiceRow));
    rest.take_bottom(theme.px(10));
    std::vector<Choice> choices{
        {"steps_none", "No steps", page.run_scenario ? ButtonKind::normal : ButtonKind::chosen}};
    for (std::size_t i = 0; i < page.scenarios().size(); ++i)
      choices.push_back({"steps_" + std::to_string(i), page.scenarios()[i].title,
                         page.run_scenario == i ? ButtonKind::chosen : ButtonKind::normal});
    if (const auto clicked = flow_of_choices(theme, of, choices, places))
      page.run_scenario = *clicked == 0 ? std::nullopt : std::optional(*clicked - 1);
    draw_text(rest.take_bottom(theme.px(24)), theme.small_text, colour::kMuted,
              "The recording names no exam. Compare it with the steps of one:");
    rest.take_bottom(theme.px(6));
  }
  std::vector<ListRow> rows;
  for (std::size_t i = 0; i < page.runs().size(); ++i)
    rows.push_back({"run_" + std::to_string(i), page.runs()[i].name, page.runs()[i].about});
  if (const auto clicked = draw_list(theme, "runs", whole_rows(rest, theme.px(kListRow)), rows, page.run, places))
    page.run = *clicked;
  return answer;
}

void draw_learners(const Theme& theme, Rect rest, const StartPage& page) {
  paragraph(theme, rest, colour::kText,
            "How learners do: their scores over time, the criteria that lose points, and every attempt, to be reviewed "
            "and commented on. The whole database can be written as CSV tables.");
  paragraph(theme, rest, colour::kMuted,
            "Learners are known by their ids alone. Attempts never change; comments are kept beside them.");
  paragraph(theme, rest, colour::kMuted, "Database: " + page.database().string());
}

StartAnswer draw_setup(const Theme& theme, Rect rest, StartPage& page, std::map<std::string, Rect>& places) {
  StartAnswer answer;
  paragraph(theme, rest, colour::kText,
            "A tracker reports where its sensor is. The set-up finds how the sensor lies on your dummy probe and where "
            "the mannequin lies, in five steps. Each says what to do.");
  paragraph(theme, rest, colour::kMuted,
            "Choose the tracker on the right: a bright light means that it can be used. For one that is plugged in and "
            "cannot be used, the reason stands below it. Only trackers with a sensor need a set-up.");
  struct File {
    const char* id;
    const char* text;
    const char* tip;
    const char* otherwise;
    const std::filesystem::path& file;
    Wanted wanted;
  };
  for (const File& each :
       {File{"browse", "Calibration\u2026", "Continues the set-up that a file holds",
             "the last set-up of this tracker, if there is one", page.calibration(), Wanted::calibration},
        File{"landmarks", "Landmarks\u2026", "Reads from a file where the places to touch lie in another patient's CT",
             "those of the built-in patient", page.landmarks(), Wanted::landmarks},
        File{"drawing", "Drawing of the probe\u2026",
             "Reads from a file how the face lies to the tip, instead of touching it",
             "none: the probe's face is touched", page.drawing(), Wanted::drawing}}) {
    const std::string file = each.file.empty() ? each.otherwise : each.file.string();
    const float wide = theme.text_px(220), gap = theme.px(12), reset_wide = each.file.empty() ? 0 : theme.px(80 + 8);
    const float height = paragraph_height(theme.text, file, rest.w - wide - gap - reset_wide);
    Rect row = rest.take_top(std::max(theme.px(34), height));
    rest.take_top(theme.px(8));
    places[each.id] = row.take_left(wide);
    row.take_left(gap);
    if (button(theme, each.id, places[each.id], each.text, ButtonKind::normal, true, each.tip))
      answer = {StartAnswer::Kind::browse, each.wanted};
    if (!each.file.empty()) {
      const std::string reset = std::string(each.id) + "_reset";
      places[reset] = row.take_right(theme.px(80));
      row.take_right(theme.px(8));
      if (button(theme, reset.c_str(), places[reset], "Reset")) answer = {StartAnswer::Kind::reset, each.wanted};
    }
    draw_paragraph({row.x, row.centre().y - height / 2, row.w, height}, theme.text,
                   each.file.empty() ? colour::kMuted : colour::kText, file);
  }
  const char* const words = "without a tracker: a made-up hand does what the steps ask for, and you mark";
  Rect row = rest.take_top(
      std::max(theme.px(34), paragraph_height(theme.text, words, rest.w - theme.text_px(220) - theme.px(12))));
  places["rehearse"] = row.take_left(theme.text_px(220));
  row.take_left(theme.px(12));
  if (button(theme, "rehearse", places["rehearse"], "Rehearse")) {
    page.choose_tracker(kRehearsal);
    answer.kind = StartAnswer::Kind::begin;
  }
  draw_paragraph({row.x, row.centre().y - paragraph_height(theme.text, words, row.w) / 2, row.w, row.h}, theme.text,
                 colour::kMuted, words);
  return answer;
}

}  // namespace

const TaskText& text_of(Task task) {
  return *std::find_if(kTaskTexts.begin(), kTaskTexts.end(), [&](const TaskText& text) { return text.task == task; });
}

StartAnswer draw_task(const Theme& theme, const Rect& panel, StartPage& page, std::map<std::string, Rect>& places) {
  fill(panel, colour::kPanel, theme.px(8));
  Rect rest = panel.inset(theme.px(28), theme.px(22));
  const TaskText& text = text_of(page.task);
  draw_text(rest.take_top(theme.px(40)), theme.title, colour::kText, text.title);
  rest.take_top(theme.px(8));
  const std::string why_not = page.why_not();
  Rect bottom =
      rest.take_bottom(std::max(theme.px(48), paragraph_height(theme.text, why_not, rest.w - theme.px(200 + 12))));
  rest.take_bottom(theme.px(12));

  StartAnswer answer;
  page.makes_views = false;
  places["begin"] = bottom.take_right(theme.px(200));
  places["begin"].y += (bottom.h - theme.px(48)) / 2;
  places["begin"].h = theme.px(48);
  if (button(theme, "begin", places["begin"], std::string(text.begin) + "  (Enter)", ButtonKind::primary,
             why_not.empty()))
    answer.kind = StartAnswer::Kind::begin;
  bottom.take_right(theme.px(12));
  if (page.task == Task::patients && page.patient < page.patients().size() &&
      !page.patients()[page.patient].source.case_folder.empty()) {
    places["make_views"] = bottom.take_right(theme.px(140));
    bottom.take_right(theme.px(12));
    if (button(theme, "make_views", places["make_views"], "Make its views", ButtonKind::normal, why_not.empty())) {
      page.makes_views = true;
      answer.kind = StartAnswer::Kind::begin;
    }
  }
  if (!why_not.empty()) {
    const float height = paragraph_height(theme.text, why_not, bottom.w);
    bottom.y += std::max(0.0f, (bottom.h - height) / 2);
    draw_paragraph(bottom, theme.text, colour::kAmber, why_not);
    draw_tooltip(theme, bottom, why_not);
  }

  StartAnswer detail;
  switch (page.task) {
    case Task::first_scan:
      paragraph(
          theme, rest, colour::kText,
          "Hold the probe yourself. The guide leads you in three small steps: find the liver, find the bladder, and "
          "point at it in the frozen picture.");
      paragraph(theme, rest, colour::kMuted,
                "The mouse and the keyboard move the probe. You need nothing else. The green dot on the probe is its "
                "marker: the picture shows that side below its own dot.");
      draw_keys(theme, rest,
                {{"Drag the probe", "in the 3D view: put it somewhere else"},
                 {"Arrow keys", "slide it: up to the head, right to the patient's left"},
                 {"E, Q", "rotate it"},
                 {"A, D", "tilt the beam"},
                 {"W, S", "rock the beam"},
                 {"Shift", "with any of these: slowly"},
                 {"Space", "freeze the picture, and let it run again"},
                 {"F1", "all keys, at any time"}});
      break;
    case Task::demonstration:
      paragraph(theme, rest, colour::kText,
                "A recorded scan of the right upper quadrant is replayed: what a skilled hand does with the probe, the "
                "ultrasound that it gives, and the plane in the patient.");
      paragraph(theme, rest, colour::kMuted,
                "It takes less than a minute. Tab takes the probe at any moment, and you go on from there.");
      break;
    case Task::practice:
    case Task::exam:
      detail = draw_scenarios(theme, rest, page, places);
      break;
    case Task::patients:
      detail = draw_patients(theme, rest, page, places);
      break;
    case Task::replay:
      detail = draw_runs(theme, rest, page, places);
      break;
    case Task::setup:
      detail = draw_setup(theme, rest, page, places);
      break;
    case Task::learners:
      draw_learners(theme, rest, page);
      break;
  }
  return detail.kind == StartAnswer::Kind::none ? answer : detail;
}

}  // namespace insonate::ui
