#include "app/panels/setup/setup_page.h"

#include <algorithm>

#include "app/panels/setup/setup_sketches.h"
#include "devices/live/steady_clock.h"

namespace insonate::ui {
namespace {

void draw_tracker(const Theme& theme, Rect where, const TrackerState& state) {
  const bool fine = state.condition == TrackerCondition::tracking && state.last_status == PoseStatus::ok;
  const std::string& text = !state.problem.empty() ? state.problem
                            : fine                 ? state.name
                                                   : state.name + ": no usable pose";
  const float width = std::min(text_width(theme.text, text), where.w - theme.px(20));
  draw_text(where.take_right(width), theme.text, fine ? colour::kMuted : colour::kAmber, text);
  ImGui::GetWindowDrawList()->AddCircleFilled({where.x + where.w - theme.px(12), where.y + where.h / 2}, theme.px(5),
                                              fine ? colour::kAccent : colour::kAmber, 20);
}

void draw_steps(const Theme& theme, Rect where, SetupWizard& wizard, std::map<std::string, Rect>& places) {
  const std::vector<SetupWizard::Row> rows = wizard.rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Rect row = where.take_top(theme.px(72));
    where.take_top(theme.px(8));
    const std::string id(rows[i].name);
    places["setup_" + id] = row;
    const bool current = i == wizard.current(), can = wizard.why_not(i).empty(), made = !rows[i].figure.empty();
    if (button(theme, id.c_str(), row, "", current ? ButtonKind::chosen : ButtonKind::normal, can) && !current)
      wizard.go_to(i);
    draw_tooltip(theme, row, wizard.why_not(i));
    Rect text = row.inset(theme.px(14), theme.px(12));
    const Rect number = text.take_left(theme.px(32));
    const ImVec2 centre = number.centre();
    ImGui::GetWindowDrawList()->AddCircleFilled(centre, theme.px(15), made ? colour::kAccent : colour::kBackground, 32);
    draw_ring(centre, theme.px(15), theme.px(2.5f),
              made      ? 1
              : current ? wizard.view().share
                        : 0,
              colour::kAccent, colour::kFaint);
    draw_text(number, theme.strong, made ? colour::kBackground : colour::kText, std::to_string(i + 1), Align::centre);
    text.take_left(theme.px(14));
    draw_text(text.take_top(text.h / 2), theme.strong, can ? colour::kText : colour::kFaint, rows[i].title);
    draw_text(text, theme.small_text,
              current ? colour::kText
              : made  ? colour::kMuted
                      : colour::kFaint,
              made  ? rows[i].figure
              : can ? "to be made"
                    : "not yet");
  }
}

/// Returns why an attempt did not count, or why there is no next step.
std::string complaint(const SetupWizard& wizard, const SetupView& view) {
  if (!view.refusal.empty() || !view.done || wizard.current() + 1 == kSetupSteps.size()) return view.refusal;
  return wizard.why_not(wizard.current() + 1);
}

void draw_progress(const Theme& theme, const Rect& bar, double share) {
  fill(bar, colour::kRaised, theme.px(5));
  const float done = bar.w * float(std::clamp(share, 0.0, 1.0));
  if (done > bar.h) fill({bar.x, bar.y, done, bar.h}, colour::kAccent, theme.px(5));
}

/// Draws a plate with a coloured edge at the bottom of the remaining space.
void draw_plate(const Theme& theme, Rect& rest, ImU32 edge, ImU32 ink, ImFont* font, std::string_view text) {
  const float edge_width = theme.px(6), dx = theme.px(16), dy = theme.px(10);
  const float height = paragraph_height(font, text, rest.w - edge_width - 2 * dx) + 2 * dy;
  Rect plate = rest.take_bottom(std::max(height, theme.px(84)));
  fill(plate, colour::kRaised, theme.px(4));
  fill(plate.take_left(edge_width), edge, theme.px(3));
  draw_paragraph(plate.inset(dx, dy), font, ink, text);
  rest.take_bottom(theme.px(8));
}

void draw_task(const Theme& theme, const Rect& panel, const SetupWizard& wizard, const std::string& next_start,
               const glm::dvec3& belly, Pictures& pictures) {
  fill(panel, colour::kPanel, theme.px(8));
  Rect rest = panel.inset(theme.px(30), theme.px(24));
  const SetupView view = wizard.view();
  draw_text(rest.take_top(theme.px(40)), theme.title, colour::kText, view.title);
  rest.take_top(theme.px(10));
  const std::string found = "Found: " + view.result + ".";
  const float height =
      draw_paragraph(rest, theme.large, view.done ? colour::kAccent : colour::kText, view.done ? found : view.task);
  rest.take_top(std::max(height, theme.px(64)) + theme.px(10));
  draw_progress(theme, rest.take_bottom(theme.px(10)), view.share);
  rest.take_bottom(theme.px(10));
  Rect line = rest.take_bottom(theme.px(28));
  draw_text(line.take_right(text_width(theme.heading, wizard.rehearsal())), theme.heading, colour::kText,
            wizard.rehearsal());
  draw_text(line, theme.heading, view.reading ? colour::kAccent : colour::kMuted, view.feedback);
  rest.take_bottom(theme.px(8));
  if (const std::string why = complaint(wizard, view); !why.empty())
    draw_plate(theme, rest, colour::kAmber, colour::kAmber, theme.large, why);
  else if (view.done && why_incomplete(wizard.calibration()).empty())
    draw_plate(theme, rest, colour::kAccent, colour::kText, theme.large, "The probe can be used. " + next_start);
  else if (view.share == 0 && !view.reading && why_incomplete(wizard.calibration()).empty())
    draw_plate(theme, rest, colour::kAccent, colour::kText, theme.large,
               wizard.rows()[wizard.current()].figure.empty()
                   ? "The probe can be used without this step: Escape leaves it out."
                   : "This step has been made, and Escape keeps it. A mark begins it again.");
  draw_setup_sketch(theme, rest, wizard, belly, pictures);
}

}  // namespace

bool draw_setup_page(const Theme& theme, const Rect& screen, SetupWizard& wizard, const std::string& next_start,
                     const glm::dvec3& belly, Pictures& pictures, std::map<std::string, Rect>& places) {
  ImGui::SetNextWindowPos(screen.min());
  ImGui::SetNextWindowSize({screen.w, screen.h});
  ImGui::SetNextWindowFocus();
  ImGui::Begin("setup", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  Rect page = screen.inset(theme.px(24), theme.px(18));
  Rect head = page.take_top(theme.px(36));
  draw_text(head.take_left(theme.px(340)), theme.heading, colour::kText, "Set-up of the tracker");
  draw_tracker(theme, head, wizard.tracker_state());
  page.take_top(theme.px(10));

  Rect buttons = page.take_bottom(theme.px(54));
  page.take_bottom(theme.px(14));
  bool close = false;
  const auto next = [&](const char* id, float width, std::string_view text, ButtonKind kind = ButtonKind::normal,
                        bool enabled = true, std::string_view tip = {}) {
    const Rect place = buttons.take_right(theme.text_px(width));
    buttons.take_right(theme.px(10));
    places[std::string("setup_") + id] = place;
    return button(theme, id, place, text, kind, enabled, tip);
  };
  const bool done = wizard.view().done, last = done && wizard.current() + 1 == kSetupSteps.size();
  const bool heard = wizard.tracker_state().condition != TrackerCondition::waiting;
  if (next("mark", 250,
           last   ? "Finish  (Space)"
           : done ? "Next step  (Space)"
                  : "Mark  (Space)",
           ButtonKind::primary, done ? !wizard.strikes_on() : heard))
    wizard.mark(steady_now_s());
  const SetupView shown = wizard.view();
  if (next("undo", 190, done ? "Again  (Backspace)" : "Take back  (Backspace)", ButtonKind::normal,
           done || shown.reading || shown.share > 0 || !shown.refusal.empty()))
    wizard.undo();
  if (next("close", 130, "Close  (Esc)")) close = true;
  if (kSetupSteps[wizard.current()] == "landmarks" && wizard.can_be_moved() &&
      next("moved", 270, "Only mannequin or base moved", wizard.moved() ? ButtonKind::chosen : ButtonKind::normal, true,
           "Touches the landmarks again that were touched last time, and leaves the other steps as they are"))
    wizard.set_moved(!wizard.moved());
  draw_text(buttons, theme.small_text, heard ? colour::kMuted : colour::kAmber,
            heard ? "Each finished step is kept in " + wizard.file().string()
                  : "Nothing to mark: no pose has come from the tracker yet.");

  draw_steps(theme, page.take_left(theme.px(270)), wizard, places);
  page.take_left(theme.px(18));
  draw_task(theme, page, wizard, next_start, belly, pictures);
  ImGui::End();
  return close;
}

}  // namespace insonate::ui
