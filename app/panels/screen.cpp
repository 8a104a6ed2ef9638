#include "app/panels/screen.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/panels/pages/open_on_desktop.h"
#include "app/panels/replay/replay_page.h"
#include "app/panels/scan/author_panel.h"
#include "app/panels/scan/console_panel.h"
#include "app/panels/scan/effects_panel.h"
#include "app/panels/scan/exam_panel.h"
#include "app/panels/scan/guide_layer.h"
#include "app/panels/scan/ultrasound_panel.h"
#include "app/panels/views/space_lines.h"
#include "sim/files/files.h"
#include "sim/gl/headless_context.h"

namespace insonate::ui {
namespace {

/// For how long a key that loses something may be pressed once more.
constexpr double kAsked_s = 6;

/// Whether an overlay keeps the learner from the scan behind it. The set-up has no session behind it, the briefing one
/// that has not begun, and the score one that is over.
bool covers(Overlay overlay) {
  return overlay != Overlay::none && overlay != Overlay::setup && overlay != Overlay::briefing &&
         overlay != Overlay::score;
}

}  // namespace

Screen::ImGuiOwner::ImGuiOwner() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed, so there is nothing to store
}

Screen::ImGuiOwner::~ImGuiOwner() {
  ImGui::DestroyContext();
}

Screen::Screen() : theme_(assets_folder() / "fonts"), device_(gl::device_description()) {}
Screen::~Screen() = default;

void Screen::lay_out(const Trainer& trainer, float width, float height) {
  screen_ = {0, 0, width, height};
  if (trainer.start_page() || trainer.learners_page() || trainer.check_page()) {
    views_.clear();
    large_.reset();
    return places_.clear();
  }
  const float gap = theme_.px(8);
  Rect rest = screen_.inset(gap, gap);
  rest.h += gap;
  status_ = rest.take_bottom(theme_.px(38));
  top_ = rest.take_top(exam_panel_height(theme_, rest.w, trainer.session()));
  rest.take_top(gap);
  strip_ = task_ = {};
  if (trainer.demonstration()) {
    strip_ = rest.take_top(theme_.px(44));
    rest.take_top(gap);
  }
  if (const Session* session = trainer.session(); session && (trainer.author() || has_task_panel(*session))) {
    task_ = rest.take_top(trainer.author() ? author_panel_height(theme_)
                                           : task_panel_height(theme_, *session, trainer.picture_tools(),
                                                               trainer.step_controls(), rest.w));
    rest.take_top(gap);
  }
  guide_ = {};
  if (trainer.session() && trainer.guide().now(*trainer.session())) {
    guide_ = rest.take_top(guide_strip_height(theme_));
    rest.take_top(gap);
  }
  // A replay has charts below its time line.
  console_ = rest.take_bottom(trainer.replay() ? theme_.px(272) : console_height(theme_, rest.w));
  rest.take_bottom(gap);
  const bool anatomy = !trainer.session() || trainer.session()->shows_anatomy();
  const bool recorded = trainer.replay() && trainer.replay()->run().images;
  const bool shows_aside = shown_aside(trainer) != Aside::none;
  views_ = ui::lay_out({shows_aside ? LayoutName::standard : trainer.preferences().look.layout, large_}, rest, gap,
                       {anatomy, recorded, trainer.replay() != nullptr, shows_aside});
  aside_place_ = {};
  if (shows_aside && !large_) {  // in place of the CT's views
    const Rect slice = place(View::slice), blend = place(View::blend);
    aside_place_ = {slice.x, slice.y, blend.x + blend.w - slice.x, slice.h};
    views_.erase(View::slice);
    views_.erase(View::blend);
    // A curve needs some height to be edited, also on a small screen.
    Rect& space = views_[View::space];
    const float bottom = aside_place_.y + aside_place_.h;
    aside_place_.h = std::max(aside_place_.h, std::min(theme_.px(250), 0.57f * (bottom - space.y)));
    aside_place_.y = bottom - aside_place_.h;
    space.h = aside_place_.y - gap - space.y;
  }
  places_ = {{"console", console_}, {"exam", top_}};
  for (const auto& [view, rect] : views_) places_[name_of(view)] = rect;
}

PictureSizes Screen::picture_sizes(const Trainer& trainer, float width, float height) {
  if (theme_.fit(width, height, trainer.preferences().look)) fonts_are_new_ = true;
  lay_out(trainer, width, height);
  const auto size = [&](View view) { return glm::ivec2(place(view).w, place(view).h); };
  // A hidden ultrasound is drawn for the view that is large: the blend contains it.
  const Rect ultrasound = UltrasoundPanel::picture_area(
      theme_, place(View::ultrasound).w > 0 || views_.empty() ? place(View::ultrasound) : views_.begin()->second);
  const glm::ivec2 volume = size(View::space), slice = size(View::slice), blend = size(View::blend);
  return {int(ultrasound.w), int(ultrasound.h), volume.x,
          volume.y,          slice.x,           slice.y,
          blend.x,           blend.y,           {size(View::axial), size(View::coronal), size(View::sagittal)}};
}

void Screen::choose(LayoutName layout, Trainer& trainer) {
  if (layout == LayoutName::slices && hides_anatomy(trainer)) return show_note(kNoSlices);
  aside_ = Aside::none;
  large_.reset();
  Preferences preferences = trainer.preferences();
  preferences.look.layout = layout;
  trainer.prefer(preferences);
}

bool Screen::render(Trainer& trainer, FrameTimes* times) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  if (theme_.fit(size.x, size.y, trainer.preferences().look) || std::exchange(fonts_are_new_, false) ||
      !ImGui::GetIO().Fonts->TexID)
    canvas_.make_fonts();
  ImGui::NewFrame();
  captures_ = saves_picture_;
  hide_tips(captures_);  // a tip may reach over the ultrasound
  lay_out(trainer, size.x, size.y);
  draw_panels(trainer);
  draw_overlay(trainer);
  forget_old_toast(trainer);
  for (const Notice& notice : trainer.take_notices()) toast_.show(notice.text, notice.file);
  if (trainer.time_runs_on()) draw_time_runs_on(*trainer.session());
  draw_toast(trainer);
  trainer.cover(covers(overlay(trainer)));
  ImGui::Render();
  cut_texts_ = take_cut_texts();
  if (times) times->end(FramePart::layout);
  const bool changed = canvas_.draw(*ImGui::GetDrawData(), colour::kBackground, [&](ImTextureID texture) {
    const GLuint name = GLuint(reinterpret_cast<std::uintptr_t>(texture));
    return std::max(
        {trainer.pictures().version_of(name), recorded_panel_.version_of(name), volume_page_.version_of(name)});
  });
  if (times) times->end(FramePart::window);
  capture(trainer, changed);
  return changed;
}

/// Saves the ultrasound as it is on the screen, if the person has asked for it and nothing covers it.
void Screen::capture(Trainer& trainer, bool changed) {
  const bool clip = trainer.clip().running();
  if (!can_save(trainer)) saves_picture_ = false;
  if (!(captures_ || (clip && changed)) || !can_save(trainer)) return;
  if (toast_.left_s() > 0 && !toast_is_aside_) return toast_.hide();  // which uncovers the picture in the next frame
  const Rect seen = place(View::ultrasound);
  const Image<Rgba8> picture = canvas_.read({int(seen.x), int(seen.y), int(seen.x + seen.w), int(seen.y + seen.h)});
  if (!captures_) {
    trainer.clip().take(picture, ImGui::GetTime());
    return;
  }
  saves_picture_ = false;
  trainer.save_picture(picture);
}

void Screen::toggle_clip(Trainer& trainer) {
  if (trainer.clip().running()) return trainer.clip().stop(ImGui::GetTime());
  if (!can_save(trainer)) return;
  toast_.hide();
  trainer.start_clip();
}

bool Screen::can_save(const Trainer& trainer) const {
  return (trainer.session() || trainer.replay()) && overlay(trainer) == Overlay::none &&
         trainer.pictures().ultrasound() && place(View::ultrasound).w > 0;
}

void Screen::draw_panels(Trainer& trainer) {
  ImGui::SetNextWindowPos(screen_.min());
  ImGui::SetNextWindowSize({screen_.w, screen_.h});
  ImGui::Begin("trainer", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoScrollWithMouse);
  if (trainer.session()) {
    draw_session(trainer);
  } else if (trainer.replay()) {
    const std::optional<View> double_clicked = draw_replay_page(
        theme_, {top_, place(View::ultrasound), place(View::recorded), place(View::space), console_}, trainer, space_,
        recorded_panel_, places_, {[&] { draw_space_lines(trainer); }, [&] { draw_space_buttons(trainer); }});
    draw_ct_views(trainer, nullptr);
    draw_aside(trainer);
    if (double_clicked) enlarge(*double_clicked);
  } else if (trainer.start_page()) {
    draw_start_page(trainer);
    return ImGui::End();
  } else if (trainer.learners_page()) {
    draw_learners_page(trainer);
    return ImGui::End();
  } else if (trainer.check_page()) {
    draw_check_page(trainer);
    return ImGui::End();
  } else if (!trainer.exam_refused()) {
    for (const Rect& panel : {top_, console_}) fill(panel, colour::kPanel, theme_.px(4));
    for (const auto& [view, panel] : views_) fill(panel, colour::kImage, theme_.px(4));
  }
  if (!trainer.exam_refused()) draw_status(trainer);
  ImGui::End();
}

void Screen::draw_session(Trainer& trainer) {
  Session* session = trainer.session();
  draw_exam_panel(theme_, top_, *session, trainer.author() != nullptr, learner_of(trainer), places_);
  if (strip_.h > 0) draw_demonstration(trainer);
  if (!trainer.session()) return;  // it was left
  if (trainer.author())
    draw_author_panel(theme_, task_, trainer, text_field_, places_);
  else if (task_.h > 0)
    draw_task_panel(theme_, task_, *session, trainer.picture_tools(), trainer.step_controls(), text_field_, places_);
  if (const Rect panel = place(View::ultrasound); panel.w > 0)
    if (UltrasoundPanel::draw(theme_, panel, *session, trainer.pictures(), trainer.picture_tools(), places_, captures_))
      enlarge(View::ultrasound);
  const std::optional<Guiding> guiding = trainer.guide().now(*session);
  const Guiding* guide = guiding && guide_.h > 0 ? &*guiding : nullptr;
  draw_space(trainer, guide);
  if (guide) {
    draw_guide_strip(theme_, guide_, *guide, StepControls::active(*session));
    places_["guide"] = guide_;
  }
  draw_ct_views(trainer, guide);
  draw_aside(trainer);
  const auto attempt = [&](const std::function<void()>& action) { trainer.attempt(action); };
  switch (draw_console_panel(theme_, console_, *session, attempt, places_)) {
    case ConsoleRequest::help:
      show_page(Overlay::help);
      break;
    case ConsoleRequest::open:
      ask_for_path();
      break;
    case ConsoleRequest::brief:
      trainer.brief();
      break;
    case ConsoleRequest::switch_holder:
      switch_holder(trainer);
      break;
    case ConsoleRequest::practise:
      practise(trainer);
      break;
    case ConsoleRequest::none:
      break;
  }
}

void Screen::draw_space(Trainer& trainer, const Guiding* guiding) {
  const Rect panel = place(View::space);
  if (panel.w <= 0) return;
  const auto lines = [&] {
    draw_space_lines(trainer);
    if (trainer.swept() && trainer.session()->shows_anatomy())
      draw_swept_box(theme_, panel, *trainer.swept(), trainer.pictures().camera);
    if (guiding) draw_ghost(theme_, panel, *guiding, trainer.pictures().camera);
  };
  if (space_.draw(theme_, panel, trainer.session(), trainer.pictures(), places_,
                  {lines, [&] { draw_space_buttons(trainer); }}))
    enlarge(View::space);
}

/// Draws the lines over the 3D view. They show what lies inside the patient.
void Screen::draw_space_lines(const Trainer& trainer) {
  const Rect panel = place(View::space);
  const Session* session = trainer.session();
  if (panel.w <= 0 || !trainer.pictures().volume() || (session && !session->shows_anatomy())) return;
  draw_fan_edge(theme_, panel, trainer.pictures());
  if (theme_.look().landmarks && trainer.may_name_landmarks())
    draw_landmarks(theme_, panel, trainer.loaded_case()->subject.landmarks, trainer.pictures());
}

/// Draws the buttons in the 3D view's upper right corner.
void Screen::draw_space_buttons(Trainer& trainer) {
  Rect row = place(View::space).inset(theme_.px(4), theme_.px(4));
  row.h = theme_.px(26);
  draw_names_button(trainer, row);
  draw_effects_button(trainer, row);
  if (may_look(trainer) && button(theme_, "look", places_["look"] = row.take_right(theme_.px(58)), "Look",
                                  aside_ == Aside::look && !large_ ? ButtonKind::chosen : ButtonKind::normal, true,
                                  "Shows organs, or the CT itself: skin, muscles, vessels, bones  (K)"))
    toggle_look(trainer);
}

void Screen::draw_effects_button(Trainer& trainer, Rect& row) {
  if (!trainer.session() || !trainer.session()->shows_anatomy()) return;
  const Rect where = places_["effects"] = row.take_right(theme_.px(78));
  row.take_right(theme_.px(4));
  const std::string why_not = trainer.session()->why_not(ActionKind::effect);
  if (button(theme_, "effects", where, "Effects",
             aside_ == Aside::effects && !large_ ? ButtonKind::chosen : ButtonKind::normal,
             why_not.empty() || aside_ == Aside::effects,
             why_not.empty() ? "Turns the effects of the picture off and on, one by one  (F8)" : why_not.c_str()))
    toggle_effects(trainer);
}

void Screen::draw_names_button(Trainer& trainer, Rect& row) {
  if (!trainer.loaded_case() || trainer.loaded_case()->subject.landmarks.empty()) return;
  const bool may = trainer.may_name_landmarks(), shown = theme_.look().landmarks;
  const Rect where = places_["names"] = row.take_right(theme_.px(66));
  row.take_right(theme_.px(4));
  if (button(theme_, "names", where, "Names", shown && may ? ButtonKind::chosen : ButtonKind::normal, may,
             "Shows the landmarks of this patient with their names  (N)"))
    trainer.toggle_landmarks();
  if (!may)
    draw_tooltip(theme_, where,
                 trainer.session()->strict() ? "Names are help: an exam does not show them"
                                             : "Names are help: in scored steps they are shown with the guide  (G)");
}

/// Whether the patient's inside may be seen.
bool Screen::may_look(const Trainer& trainer) const {
  return trainer.session() ? trainer.session()->shows_anatomy() : trainer.replay() != nullptr;
}

void Screen::toggle_look(Trainer& trainer) {
  if (may_look(trainer)) toggle(Aside::look, trainer);
}

bool Screen::takes_exam(const Trainer& trainer) {
  const Session* session = trainer.session();
  return session && session->strict() && !session->result();
}

/// Returns whether the person has asked for the same up to kAsked_s ago. After that they are asked anew.
bool Screen::asked_before(double& last_s) {
  const double now_s = ImGui::GetTime();
  const bool again = now_s - last_s < kAsked_s;
  last_s = again ? -kAsked_s : now_s;
  return again;
}

void Screen::toggle_effects(Trainer& trainer) {
  if (takes_exam(trainer))
    show_note("This exam counts: effects are for practice");
  else if (trainer.session() && aside_ != Aside::effects && !trainer.session()->why_not(ActionKind::effect).empty())
    show_note(trainer.session()->why_not(ActionKind::effect));
  else if (trainer.session())
    toggle(Aside::effects, trainer);
}

void Screen::begin_setup(Trainer& trainer) {
  if (takes_exam(trainer))
    show_note("This exam counts: go on to its end, then the tracker can be set up");
  else if (trainer.loses_by_leaving())
    show_note("Leave these steps first (Escape): the set-up would end them");
  else if ((trainer.loses_sweep() || trainer.setup_leaves()) && !asked_before(asked_to_set_up_s_))
    show_note(trainer.loses_sweep()
                  ? "The set-up may lose the sweep: save it (U, then S), or press F2 once more"
                  : "Nothing here has a sensor to set up. F2 once more leaves the scan for the choice of a tracker");
  else
    trainer.begin_setup();
}

void Screen::switch_holder(Trainer& trainer) {
  Session& session = *trainer.session();
  if (takes_exam(trainer)) return show_note("This exam counts: the probe stays with the tracker");
  if (session.only_learner()) return show_note("Mouse and keyboard move the probe already: there is no tracker");
  if (keeps_steps(trainer)) return;
  trainer.attempt([&] { session.holder() == Holder::learner ? session.give_back_probe() : session.take_probe(); });
}

void Screen::practise(Trainer& trainer) {
  if (keeps_steps(trainer)) return;
  Session& session = *trainer.session();
  // In a recorded scan no hand moves the probe, so practice must take it.
  std::as_const(session).source().recording() ? session.take_probe() : session.practise();
}

/// Asks for a second time before steps that are under way are lost. Returns whether they go on for now.
bool Screen::keeps_steps(const Trainer& trainer) {
  if (!trainer.loses_by_leaving() || asked_before(asked_to_leave_steps_s_)) return false;
  show_note("That ends these steps: once more goes on without them");
  return true;
}

/// A large view hides the panels, so that their buttons lead out of it.
void Screen::toggle(Aside panel, Trainer& trainer) {
  put_aside(aside_ == panel && !large_ ? Aside::none : panel, trainer);
}

void Screen::put_aside(Aside panel, Trainer& trainer) {
  if (aside_ == Aside::look) trainer.keep_look();
  aside_ = panel;
  large_.reset();
}

/// Closes the panel in place of the CT's views. Returns whether one was shown.
bool Screen::close_aside(Trainer& trainer) {
  if (shown_aside(trainer) == Aside::none) return false;
  put_aside(Aside::none, trainer);
  return true;
}

/// Returns which panel takes the place of the CT's views.
Screen::Aside Screen::shown_aside(const Trainer& trainer) const {
  if (aside_ == Aside::effects && !(trainer.session() && trainer.session()->shows_anatomy())) return Aside::none;
  return may_look(trainer) ? aside_ : Aside::none;
}

void Screen::draw_aside(Trainer& trainer) {
  if (aside_place_.w <= 0) return;
  if (shown_aside(trainer) == Aside::effects) {
    if (draw_effects_panel(theme_, aside_place_, *trainer.session(), places_)) toggle_effects(trainer);
    return;
  }
  switch (look_panel_.draw(theme_, aside_place_, trainer.pictures().look, places_)) {
    case LookAnswer::none:
      break;
    case LookAnswer::close:
      toggle_look(trainer);
      break;
    case LookAnswer::save:
      trainer.save_look();
      break;
    case LookAnswer::open:
      ask_for_path(Wanted::look);
      break;
  }
}

void Screen::draw_ct_views(Trainer& trainer, const Guiding* guiding) {
  CtLook look = trainer.preferences().ct;
  for (const View view : {View::slice, View::blend, View::axial, View::coronal, View::sagittal})
    if (const Rect panel = place(view); panel.w > 0)
      if (ct_panel_.draw(theme_, view, panel, trainer.pictures(), look, guiding, places_)) enlarge(view);
  trainer.adjust_ct_look(look);
  if (!ImGui::IsAnyMouseDown()) trainer.keep_ct_look();
}

/// An overlay hides the clock, so it says that the time does not stand still.
void Screen::draw_time_runs_on(const Session& session) {
  const std::string_view text = session.strict() ? "Time runs on: this exam counts"
                                                 : "Time runs on: a tracker is connected, and it does not wait";
  const Rect plate{std::round(screen_.w - text_width(theme_.strong, text)) / 2 - theme_.px(12), theme_.px(6),
                   text_width(theme_.strong, text) + theme_.px(24), theme_.px(30)};
  ImDrawList* list = ImGui::GetForegroundDrawList();
  list->AddRectFilled(plate.min(), plate.max(), colour::kAmber, theme_.px(4));
  list->AddText(theme_.strong, theme_.strong->FontSize, plate.inset(theme_.px(12), theme_.px(6)).min(),
                colour::kBackground, text.data(), text.data() + text.size());
}

/// In the 3D view, above its buttons and axes, so that the ultrasound stays free. If it is hidden, in the view that is
/// large. On a page, over the line of keys at its bottom, so that its buttons stay free.
Rect Screen::toast_place(const Trainer& trainer) const {
  const Rect space = place(View::space);
  if (views_.empty() || overlay(trainer) == Overlay::score)
    return {screen_.x, screen_.y, screen_.w, screen_.h - theme_.px(2)};
  const Rect around = space.h > 0 ? space : views_.begin()->second;
  return {around.x, around.y, around.w, around.h - theme_.px(space.h > 0 ? 76 : 56)};
}

void Screen::show_on_desktop(const std::filesystem::path& path) {
  if (opening_.valid()) return;  // to replace it would wait for it, up to 2 s, and the window would stand still
  opening_ = open_on_desktop(path);
  opened_ = path;
}

/// Says where a file lies that no program of the desktop has shown.
void Screen::note_unopened() {
  using namespace std::chrono_literals;
  if (!opening_.valid() || opening_.wait_for(0s) != std::future_status::ready) return;
  if (!opening_.get())
    show_note(std::string("It could not be opened here. ") + (is_page(opened_) ? "Open it in a browser: " : "It is ") +
              std::filesystem::absolute(opened_).string());
}

/// What was said about one page does not hold for the next.
void Screen::forget_old_toast(const Trainer& trainer) {
  const std::array<const void*, 5> pages{trainer.start_page(), trainer.learners_page(), trainer.check_page(),
                                         trainer.replay(), trainer.session()};
  const auto shown = std::ranges::find_if(pages, [](const void* page) { return page != nullptr; });
  // A score sheet is a page of its own, and so is practice without steps: what was said of the last step does not
  // belong to them.
  const Session* session = trainer.session();
  const std::array state{session && session->result(), session && session->runner()};
  const std::pair page{shown == pages.end() ? nullptr : *shown, state};
  if (std::exchange(toast_page_, page) != page && !toast_.names_file()) toast_.hide();
}

/// A page that the person reads is not covered: the toast waits, unless that page is the swept volume's.
void Screen::draw_toast(const Trainer& trainer) {
  note_unopened();
  const bool reads = top_page() != Overlay::none && top_page() != Overlay::volume;
  if (reads && overlay(trainer) == top_page()) return toast_.wait();
  toast_is_aside_ = place(View::space).w > 0;
  const std::filesystem::path file = toast_.draw(theme_, toast_place(trainer), places_);
  if (!file.empty()) show_on_desktop(is_page(file) ? file : file.parent_path());
}

/// Says that a recorded scan is watched, and offers what to do instead, then what to do next.
void Screen::draw_demonstration(Trainer& trainer) {
  Session& session = *trainer.session();
  const bool over = session.result().has_value();
  fill(strip_, colour::kAccentDark, theme_.px(4));
  Rect line = strip_.inset(theme_.px(16), theme_.px(6));
  const auto next = [&](const char* id, float width, const char* text, ButtonKind kind = ButtonKind::normal) {
    const Rect place = places_[id] = line.take_right(theme_.px(width));
    line.take_right(theme_.px(8));
    return button(theme_, id, place, text, kind);
  };
  const bool leaves = next("leave_demonstration", 110, "Start page");
  const bool own = next("own_try", 140, "Try it yourself", over ? ButtonKind::primary : ButtonKind::normal);
  const bool again = over && next("again", 130, "Watch again");
  draw_text(line, theme_.strong, colour::kText,
            over ? "The demonstration is over: this was a recorded scan, not yours."
                 : "Demonstration: a recorded scan is replayed. Tab takes the probe.");
  if (own) answer_score(trainer, ScoreAnswer::own_try);
  if (again) answer_score(trainer, ScoreAnswer::again);
  if (leaves) trainer.show_start_page();
}

}  // namespace insonate::ui
