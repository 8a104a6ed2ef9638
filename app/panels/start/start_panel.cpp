#include "app/panels/start/start_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/panels/start/start_list.h"
#include "app/panels/widgets/choice_rows.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

struct TaskText {
  Task task;
  const char* title;
  const char* summary;
  const char* begin;
};
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

const TaskText& text_of(Task task) {
  return *std::find_if(kTaskTexts.begin(), kTaskTexts.end(), [&](const TaskText& text) { return text.task == task; });
}

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

/// Draws keys and what they do.
void draw_keys(const Theme& theme, Rect& rest, std::initializer_list<std::array<const char*, 2>> keys) {
  for (const auto& [key, meaning] : keys) {
    Rect line = rest.take_top(theme.px(28));
    draw_text(line.take_left(theme.px(170)), theme.strong, colour::kText, key);
    draw_text(line, theme.text, colour::kMuted, meaning);
  }
  rest.take_top(theme.px(12));
}

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
  Rect side = rest.take_right(theme.px(336));
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

  const StartAnswer of_task = draw_task(theme, rest, page);
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
  if (!learner_.is_open()) typed_learner_ = page.learner() == kNobodyInParticular ? "" : page.learner();
  const Rect field = rest.take_top(theme.px(36));
  (*places_)["learner_field"] = field;
  ImGui::PushID("learner");
  typed_learner_ = learner_.draw(theme, field, typed_learner_, "An id that is not a name, such as L-07");
  ImGui::PopID();
  rest.take_top(theme.px(8));
  std::vector<Choice> choices{{"learner_nobody", "Nobody", nobody ? ButtonKind::chosen : ButtonKind::normal}};
  std::vector<std::string> ids{""};
  constexpr std::size_t kMost = 24;  // what flows into the rows
  for (const std::string& id : page.learners()) {
    if (choices.size() > kMost) break;
    if (learner_.is_open() && id.find(typed_learner_) == std::string::npos) continue;
    choices.push_back({"learner_" + id, id, id == page.learner() ? ButtonKind::chosen : ButtonKind::normal});
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
    ImGui::GetWindowDrawList()->AddCircleFilled({light.x + theme.px(6), light.centre().y}, theme.px(6),
                                                light_of(tracker.state), 20);
    const char* words = words_of(tracker.state);
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
      const bool whole = typed_address_.find(':') != std::string::npos && typed_address_.starts_with("igtl:");
      page.choose_tracker(whole ? typed_address_ : "igtl://" + typed_address_);
      typed_address_.clear();
    });
  const Rect field = rest.take_top(theme.px(36));
  (*places_)["tracker_address"] = field;
  ImGui::PushID("address");
  typed_address_ = address_.draw(theme, field, typed_address_, "On the network (OpenIGTLink): HOST:18944");
  ImGui::PopID();
  if (!chosen.empty()) attempt([&] { page.choose_tracker(chosen); });
}

void StartPanel::draw_attempts(const Theme& theme, Rect panel, StartPage& page) {
  Rect rest = draw_column_panel(theme, panel, "Done before");
  const std::vector<AttemptSummary> attempts = page.attempts();
  const Rect file = rest.take_bottom(theme.px(20));
  if (!page.database().empty()) draw_text(file, theme.small_text, colour::kMuted, "In " + page.database().string());
  draw_tooltip(theme, file, page.database().string());
  if (attempts.empty())
    return void(draw_paragraph(rest, theme.text, colour::kMuted, "Nothing yet. What you practise is kept here."));
  const float height = theme.px(46);
  for (const AttemptSummary& attempt : attempts) {
    if (rest.h < height) break;
    const Rect row = rest.take_top(height);
    const std::string id = "attempt_" + std::to_string(attempt.number);
    (*places_)[id] = row;
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

StartAnswer StartPanel::draw_task(const Theme& theme, const Rect& panel, StartPage& page) {
  fill(panel, colour::kPanel, theme.px(8));
  Rect rest = panel.inset(theme.px(28), theme.px(22));
  const TaskText& text = text_of(page.task);
  draw_text(rest.take_top(theme.px(40)), theme.title, colour::kText, text.title);
  rest.take_top(theme.px(8));
  Rect bottom = rest.take_bottom(theme.px(48));
  rest.take_bottom(theme.px(12));

  StartAnswer answer;
  const std::string why_not = page.why_not();
  page.makes_views = false;
  (*places_)["begin"] = bottom.take_right(theme.px(200));
  if (button(theme, "begin", (*places_)["begin"], std::string(text.begin) + "  (Enter)", ButtonKind::primary,
             why_not.empty()))
    answer.kind = StartAnswer::Kind::begin;
  bottom.take_right(theme.px(12));
  if (page.task == Task::patients && page.patient < page.patients().size() &&
      !page.patients()[page.patient].source.case_folder.empty()) {
    (*places_)["make_views"] = bottom.take_right(theme.px(140));
    bottom.take_right(theme.px(12));
    if (button(theme, "make_views", (*places_)["make_views"], "Make its views", ButtonKind::normal, why_not.empty())) {
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
      paragraph(theme, rest, colour::kMuted, "The mouse and the keyboard move the probe. You need nothing else.");
      draw_keys(theme, rest,
                {{"Drag the probe", "in the 3D view: put it somewhere else"},
                 {"Arrow keys", "slide it over the skin, as the 3D view shows it"},
                 {"E, Q", "rotate it"},
                 {"A, D", "tilt the beam"},
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
      detail = draw_scenarios(theme, rest, page);
      break;
    case Task::patients:
      detail = draw_patients(theme, rest, page);
      break;
    case Task::replay:
      detail = draw_runs(theme, rest, page);
      break;
    case Task::setup:
      detail = draw_setup(theme, rest, page);
      break;
    case Task::learners:
      draw_learners(theme, rest, page);
      break;
  }
  return detail.kind == StartAnswer::Kind::none ? answer : detail;
}

StartAnswer StartPanel::draw_scenarios(const Theme& theme, Rect rest, StartPage& page) {
  StartAnswer answer;
  const bool practice = page.task == Task::practice;
  paragraph(theme, rest, colour::kMuted,
            practice ? "The steps are scored, with hints and a guide, as often as you like. Nothing counts."
                     : "It counts: once per learner, without help, and the patient's inside is hidden. The time runs "
                       "from Start. The patient is drawn by chance.");
  Rect details = rest.take_bottom(std::min(theme.px(190), rest.h * 0.45f));
  rest.take_bottom(theme.px(12));
  std::vector<ListRow> rows;
  for (std::size_t i = 0; i < page.scenarios().size(); ++i)
    rows.push_back({"scenario_" + std::to_string(i), page.scenarios()[i].title, facts_of(page.scenarios()[i])});
  const std::size_t free = rows.size();
  if (practice) rows.push_back({"scenario_free", "Free practice", "no steps"});
  const std::size_t chosen = page.scenario.value_or(free);
  if (const auto clicked = draw_list(theme, "scenarios", rest, rows, chosen, *places_); clicked && *clicked != chosen) {
    page.scenario = *clicked == free ? std::nullopt : clicked;
    page.variant.reset();
  }

  Rect buttons = details.take_bottom(theme.px(34));
  details.take_bottom(theme.px(8));
  (*places_)["browse"] = buttons.take_left(theme.px(190));
  if (button(theme, "browse", (*places_)["browse"], "Open a scenario\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::scenario};
  if (!page.scenario) {
    draw_paragraph(details, theme.text, colour::kText, "Scan the built-in patient. Key G shows the way to its views.");
    return answer;
  }
  const OfferedScenario& scenario = page.scenarios()[*page.scenario];
  if (practice && !scenario.variants.empty()) {
    Rect row = details.take_bottom(theme.px(kChoiceRow));
    details.take_bottom(theme.px(8));
    draw_text(row.take_left(theme.px(64)), theme.text, colour::kMuted, "Patient");
    std::vector<Choice> choices{{"variant_any", "By chance", page.variant ? ButtonKind::normal : ButtonKind::chosen}};
    for (std::size_t i = 0; i < scenario.variants.size(); ++i)
      choices.push_back({"variant_" + std::to_string(i), scenario.variants[i].name,
                         page.variant == i ? ButtonKind::chosen : ButtonKind::normal});
    if (const auto clicked = row_of_choices(theme, row, choices, *places_))
      page.variant = *clicked == 0 ? std::nullopt : std::optional(*clicked - 1);
  }
  draw_paragraph(details, theme.text, colour::kText, scenario.briefing);
  return answer;
}

StartAnswer StartPanel::draw_patients(const Theme& theme, Rect rest, StartPage& page) {
  StartAnswer answer;
  paragraph(theme, rest, colour::kMuted,
            "Free practice, without steps. A patient of your own is a CT (NIfTI, NRRD, MetaImage or a DICOM folder) or "
            "a case. Drop it on the window, or open it here.");
  Rect buttons = rest.take_bottom(theme.px(34));
  rest.take_bottom(theme.px(10));
  (*places_)["browse"] = buttons.take_left(theme.px(190));
  if (button(theme, "browse", (*places_)["browse"], "Open a CT or case\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::patient};
  buttons.take_left(theme.px(8));
  (*places_)["cases"] = buttons.take_left(theme.px(190));
  if (button(theme, "cases", (*places_)["cases"], "List a folder of cases\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::cases};
  std::vector<ListRow> rows;
  for (std::size_t i = 0; i < page.patients().size(); ++i)
    rows.push_back({"patient_" + std::to_string(i), page.patients()[i].name, page.patients()[i].about});
  if (const auto clicked = draw_list(theme, "patients", rest, rows, page.patient, *places_)) page.patient = *clicked;
  return answer;
}

StartAnswer StartPanel::draw_runs(const Theme& theme, Rect rest, StartPage& page) {
  StartAnswer answer;
  paragraph(theme, rest, colour::kMuted,
            "Any moment of a run, with its picture, the probe's path and curves of how it moved. Nothing is scored.");
  Rect buttons = rest.take_bottom(theme.px(34));
  rest.take_bottom(theme.px(10));
  (*places_)["browse"] = buttons.take_left(theme.px(190));
  if (button(theme, "browse", (*places_)["browse"], "Open a recorded scan\u2026"))
    answer = {StartAnswer::Kind::browse, Wanted::recording};
  buttons.take_left(theme.px(8));
  const bool expert = !page.expert().empty();
  (*places_)["beside"] = buttons.take_left(theme.px(220));
  if (button(theme, "beside", (*places_)["beside"], "Beside the skilled scan",
             expert && page.beside_expert ? ButtonKind::chosen : ButtonKind::normal, expert))
    page.beside_expert = !page.beside_expert;
  if (!expert)
    draw_tooltip(theme, (*places_)["beside"], "There is no skilled scan of this run's exam to compare it with.");
  if (page.run < page.runs().size() && page.runs()[page.run].needs_scenario()) {
    Rect of = rest.take_bottom(theme.px(kChoiceRow + kSecondChoiceRow));
    rest.take_bottom(theme.px(10));
    std::vector<Choice> choices{
        {"steps_none", "No steps", page.run_scenario ? ButtonKind::normal : ButtonKind::chosen}};
    for (std::size_t i = 0; i < page.scenarios().size(); ++i)
      choices.push_back({"steps_" + std::to_string(i), page.scenarios()[i].title,
                         page.run_scenario == i ? ButtonKind::chosen : ButtonKind::normal});
    if (const auto clicked = flow_of_choices(theme, of, choices, *places_))
      page.run_scenario = *clicked == 0 ? std::nullopt : std::optional(*clicked - 1);
  }
  std::vector<ListRow> rows;
  for (std::size_t i = 0; i < page.runs().size(); ++i)
    rows.push_back({"run_" + std::to_string(i), page.runs()[i].name, page.runs()[i].about});
  if (const auto clicked = draw_list(theme, "runs", rest, rows, page.run, *places_)) page.run = *clicked;
  return answer;
}

void StartPanel::draw_learners(const Theme& theme, Rect rest, const StartPage& page) {
  paragraph(theme, rest, colour::kText,
            "How learners do: their scores over time, the criteria that lose points, and every attempt, to be reviewed "
            "and commented on. The whole database can be written as CSV tables.");
  paragraph(theme, rest, colour::kMuted,
            "Learners are known by their ids alone. Attempts never change; comments are kept beside them.");
  paragraph(theme, rest, colour::kMuted, "Database: " + page.database().string());
}

StartAnswer StartPanel::draw_setup(const Theme& theme, Rect rest, StartPage& page) {
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
    const char* otherwise;
    const std::filesystem::path& file;
    Wanted wanted;
  };
  for (const File& each :
       {File{"browse", "Calibration\u2026", "the last set-up of this tracker, if there is one", page.calibration(),
             Wanted::calibration},
        File{"landmarks", "Landmarks\u2026", "those of the built-in patient", page.landmarks(), Wanted::landmarks},
        File{"drawing", "Drawing of the probe\u2026", "none: the probe's face is touched", page.drawing(),
             Wanted::drawing}}) {
    Rect row = rest.take_top(theme.px(34));
    rest.take_top(theme.px(8));
    (*places_)[each.id] = row.take_left(theme.px(220));
    row.take_left(theme.px(12));
    if (button(theme, each.id, (*places_)[each.id], each.text)) answer = {StartAnswer::Kind::browse, each.wanted};
    if (!each.file.empty()) {
      const std::string reset = std::string(each.id) + "_reset";
      (*places_)[reset] = row.take_right(theme.px(80));
      row.take_right(theme.px(8));
      if (button(theme, reset.c_str(), (*places_)[reset], "Reset")) answer = {StartAnswer::Kind::reset, each.wanted};
    }
    draw_text(row, theme.text, each.file.empty() ? colour::kMuted : colour::kText,
              each.file.empty() ? each.otherwise : each.file.string());
  }
  return answer;
}

}  // namespace insonate::ui
