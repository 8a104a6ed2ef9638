#include "app/panels/scan/exam_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "sim/core/text.h"

namespace insonate::ui {
namespace {

/// From here on the time left is shown in amber.
constexpr double kHurry_s = 10;

std::string status_text(PoseStatus status) {
  switch (status) {
    case PoseStatus::ok:
      return "tracking";
    case PoseStatus::missing:
      return "no pose";
    case PoseStatus::out_of_view:
      return "out of view";
    case PoseStatus::out_of_volume:
      return "out of range";
    case PoseStatus::switched:
      return "switched off";
    case PoseStatus::invalid:
      return "invalid pose";
    case PoseStatus::unknown:
      break;
  }
  return "state unknown";
}

std::string rejection_text(Rejection rejected) {
  return rejected == Rejection::distortion ? "Rejected: metal near"
         : rejected == Rejection::mirror   ? "Rejected: mirrored"
                                           : "Rejected: a jump";
}

void draw_tracker(const Theme& theme, const Rect& where, const Session& session) {
  const TrackerState state = session.tracker_state();
  std::string condition;
  ImU32 light = colour::kAccent;
  if (session.holder() == Holder::learner) {
    condition = "You hold the probe";
  } else if (state.condition == TrackerCondition::finished) {
    condition = "End of the recording";
    light = colour::kFaint;
  } else if (state.condition == TrackerCondition::waiting) {
    condition = state.problem.empty() ? "Waiting for the first pose" : "Waiting for the device";
    light = colour::kAmber;
  } else {
    condition = (session.lost_for_s() ? "Lost: " : "") + status_text(state.last_status);
    if (!session.lost_for_s() && !condition.empty()) condition[0] = char(std::toupper(condition[0]));
    if (state.rejected != Rejection::none) condition = rejection_text(state.rejected);
    if (session.lost_for_s() || state.rejected != Rejection::none || state.last_status != PoseStatus::ok)
      light = colour::kAmber;
    char rate[32];
    std::snprintf(rate, sizeof rate, ", %.0f Hz", state.rate_hz);
    if (state.rate_hz > 0 && state.last_status == PoseStatus::ok) condition += rate;
  }
  Rect upper{where.x, where.y + theme.px(11), where.w, theme.px(21)};
  Rect lower{where.x, upper.y + upper.h, where.w, theme.px(20)};
  ImGui::GetWindowDrawList()->AddCircleFilled({upper.x + theme.px(5), upper.y + upper.h / 2}, theme.px(5), light, 20);
  upper.take_left(theme.px(18));
  lower.take_left(theme.px(18));
  draw_text(upper, theme.strong, light == colour::kAmber ? colour::kAmber : colour::kText, condition);
  const std::string& source = state.name.empty() ? state.problem : state.name;  // the picture shows a problem in full
  if (state.distortion.value_or(0) > 0 && session.holder() == Holder::tracker) {
    const std::string grade = "distortion " + std::to_string(*state.distortion);
    const bool bad = state.rejected == Rejection::distortion;
    draw_text(lower.take_right(text_width(theme.small_text, grade)), theme.small_text,
              bad ? colour::kAmber : colour::kMuted, grade);
    lower.take_right(theme.px(10));
  }
  const std::string words = session.holder() == Holder::learner ? "Mouse and keyboard; F1 shows help" : source;
  draw_text(lower, theme.small_text, colour::kMuted, words);
  if (text_width(theme.small_text, words) > lower.w) draw_tooltip(theme, lower, words);
}

/// How far the step is, in a word or two.
std::string progress_text(const LiveExam& live, const StepWords& words) {
  if (live.finished) return "Finished";
  if (live.within_tolerance) return words.on_target;
  if (words.shows_progress && live.counts_as_done) return "Go on when ready";
  if (words.shows_progress && live.hold_share > 0) return std::to_string(int(100 * live.hold_share)) + " % done";
  return words.under_way;
}

void draw_hold(const Theme& theme, const Rect& where, const Session& session, const StepWords& words) {
  const LiveExam& live = session.runner()->live();
  const ImVec2 centre{where.x + theme.px(28), where.y + where.h / 2};
  const bool on_target = live.within_tolerance && !live.finished;
  draw_ring(centre, theme.px(19), theme.px(5), live.finished ? 1.0 : live.hold_share, colour::kAccent, colour::kRaised);
  const Rect upper{where.x + theme.px(60), where.y + theme.px(11), where.w - theme.px(60), theme.px(21)};
  const Rect lower{upper.x, upper.y + upper.h, upper.w, theme.px(20)};
  draw_text(upper, theme.strong, on_target ? colour::kAccent : colour::kText, progress_text(live, words));
  draw_text(lower, theme.small_text, colour::kMuted,
            live.finished && session.source().recording() ? "the scan is over"
            : live.finished                               ? "F4: the score sheet"
            : !live.started                               ? "not started"
            : live.on_skin                                ? "probe on the skin"
            : live.tracking == PoseStatus::ok             ? "probe off the skin"
                                                          : "no pose");
}

/// What is left of the step and of the exam, whose clock stands still during warm-ups.
void draw_time(const Theme& theme, const Rect& where, const LiveExam& live, bool counts, bool strict) {
  Rect lines[] = {{where.x, where.y + theme.px(11), where.w, theme.px(21)},
                  {where.x, where.y + theme.px(32), where.w, theme.px(20)}};
  if (live.finished) {
    draw_text(lines[0], theme.strong, colour::kText, clock_text(live.elapsed_s));
    return draw_text(lines[1], theme.small_text, colour::kMuted, "in all");
  }
  const auto draw = [&](Rect line, ImFont* font, const char* name, double left_s, bool runs) {
    draw_text(line.take_left(theme.px(64)), theme.small_text, colour::kMuted, name);
    draw_text(line, font,
              runs && left_s < kHurry_s ? colour::kAmber
              : runs                    ? colour::kText
                                        : colour::kFaint,
              clock_text(left_s));
  };
  draw(lines[0], theme.strong, "Step left",
       counts ? std::min(live.step_remaining_s, live.exam_remaining_s) : live.step_remaining_s, true);
  draw(lines[1], theme.text, strict ? "Exam left" : "All left", live.exam_remaining_s, counts);
}

/// What is special about a step.
std::string status_of(const Scenario& scenario, const Step& step) {
  if (!step.counts) return "Warm-up: does not count";
  if (!step.if_good.empty() || !step.if_poor.empty()) return "What comes next depends on this";
  return scenario.order == Scenario::Order::free ? "In any order" : "";
}

constexpr double kNewStep_s = 4;  ///< for so long a new step is marked
constexpr float kHeight = 66, kTracker = 264, kTime = 112, kHold = 190, kExamGap = 12, kTitleLine = 25,
                kInstruction = 22;

/// Whether the view is found is what an exam asks.
bool shows_hold(const Session& session) {
  return !session.strict() || session.runner()->live().finished;
}

/// Returns the font and the height of a step's instruction.
std::pair<ImFont*, float> fit_instruction(const Theme& theme, float width, const std::string& text) {
  if (text_width(theme.text, text) <= width) return {theme.text, theme.px(kInstruction)};
  return {theme.small_text, std::max(theme.px(kInstruction), paragraph_height(theme.small_text, text, width))};
}

}  // namespace

float exam_panel_height(const Theme& theme, float width, const Session* session) {
  if (!session || !session->runner()) return theme.px(kHeight);
  const float others =
      2 * kWideMargin + kTracker + kTime + 2 * kExamGap + (shows_hold(*session) ? kHold + kExamGap : 0);
  const Runner& runner = *session->runner();
  const std::string& text = runner.scenario().steps[runner.live().step].instruction;
  return theme.px(kHeight - kInstruction) + fit_instruction(theme, width - theme.px(others), text).second;
}

std::string rejection_advice(const TrackerState& state) {
  const std::string begin = "The tracker's poses are rejected: ";
  switch (state.rejected) {
    case Rejection::none:
      return "";
    case Rejection::jump:
      return begin + "they jump as no hand does. Keep steel and mains adapters away from the sensor and the base.";
    case Rejection::mirror:
      return begin +
             "it takes the sensor for its mirror image on the base's other side. Bring the probe close to the "
             "base for a moment.";
    case Rejection::distortion:
      return begin + "it says that metal bends its field where the sensor is (distortion " +
             std::to_string(state.distortion.value_or(0)) +
             "). Keep steel away from the sensor and the base, or bring the probe nearer to the base.";
  }
  return "";
}

std::string clock_text(double seconds) {
  const int whole = int(std::floor(seconds));
  return formatted("%d:%02d", whole / 60, whole % 60);
}

void draw_exam_panel(const Theme& theme, const Rect& panel, const Session& session, bool makes_views,
                     const std::string& learner, std::map<std::string, Rect>& places) {
  fill(panel, colour::kPanel, theme.px(4));
  Rect rest = panel.inset(theme.px(kWideMargin), 0);
  draw_tracker(theme, rest.take_right(theme.px(kTracker)), session);
  rest.take_right(theme.px(kExamGap));
  const Rect upper{rest.x, rest.y + theme.px(9), rest.w, theme.px(kTitleLine)};
  const Runner* runner = session.runner();
  if (!runner) {
    draw_text(upper, theme.heading, colour::kText, makes_views ? "Making views" : "Free practice");
    draw_text({rest.x, upper.y + upper.h, rest.w, theme.px(20)}, theme.text, colour::kMuted,
              session.holder() == Holder::learner
                  ? "Nothing is scored. Move the probe with the arrow keys or drag it over the patient."
                  : "Nothing is scored. The tracker moves the probe; any arrow key takes it over.");
    return;
  }
  const LiveExam& live = runner->live();
  const Scenario& scenario = runner->scenario();
  const Step& step = scenario.steps[live.step];
  draw_time(theme, rest.take_right(theme.px(kTime)), live, step.counts, session.strict());
  rest.take_right(theme.px(kExamGap));
  if (shows_hold(session)) {
    draw_hold(theme, rest.take_right(theme.px(kHold)), session, step.task->words());
    rest.take_right(theme.px(kExamGap));
  }

  const std::string number = std::to_string(live.step + 1) + " / " + std::to_string(scenario.steps.size());
  Rect title{rest.x, upper.y, rest.w, upper.h};
  const Rect plate = title.take_left(text_width(theme.strong, number) + theme.px(16));
  // Who looks at the picture alone does not see the title change.
  const bool is_new = live.step > 0 && !live.finished && step.time_limit_s - live.step_remaining_s < kNewStep_s;
  if (is_new) outline(panel, colour::kAccent, theme.px(4));
  fill(plate.inset(0, theme.px(1)), is_new ? colour::kAccent : colour::kAccentDark, theme.px(4));
  draw_text(plate, theme.strong, is_new ? colour::kBackground : colour::kText, number, Align::centre);
  title.take_left(theme.px(10));
  const auto draw_chip = [&](const std::string& text, ImU32 ink, float widest) {
    const Rect chip = title.take_right(std::min(text_width(theme.small_text, text) + theme.px(20), widest));
    title.take_right(theme.px(10));
    fill(chip.inset(0, theme.px(2)), colour::kRaised, theme.px(4));
    draw_text(chip.inset(theme.px(8), 0), theme.small_text, ink, text, Align::centre);
    return chip;
  };
  if (!learner.empty()) {
    places["learner"] = draw_chip(learner, colour::kText, title.w / 4);
    draw_tooltip(theme, places["learner"], "The learner of this attempt: " + learner);
  }
  if (const std::string status = status_of(scenario, step); !status.empty())
    draw_chip(status, colour::kAccent, title.w);
  draw_text(title, theme.heading, colour::kText, step.title);
  const auto [font, height] = fit_instruction(theme, rest.w, step.instruction);
  const float text_height = paragraph_height(font, step.instruction, rest.w);
  draw_paragraph({rest.x, std::round(upper.y + upper.h + (height - text_height) / 2), rest.w, text_height}, font,
                 colour::kMuted, step.instruction);
}

}  // namespace insonate::ui
