#pragma once

#include <functional>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/panels/canvas.h"
#include "app/panels/check/check_panel.h"
#include "app/panels/layout.h"
#include "app/panels/learners/learners_panel.h"
#include "app/panels/pages/help_page.h"
#include "app/panels/pages/open_dialog.h"
#include "app/panels/pages/overlays.h"
#include "app/panels/replay/recorded_panel.h"
#include "app/panels/scan/score_sheet.h"
#include "app/panels/scan/task_panel.h"
#include "app/panels/scan/ultrasound_panel.h"
#include "app/panels/setup/setup_page.h"
#include "app/panels/start/start_panel.h"
#include "app/panels/views/ct_panel.h"
#include "app/panels/views/look_panel.h"
#include "app/panels/views/views_panel.h"
#include "app/panels/views/volume_page.h"
#include "app/panels/widgets/text_field.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/toast.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

/// What lies over the screen; the later ones wait while an earlier one is there.
enum class Overlay { none, problem, loading, setup, help, about, settings, open, leave, volume, briefing, score };

/// Returns the overlay's name, as state files have it: "problem"; "" for none.
const char* to_string(Overlay overlay);

/// Draws the trainer's whole screen: owns ImGui and its OpenGL renderer, lays out the panels, and shows the overlays.
/// Does not depend on a window. Needs an OpenGL context.
class Screen {
public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Lays out a frame, and draws what it changes. Returns whether it changes anything. The caller sets ImGui's display
  /// size, time step and input before.
  /// @param times  receives how long it takes, unless null
  bool render(Trainer& trainer, FrameTimes* times = nullptr);
  /// Returns the drawn frame.
  Image<Rgba8> read() const { return canvas_.read(); }
  /// Returns the drawn frame, for a window to show.
  const Canvas& canvas() const { return canvas_; }

  /// Returns the pixels of each picture on a screen of that size.
  PictureSizes picture_sizes(const Trainer& trainer, float width, float height);
  /// Returns where the ultrasound's plane was on the screen in the last frame.
  PlaneOnScreen plane_on_screen(const Trainer& trainer) const {
    return UltrasoundPanel::plane(theme_, place(View::ultrasound), trainer.pictures());
  }

  /// Chooses where the views lie, from the next frame on.
  void choose(LayoutName layout, Trainer& trainer);
  /// Shows the panel that sets how the patient looks in the 3D view, in place of the CT's views, or closes it.
  void toggle_look(Trainer& trainer);
  /// Shows the panel with the effects of the picture's model, or closes it.
  void toggle_effects(Trainer& trainer);
  /// Begins the set-up of the tracker. In steps that it would end, shows what to do first.
  void begin_setup(Trainer& trainer);
  /// Takes the probe from the tracker or gives it back. If this ends steps, it has to be called twice within 6 s.
  void switch_holder(Trainer& trainer);
  /// Leaves the steps for practice. If they are under way, it has to be called twice within 6 s.
  void practise(Trainer& trainer);
  /// Makes a view large, or all views as they were if one is.
  void enlarge(View view) { large_ = large_ ? std::nullopt : std::optional(view); }
  const std::optional<View>& large() const { return large_; }

  /// Saves the ultrasound, with everything that is drawn on it, from one of the next frames.
  void save_picture(const Trainer& trainer) { saves_picture_ = can_save(trainer); }
  /// Begins a clip of the ultrasound, or ends it.
  void toggle_clip(Trainer& trainer);

  /// Shows the score sheet of the steps that are over, or closes it; if there is none, says when it comes.
  void toggle_sheet(const Trainer& trainer);

  /// Begins the steps of a demonstration that is over, with the probe in the person's own hand.
  void try_yourself(Trainer& trainer) { answer_score(trainer, ScoreAnswer::own_try); }

  /// Shows a sentence over the screen for some seconds.
  void show_note(std::string text) { toast_.show(std::move(text)); }
  const Toast& toast() const { return toast_; }

  /// Opens a page that a person can ask for, such as the help, or closes it if it is the topmost.
  void toggle(Overlay page);
  /// Opens the dialog that finds a file or folder.
  void ask_for_path(Wanted wanted = Wanted::anything);
  /// Shows the page of the swept volume, or closes it; if there is none, shows how one is made.
  void toggle_volume(const Trainer& trainer);
  OpenDialog& open_dialog() { return open_dialog_; }
  VolumePage& volume_page() { return volume_page_; }
  const VolumePage& volume_page() const { return volume_page_; }
  /// Goes back to the start page. Asks first if unfinished steps or an unsaved sweep would be lost, as the next two do.
  void leave(Trainer& trainer);
  /// Opens a file or folder, as Trainer::open() does.
  void open(const std::filesystem::path& path, Trainer& trainer);
  /// Ends the program. Called once more, it asks nothing; an exam that counts is handed in then.
  void quit(Trainer& trainer);
  /// Returns whether the program is to end.
  bool quits() const { return quits_; }
  /// Closes the overlay without an answer, as Escape does.
  void dismiss(Trainer& trainer);
  /// Answers the overlay as Enter does.
  void confirm(Trainer& trainer);
  /// Continues where the screen waits, as the probe's button does: acknowledges the overlay, goes on to the next step
  /// of an exam, and after the exam begins the next attempt.
  void go_on(Trainer& trainer);
  /// Returns whether an overlay or a text field takes the keys, so that they do not move the probe.
  bool takes_keys(const Trainer& trainer) const { return overlay(trainer) != Overlay::none || types_text(trainer); }
  /// Returns whether a text field is open.
  bool types_text(const Trainer& trainer) const { return overlay(trainer) == Overlay::open || types_in_panel(trainer); }
  /// Returns whether a text field is about to open. It accepts text from one of the next frames on.
  bool opens_text_field(const Trainer& trainer) const {
    if (!types_text(trainer)) return false;
    if (!types_in_panel(trainer)) return !open_dialog_.ready();
    if (trainer.learners_page()) return !learners_panel_.ready();
    return trainer.start_page() ? !start_panel_.ready() : !text_field_.ready();
  }

  /// Returns the overlay that is shown now.
  Overlay overlay(const Trainer& trainer) const;
  /// Returns how many pixels the last render() has drawn.
  long pixels_drawn() const { return canvas_.pixels_drawn(); }
  /// Sets the rate that the status line shows; it shows none for 0.
  void set_pictures_per_second(double rate) { pictures_per_second_ = rate; }
  /// Returns the texts of the last frame that did not fit.
  const std::vector<std::string>& cut_texts() const { return cut_texts_; }
  /// Returns the panels' rectangles, by name.
  const std::map<std::string, Rect>& places() const { return places_; }

private:
  bool types_in_panel(const Trainer& trainer) const {
    if (overlay(trainer) != Overlay::none) return false;
    if (trainer.learners_page()) return learners_panel_.types_text();
    return trainer.start_page() ? start_panel_.types_text() : text_field_.is_open();
  }
  void step_on(Trainer& trainer);
  void lay_out(const Trainer& trainer, float width, float height);
  void draw_panels(Trainer& trainer);
  void draw_session(Trainer& trainer);
  void draw_space(Trainer& trainer, const Guiding* guiding);
  void draw_space_buttons(Trainer& trainer);
  void draw_effects_button(Trainer& trainer, Rect& row);
  void draw_names_button(Trainer& trainer, Rect& row);
  void draw_aside(Trainer& trainer);
  bool may_look(const Trainer& trainer) const;
  /// A panel in place of the CT's views.
  enum class Aside { none, look, effects };
  Aside shown_aside(const Trainer& trainer) const;
  void toggle(Aside panel, Trainer& trainer);
  void put_aside(Aside panel, Trainer& trainer);
  bool close_aside(Trainer& trainer);
  void draw_space_lines(const Trainer& trainer);
  void draw_ct_views(Trainer& trainer, const Guiding* guiding);
  void draw_layout_buttons(Trainer& trainer, Rect& line);
  void draw_overlay(Trainer& trainer);
  void draw_record_button(Trainer& trainer, const Rect& where);
  void draw_status(Trainer& trainer);
  void draw_status_words(const Trainer& trainer, Rect line);
  void draw_sweep_buttons(Trainer& trainer, Rect& line);
  void draw_start_page(Trainer& trainer);
  void draw_learners_page(Trainer& trainer);
  void draw_check_page(Trainer& trainer);
  void draw_demonstration(Trainer& trainer);
  void take_path(Trainer& trainer);
  Rect toast_place(const Trainer& trainer) const;
  void draw_toast(const Trainer& trainer);
  void forget_old_toast(const Trainer& trainer);
  void show_on_desktop(const std::filesystem::path& path);
  void note_unopened();
  void ask_to_leave(Trainer& trainer, bool ends, const std::function<void(Trainer&)>& go_on);
  /// Returns whether an exam that counts is being taken.
  static bool takes_exam(const Trainer& trainer);
  static bool hides_anatomy(const Trainer& trainer) { return trainer.session() && !trainer.session()->shows_anatomy(); }
  bool asked_before(double& last_s);
  bool keeps_steps(const Trainer& trainer);
  void draw_time_runs_on(const Session& session);
  Overlay top_page() const { return pages_.empty() ? Overlay::none : pages_.back(); }
  void show_page(Overlay page);
  void close_page();
  HelpTopic help_topic(const Trainer& trainer) const;
  static const ExamResult* sheet(const Trainer& trainer);
  /// Returns the id of who is learning; empty for nobody in particular, and while a recorded scan is watched.
  static std::string learner_of(const Trainer& trainer);
  bool shows_sheet(const Trainer& trainer) const;
  void draw_setup(Trainer& trainer);
  bool can_save(const Trainer& trainer) const;
  static constexpr char kNoSlices[] = "This exam hides the CT: its slices come when it is over.";
  void capture(Trainer& trainer, bool changed);
  void answer_score(Trainer& trainer, ScoreAnswer answer);

  struct ImGuiOwner {
    ImGuiOwner();
    ~ImGuiOwner();
  } imgui_;
  Canvas canvas_;
  Theme theme_;
  std::string device_;
  SpacePanel space_;
  CtPanel ct_panel_;
  LookPanel look_panel_;
  Aside aside_ = Aside::none;
  double asked_to_leave_steps_s_ = -1000, asked_to_set_up_s_ = -1000, asked_to_quit_s_ = -1000;
  RecordedPanel recorded_panel_;
  VolumePage volume_page_;
  OpenDialog open_dialog_;
  TextField text_field_;
  StartPanel start_panel_;
  LearnersPanel learners_panel_;
  CheckPanel check_panel_;
  Toast toast_;
  /// The page that was shown in the last frame; whether its steps were over, and whether it had any.
  std::pair<const void*, std::array<bool, 2>> toast_page_{};
  std::future<bool> opening_;  ///< of opened_, by the desktop
  std::filesystem::path opened_;
  /// What the person asked for, the topmost last: help, about, settings, open, leave or volume.
  std::vector<Overlay> pages_;
  bool fonts_are_new_ = false, saves_picture_ = false, captures_ = false, toast_is_aside_ = false;
  bool quits_ = false;
  struct {
    bool ends = false;  ///< the program
    std::function<void(Trainer&)> go_on;
  } leaving_;  ///< what the person has chosen, and Overlay::leave asks about
  const ExamResult* closed_sheet_of_ = nullptr;
  double pictures_per_second_ = 0;
  /// Returns where a view is; empty if it is hidden.
  Rect place(View view) const {
    const auto found = views_.find(view);
    return found == views_.end() ? Rect() : found->second;
  }

  Rect screen_, top_, strip_, task_, guide_, console_, status_, aside_place_;
  std::map<View, Rect> views_;
  std::optional<View> large_;
  std::map<std::string, Rect> places_;
  std::vector<std::string> cut_texts_;
};

}  // namespace insonate::ui
