#include "app/panels/replay/replay_page.h"

#include <glm/geometric.hpp>

#include <vector>

#include "app/panels/replay/replay_charts.h"
#include "app/panels/replay/timeline_panel.h"
#include "app/panels/scan/ultrasound_panel.h"
#include "app/panels/views/space_drawing.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

/// Returns how the moment's step ended, once it has.
std::string outcome_text(const RecordedRun& run, std::size_t step, double time_s) {
  if (!run.result || step >= run.result->steps.size()) return "";
  const StepResult& result = run.result->steps[step];
  const std::string at = " at " + clock_text_fine(result.end_s);
  if (time_s < result.start_s) return "";
  switch (result.outcome) {
    case StepOutcome::held:
      return "held until " + clock_text_fine(result.end_s);
    case StepOutcome::done:
      return "done" + at;
    case StepOutcome::went_on:
      return "went on" + at;
    case StepOutcome::timed_out:
      return "time over" + at;
    case StepOutcome::scan_ended:
      return "the scan ended" + at;
    case StepOutcome::skipped:
    case StepOutcome::not_reached:
      break;
  }
  return "";
}

void draw_top(const Theme& theme, const Rect& panel, const Replay& replay, const Scenario* scenario) {
  const std::size_t number = replay.moment().step;
  fill(panel, colour::kPanel, theme.px(4));
  Rect rest = panel.inset(theme.px(16), 0);
  const RecordedRun& run = replay.run();
  const auto two_lines = [&](Rect where, const std::string& upper, ImU32 ink, const std::string& lower) {
    draw_text({where.x, where.y + theme.px(11), where.w, theme.px(21)}, theme.strong, ink, upper);
    draw_text({where.x, where.y + theme.px(32), where.w, theme.px(20)}, theme.small_text, colour::kMuted, lower);
  };
  two_lines(rest.take_right(theme.px(190)), "Replay", colour::kText, run.name);
  rest.take_right(theme.px(12));
  if (run.result) {
    const std::string verdict = (run.result->passed ? "Passed, " : "Not passed, ") + percentage(*run.result) + " %";
    const std::string outcome = outcome_text(run, number, replay.time_s());
    two_lines(rest.take_right(theme.px(210)), verdict, colour::kText, outcome.empty() ? "" : "This step: " + outcome);
    rest.take_right(theme.px(12));
  }
  const Rect upper{rest.x, rest.y + theme.px(9), rest.w, theme.px(25)};
  const Rect lower{rest.x, upper.y + upper.h, rest.w, theme.px(22)};
  if (!scenario) {
    draw_text(upper, theme.heading, colour::kText, "A scan without an exam");
    draw_text(
        lower, theme.text, colour::kMuted,
        "Nothing is scored. A scan of an exam's patient can be compared with its views: choose it on the start page.");
    return;
  }
  const Step& step = scenario->steps[number];
  Rect title = upper;
  const std::string count = std::to_string(number + 1) + " / " + std::to_string(scenario->steps.size());
  const Rect plate = title.take_left(text_width(theme.strong, count) + theme.px(16));
  fill(plate.inset(0, theme.px(1)), colour::kAccentDark, theme.px(4));
  draw_text(plate, theme.strong, colour::kText, count, Align::centre);
  title.take_left(theme.px(10));
  draw_text(title, theme.heading, colour::kText, step.title);
  ImFont* font = text_width(theme.text, step.instruction) <= lower.w ? theme.text : theme.small_text;
  draw_text(lower, font, colour::kMuted, step.instruction);
}

std::vector<glm::dvec3> path_until(const RecordedRun& run, double time_s) {
  constexpr double kSeen_mm = 0.5;
  std::vector<glm::dvec3> path;
  const std::size_t last = run.index_at(time_s);
  for (std::size_t i = 0; i <= last; ++i) {
    const std::optional<Pose>& pose = run.moments[i].newest_pose;
    if (pose && (path.empty() || glm::distance(path.back(), pose->translation) > kSeen_mm))
      path.push_back(pose->translation);
  }
  return path;
}

/// Outlines the recording's own image of the moment in the patient's space.
void draw_image_outline(const Theme& theme, const SpaceDrawing& drawing, const Replay& replay) {
  const RecordedRun& run = replay.run();
  const std::optional<Pose>& pose = replay.moment().newest_pose;
  const auto corners = run.images ? image_corners(*run.images, run.index_at(replay.time_s())) : std::nullopt;
  if (!pose || !corners) return;
  std::vector<glm::dvec3> outline;
  for (const std::size_t i : {0, 1, 2, 3, 0}) outline.push_back(pose->point((*corners)[i]));
  drawing.path(outline, colour::kText, theme.px(1));
}

void draw_paths(const Theme& theme, const Rect& panel, const Replay& replay, const view::OrbitCamera& camera) {
  const SpaceDrawing drawing(panel, camera);
  if (const std::optional<double> expert_s = replay.expert_time_s()) {
    const RecordedRun& expert = *replay.expert();
    drawing.path(path_until(expert, expert.duration_s()), colour::kExpert & IM_COL32(255, 255, 255, 120), theme.px(1));
    drawing.path(path_until(expert, *expert_s), colour::kExpert, theme.px(1.5f));
    const RunMoment& moment = expert.at(*expert_s);
    const Machine& machine = expert.machine_at(*expert_s);
    if (moment.shown_pose)
      drawing.fan(*moment.shown_pose, machine.transducer(), machine.depth_mm, colour::kExpert,
                  IM_COL32(226, 214, 244, 36));
  }
  drawing.path(path_until(replay.run(), replay.time_s()), colour::kAccent, theme.px(2));
  draw_image_outline(theme, drawing, replay);
}

}  // namespace

std::optional<View> draw_replay_page(const Theme& theme, const ReplayPlaces& places, Trainer& trainer,
                                     SpacePanel& space, RecordedPanel& recorded, std::map<std::string, Rect>& names,
                                     const SpaceOverlay& overlay) {
  Replay& replay = *trainer.replay();
  const LoadedCase& loaded_case = *trainer.loaded_case();
  const Scenario* scenario = loaded_case.scenario ? &*loaded_case.scenario : nullptr;
  std::optional<View> double_clicked;
  draw_top(theme, places.top, replay, scenario);
  if (places.ultrasound.w > 0 &&
      UltrasoundPanel::draw_still(theme, places.ultrasound, loaded_case.subject.name, replay.machine(),
                                  replay.annotations(), replay.run().lost_for_s(replay.time_s()), trainer.pictures()))
    double_clicked = View::ultrasound;
  if (places.recorded.w > 0) recorded.draw(theme, places.recorded, replay, trainer.pictures());
  if (places.space.w > 0) {
    const auto lines = [&] {
      overlay.lines();
      draw_paths(theme, places.space, replay, trainer.pictures().camera);
    };
    if (space.draw(theme, places.space, nullptr, trainer.pictures(), names, {lines, overlay.buttons}))
      double_clicked = View::space;
  }
  draw_timeline_panel(theme, places.timeline, replay, scenario, names);
  return double_clicked;
}

}  // namespace insonate::ui
