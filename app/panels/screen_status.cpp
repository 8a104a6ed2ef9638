#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "app/panels/scan/exam_panel.h"
#include "app/panels/screen.h"
#include "sim/core/text.h"

// The line at the bottom of a scan: its buttons, and what it says beside them.
namespace insonate::ui {

/// Draws a button per layout that shows where its views lie.
void Screen::draw_layout_buttons(Trainer& trainer, Rect& line) {
  static constexpr std::array<const char*, 3> kTips{
      "The ultrasound large, beside it the 3D view and the CT in its plane  (F5)",
      "The ultrasound beside axial, coronal and sagittal slices of the CT  (F6)",
      "Four views of one size  (F7). A double click makes any view large."};
  for (std::size_t i = 0; i < kLayoutNames.size(); ++i) {
    const std::string id = std::string("layout_") + kLayoutNames[i];
    const Rect where = places_[id] = line.take_left(theme_.px(36)).inset(0, theme_.px(6));
    line.take_left(theme_.px(4));
    const bool chosen =
        trainer.preferences().look.layout == LayoutName(i) && !large_ && shown_aside(trainer) == Aside::none;
    const bool can = LayoutName(i) != LayoutName::slices || !hides_anatomy(trainer);
    if (button(theme_, id.c_str(), where, "", chosen ? ButtonKind::chosen : ButtonKind::normal, can,
               can ? kTips[i] : kNoSlices))
      choose(LayoutName(i), trainer);
    for (const auto& [view, part] : ui::lay_out({LayoutName(i), {}}, where.inset(theme_.px(6), theme_.px(5)), 2, {}))
      fill(part, view == View::ultrasound ? colour::kText : colour::kFaint, 1);
  }
  line.take_left(theme_.px(4));
}

void Screen::draw_record_button(Trainer& trainer, const Rect& where) {
  const RunRecorder& recorder = trainer.recorder();
  const bool running = recorder.running();
  const std::string text = running ? "Recording " + clock_text(recorder.duration_s()) : "Record";
  if (!button(theme_, "record", where, text, running ? ButtonKind::recording : ButtonKind::normal,
              trainer.session() != nullptr, "Records every pose of the probe, for replay and scoring  (R)"))
    return;
  running ? trainer.stop_recording() : trainer.start_recording();
}

/// The button that begins and ends a sweep, and the one that shows its volume once there is one.
void Screen::draw_sweep_buttons(Trainer& trainer, Rect& line) {
  if (!trainer.session()) return;
  const SweepRecorder& sweep = trainer.sweep();
  const std::string text = sweep.running()          ? "Sweep " + clock_text(sweep.quality().duration_s)
                           : sweep.reconstructing() ? "Sweep \u2026"
                                                    : "Sweep";
  places_["sweep"] = line.take_left(theme_.px(96)).inset(0, theme_.px(6));
  line.take_left(theme_.px(8));
  if (button(theme_, "sweep", places_["sweep"], text, sweep.running() ? ButtonKind::recording : ButtonKind::normal,
             trainer.can_sweep(), "Begins and ends a sweep, whose pictures become a volume  (T)"))
    trainer.toggle_sweep();
  if (!trainer.swept()) return;
  places_["volume"] = line.take_left(theme_.px(80)).inset(0, theme_.px(6));
  line.take_left(theme_.px(8));
  if (button(theme_, "volume", places_["volume"], "Volume", ButtonKind::normal, true,
             "Shows the swept volume in three planes  (U)"))
    toggle_volume(trainer);
}

void Screen::draw_status(Trainer& trainer) {
  Rect line = status_.inset(theme_.px(16), 0);
  if (pictures_per_second_ > 0) {
    draw_text(line.take_right(theme_.px(100)), theme_.small_text, colour::kFaint,
              formatted("%.0f pictures/s", pictures_per_second_), Align::right);
  }
  places_["start_page"] = line.take_left(theme_.px(110)).inset(0, theme_.px(6));
  line.take_left(theme_.px(8));
  if (button(theme_, "start_page", places_["start_page"],
             trainer.leads_to_learners() ? "Learners"
             : trainer.leads_to_check()  ? "Check"
                                         : "Start page",
             ButtonKind::normal, trainer.can_leave(),
             !trainer.can_leave()          ? "This exam counts: go on to its end, then it can be left."
             : trainer.leads_to_learners() ? "Back to the learners  (Esc)"
             : trainer.leads_to_check()    ? "Back to the check of the scenario  (Esc)"
                                           : "Leaves this, and shows what else there is to do  (Esc)"))
    return leave(trainer);
  if (!trainer.replay()) {
    places_["record"] = line.take_left(theme_.px(124)).inset(0, theme_.px(6));
    draw_record_button(trainer, places_["record"]);
    line.take_left(theme_.px(8));
    places_["setup"] = line.take_left(theme_.px(90)).inset(0, theme_.px(6));
    if (button(theme_, "setup", places_["setup"], "Set up", ButtonKind::normal,
               trainer.session() && !trainer.session()->strict(),
               trainer.session() && trainer.session()->strict()
                   ? "This exam counts: go on to its end, then the tracker can be set up."
                   : "Finds how the tracker's sensor lies on the dummy probe  (F2)"))
      begin_setup(trainer);
    line.take_left(theme_.px(8));
  }
  const auto next = [&](const char* id, float width, const std::string& text, ButtonKind kind, bool enabled,
                        const char* tip) {
    const Rect place = places_[id] = line.take_left(theme_.px(width)).inset(0, theme_.px(6));
    line.take_left(theme_.px(8));
    return button(theme_, id, place, text, kind, enabled, tip);
  };
  const ClipRecorder& clip = trainer.clip();
  const auto if_shown = [&](const char* tip) {
    return place(View::ultrasound).w > 0 ? tip : "The ultrasound is not shown now: Esc shows all views again.";
  };
  if (next("picture", 80, "Picture", ButtonKind::normal, can_save(trainer),
           if_shown("Saves the ultrasound as a PNG  (P)")))
    saves_picture_ = true;
  if (next("clip", 96, clip.running() ? "Clip " + clock_text(clip.duration_s()) : "Clip",
           clip.running() ? ButtonKind::recording : ButtonKind::normal, clip.running() || can_save(trainer),
           if_shown("Begins and ends a film of the ultrasound, a WebM file  (L)")))
    toggle_clip(trainer);
  draw_sweep_buttons(trainer, line);
  if (sheet(trainer) && next("score_sheet", 72, "Score", ButtonKind::normal, true, "Shows the score sheet again  (F4)"))
    toggle_sheet(trainer);
  if (next("settings", 84, "Settings", ButtonKind::normal, true, "Text, marker, colours, folders  (F3)"))
    show_page(Overlay::settings);
  draw_layout_buttons(trainer, line);
  draw_status_words(trainer, line);
}

/// What is wrong, how a sweep goes, or which keys there are.
void Screen::draw_status_words(const Trainer& trainer, Rect line) {
  if (!trainer.shader_problem().empty()) {
    std::string problem = "Shaders kept as they were: " + trainer.shader_problem();
    std::replace(problem.begin(), problem.end(), '\n', ' ');
    draw_text(line, theme_.small_text, colour::kAmber, problem);
    draw_tooltip(theme_, line, problem);
    return;
  }
  if (!trainer.calibration_warning().empty()) {
    draw_text(line, theme_.small_text, colour::kAmber, trainer.calibration_warning());
    draw_tooltip(theme_, line, trainer.calibration_warning());
    return;
  }
  if (trainer.sweep().running()) {
    const SweepQuality quality = trainer.sweep().quality();
    const std::string words =
        "Sweep: " + (quality.flaws.empty()
                         ? formatted("%.0f mm, at most %.1f mm apart", quality.length_mm, quality.largest_spacing_mm)
                         : quality.flaws.back().words());
    draw_text(line, theme_.small_text, quality.flaws.empty() ? colour::kMuted : colour::kAmber, words);
    return;
  }
  using Keys = std::vector<std::string>;
  const Keys keys = trainer.replay() ? Keys{"Space play", "\u2190 \u2192 sample by sample", "\u2191 \u2193 speed",
                                            "Home End", "Ctrl O open"}
                    : trainer.session() && trainer.session()->strict()
                        ? Keys{"F1 help", "Space freeze", "P picture", "L clip"}
                        : Keys{"F1 help", "Tab probe", "Space freeze", "P picture", "L clip", "V view"};
  // The help has all of them, so those that do not fit are left out.
  for (const std::string& key : keys) {
    const float width = text_width(theme_.small_text, key);
    if (width > line.w) break;
    draw_text(line.take_left(width), theme_.small_text, colour::kMuted, key);
    line.take_left(theme_.px(16));
  }
}

}  // namespace insonate::ui
