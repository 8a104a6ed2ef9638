#include "app/panels/pages/open_on_desktop.h"
#include "app/panels/pages/settings_page.h"
#include "app/panels/screen.h"
#include "scenarios/results/learner_id.h"

// The pages and sheets over the screen: which one is shown, and what its answers do.
namespace insonate::ui {
namespace {

/// Returns the preference that a dialog asks for; nullptr if it asks for something to open.
std::filesystem::path* setting_of(Preferences& preferences, Wanted wanted) {
  switch (wanted) {
    case Wanted::output:
      return &preferences.out;
    case Wanted::cases:
      return &preferences.cases;
    case Wanted::results:
      return &preferences.results;
    default:
      return nullptr;
  }
}

/// Takes a file of the set-up, or what is built in for an empty path. Returns whether `wanted` is one. Throws
/// InputError.
bool use_for_setup(StartPage& page, Wanted wanted, const std::filesystem::path& path) {
  switch (wanted) {
    case Wanted::calibration:
      page.choose_calibration(path);
      return true;
    case Wanted::landmarks:
      page.choose_landmarks(path);
      return true;
    case Wanted::drawing:
      page.choose_drawing(path);
      return true;
    default:
      return false;
  }
}

}  // namespace

const char* to_string(Overlay overlay) {
  switch (overlay) {
    case Overlay::none:
      return "";
    case Overlay::problem:
      return "problem";
    case Overlay::loading:
      return "loading";
    case Overlay::setup:
      return "setup";
    case Overlay::help:
      return "help";
    case Overlay::about:
      return "about";
    case Overlay::settings:
      return "settings";
    case Overlay::open:
      return "open";
    case Overlay::leave:
      return "leave";
    case Overlay::volume:
      return "volume";
    case Overlay::briefing:
      return "briefing";
    case Overlay::score:
      return "score";
  }
  return "";
}

/// Gives what the dialog has found to the start page, or opens it.
void Screen::take_path(Trainer& trainer) {
  const std::filesystem::path path = open_dialog_.path();
  StartPage* const page = trainer.start_page();
  const Wanted wanted = open_dialog_.wanted();
  if (Preferences preferences = trainer.preferences(); std::filesystem::path* set = setting_of(preferences, wanted)) {
    *set = path;
    return trainer.prefer(preferences);
  }
  if (wanted == Wanted::look) return trainer.take_look(path);
  if (wanted == Wanted::checked) return trainer.check_scenario(path);
  if (!page || wanted == Wanted::anything) return open(path, trainer);
  trainer.attempt([&] {
    if (!use_for_setup(*page, wanted, path)) page->add(path);
  });
}

Overlay Screen::overlay(const Trainer& trainer) const {
  if (!trainer.problems().empty()) return Overlay::problem;
  if (trainer.loading()) return Overlay::loading;
  if (top_page() != Overlay::none) return top_page();
  if (trainer.setup()) return Overlay::setup;
  if (trainer.briefing()) return Overlay::briefing;
  return shows_sheet(trainer) ? Overlay::score : Overlay::none;
}

/// Returns the result that has a score sheet; nullptr if there is none.
const ExamResult* Screen::sheet(const Trainer& trainer) {
  const Session* session = trainer.session();
  return session && session->result() && !trainer.demonstration() ? &*session->result() : nullptr;
}

std::string Screen::learner_of(const Trainer& trainer) {
  const std::string& learner = trainer.options().learner;
  const bool watched = trainer.session() && trainer.session()->source().recording();
  return watched || learner == kNobodyInParticular ? std::string() : learner;
}

bool Screen::shows_sheet(const Trainer& trainer) const {
  return sheet(trainer) && sheet(trainer) != closed_sheet_of_;
}

void Screen::toggle_sheet(const Trainer& trainer) {
  const ExamResult* result = sheet(trainer);
  if (!result) return show_note("The score sheet comes at the end of scored steps");
  closed_sheet_of_ = shows_sheet(trainer) ? result : nullptr;
}

void Screen::dismiss(Trainer& trainer) {
  switch (overlay(trainer)) {
    case Overlay::none:
      if (trainer.learners_page() && learners_panel_.types_text()) return learners_panel_.close_fields(false);
      if (trainer.start_page()) start_panel_.close_fields(false);
      if (trainer.start_page() || text_field_.is_open()) break;
      if (trainer.session() && trainer.picture_tools().cancel()) break;
      if (trainer.session() && !trainer.author() && trainer.step_controls().asks_again())
        trainer.step_controls().stay();
      else if (!ct_panel_.close_menu() && !close_aside(trainer) && !std::exchange(large_, std::nullopt))
        leave(trainer);
      break;
    case Overlay::problem:
      trainer.problems().pop_front();
      break;
    case Overlay::loading:
      trainer.stop_loading();
      break;
    case Overlay::setup:
      break;
    case Overlay::briefing:
      trainer.leave_briefing();
      break;
    case Overlay::help:
    case Overlay::about:
    case Overlay::settings:
    case Overlay::open:
    case Overlay::leave:
    case Overlay::volume:
      close_page();
      break;
    case Overlay::score:
      closed_sheet_of_ = &*trainer.session()->result();
      break;
  }
  text_field_.close();
}

void Screen::confirm(Trainer& trainer) {
  switch (overlay(trainer)) {
    case Overlay::none:
      if (trainer.learners_page())
        return learners_panel_.types_text() ? learners_panel_.close_fields(true) : trainer.review();
      if (trainer.check_page()) return trainer.practise_checked();
      if (!trainer.start_page()) return step_on(trainer);
      if (start_panel_.types_text()) return start_panel_.close_fields(true);
      return trainer.begin_chosen();
    case Overlay::leave:
      pages_.clear();
      return leaving_.go_on(trainer);
    case Overlay::problem:
    case Overlay::help:
    case Overlay::about:
    case Overlay::settings:
    case Overlay::volume:
      return dismiss(trainer);
    case Overlay::open:
      return open_dialog_.confirm();
    case Overlay::briefing:
      return trainer.start();
    case Overlay::loading:
    case Overlay::setup:
    case Overlay::score:
      return;
  }
}

void Screen::go_on(Trainer& trainer) {
  const Overlay shown = overlay(trainer);
  switch (shown) {
    case Overlay::problem:
    case Overlay::help:
    case Overlay::about:
    case Overlay::settings:
    case Overlay::open:
    case Overlay::leave:
    case Overlay::volume:
      return dismiss(trainer);
    case Overlay::loading:
    case Overlay::setup:
      return;
    case Overlay::briefing:
      return trainer.start();
    case Overlay::none:
      step_on(trainer);
      break;
    case Overlay::score:
      break;
  }
  if (trainer.session() && trainer.session()->result()) answer_score(trainer, ScoreAnswer::again);
}

/// Goes on with the exam, or stores the view that is being authored. If text is still missing, opens its field first.
void Screen::step_on(Trainer& trainer) {
  if (!trainer.session()) return;
  if (const Author* author = trainer.author()) {
    if (author->parts().empty()) return;
    if (author->title().empty()) return text_field_.open();
    text_field_.close();
    return trainer.keep_view();
  }
  StepControls& controls = trainer.step_controls();
  const AnswerInput* question = controls.question();
  if (question && question->is_typed() && !controls.can_answer()) return text_field_.open();
  text_field_.close();
  controls.go_on(*trainer.session());
}

void Screen::toggle_volume(const Trainer& trainer) {
  if (takes_exam(trainer)) return show_note("This exam counts: there are no sweeps in it");
  if (!trainer.swept() && trainer.sweep().reconstructing())
    return show_note("The swept volume is being made, and is shown with U when it is");
  if (!trainer.swept()) return show_note("Sweep a volume first: T begins a sweep and ends it");
  toast_.hide();  // it says that the volume can be shown
  toggle(Overlay::volume);
}

void Screen::toggle(Overlay page) {
  page == top_page() ? close_page() : show_page(page);
}

/// Shows a page over the ones that are open; it is never open twice.
void Screen::show_page(Overlay page) {
  std::erase(pages_, page);
  pages_.push_back(page);
}

void Screen::ask_for_path(Wanted wanted) {
  open_dialog_.open(wanted);
  show_page(Overlay::open);
}

void Screen::leave(Trainer& trainer) {
  if (!trainer.can_leave()) {
    if (trainer.session() && trainer.session()->strict())
      show_note("This exam counts: go on to its end, then it can be left");
    return;
  }
  ask_to_leave(trainer, false, [](Trainer& left) { left.leave(); });
}

void Screen::open(const std::filesystem::path& path, Trainer& trainer) {
  // What cannot be opened is refused without a question.
  if (!trainer.attempt([&] { kind_of_material(path); })) return;
  if (takes_exam(trainer)) return trainer.open(path);
  ask_to_leave(trainer, false, [path](Trainer& left) { left.open(path); });
}

void Screen::quit(Trainer& trainer) {
  const bool hands_in = takes_exam(trainer) && !trainer.can_leave();
  if (hands_in && !asked_before(asked_to_quit_s_))
    return show_note("This exam counts: quit once more now to end it here and hand it in");
  const bool asked = std::ranges::find(pages_, Overlay::leave) != pages_.end() && leaving_.ends;
  if (hands_in || asked)
    quits_ = true;
  else
    ask_to_leave(trainer, true, [this](Trainer&) { quits_ = true; });
}

/// Goes on as the person has chosen; asks first if something is lost by it.
void Screen::ask_to_leave(Trainer& trainer, bool ends, const std::function<void(Trainer&)>& go_on) {
  if (!trainer.loses_by_leaving() && !trainer.loses_sweep()) return go_on(trainer);
  leaving_ = {ends, go_on};
  show_page(Overlay::leave);
}

void Screen::close_page() {
  if (!pages_.empty()) pages_.pop_back();
  open_dialog_.close();
}

/// What the help is about: the page that it lies on.
HelpTopic Screen::help_topic(const Trainer& trainer) const {
  const Overlay below = pages_.size() > 1 ? pages_[pages_.size() - 2] : Overlay::none;
  if (below == Overlay::settings) return HelpTopic::settings;
  if (below == Overlay::open) return HelpTopic::open;
  if (trainer.start_page()) return HelpTopic::start;
  if (trainer.learners_page()) return HelpTopic::learners;
  if (trainer.check_page()) return HelpTopic::check;
  if (trainer.setup()) return HelpTopic::setup;
  if (trainer.replay()) return HelpTopic::replay;
  if (trainer.author()) return HelpTopic::author;
  if (shows_sheet(trainer)) return HelpTopic::score;
  if (below == Overlay::volume) return HelpTopic::volume;
  return takes_exam(trainer) ? HelpTopic::exam : HelpTopic::scan;
}

void Screen::draw_setup(Trainer& trainer) {
  const glm::dvec3 belly = trainer.loaded_case() ? trainer.loaded_case()->surroundings.start.translation
                                                 : trainer.pictures().grid().centre();
  if (draw_setup_page(theme_, screen_, *trainer.setup(), trainer.next_start(), belly, trainer.pictures(), places_))
    trainer.end_setup();
}

void Screen::draw_overlay(Trainer& trainer) {
  Session* session = trainer.session();
  if (session && !session->result()) closed_sheet_of_ = nullptr;
  const Overlay shown = overlay(trainer);
  // A page over the set-up leaves it to be seen.
  if (trainer.setup() && shown != Overlay::setup && shown == top_page()) draw_setup(trainer);
  switch (shown) {
    case Overlay::none:
      break;
    case Overlay::problem:
      if (draw_problem(theme_, screen_, trainer.problems().front(), trainer.exam_refused()))
        trainer.problems().pop_front();
      break;
    case Overlay::loading:
      if (draw_loading(theme_, screen_, trainer.loading()->progress(), trainer.can_stop_loading(), places_))
        trainer.stop_loading();
      break;
    case Overlay::setup:
      draw_setup(trainer);
      break;
    case Overlay::help: {
      const HelpAnswer answer = draw_help(theme_, screen_, help_topic(trainer), places_);
      if (answer != HelpAnswer::none) close_page();
      if (answer == HelpAnswer::about) show_page(Overlay::about);
      if (answer == HelpAnswer::settings) show_page(Overlay::settings);
      break;
    }
    case Overlay::about:
      if (draw_about(theme_, screen_, device_)) close_page();
      break;
    case Overlay::settings: {
      const SettingsAnswer answer =
          draw_settings(theme_, screen_, trainer.preferences(), trainer.options(), trainer.preferences_file(), places_);
      if (answer.wanted) trainer.prefer(*answer.wanted);
      if (answer.browse) ask_for_path(*answer.browse);
      if (answer.close) close_page();
      break;
    }
    case Overlay::open: {
      const OpenDialog::Answer answer = open_dialog_.draw(theme_, screen_, places_);
      if (answer != OpenDialog::Answer::none) close_page();
      if (answer == OpenDialog::Answer::chosen) take_path(trainer);
      break;
    }
    case Overlay::leave:
      if (const std::optional<bool> leaves =
              draw_leave(theme_, screen_, leaving_.ends, trainer.loses_by_leaving(), trainer.lost_sweep(), places_)) {
        pages_.pop_back();
        if (*leaves) leaving_.go_on(trainer);
      }
      break;
    case Overlay::volume:
      if (!trainer.swept()) {
        close_page();
        break;
      }
      switch (volume_page_.draw(theme_, screen_, trainer.swept(), trainer.pictures(), places_)) {
        case VolumeAnswer::none:
          break;
        case VolumeAnswer::close:
          close_page();
          break;
        case VolumeAnswer::save:
          trainer.save_swept();
          break;
      }
      break;
    case Overlay::briefing:
      switch (draw_briefing(theme_, screen_, *trainer.briefing(), trainer.session()->strict(), learner_of(trainer),
                            places_)) {
        case BriefingAnswer::none:
          break;
        case BriefingAnswer::start:
          trainer.start();
          break;
        case BriefingAnswer::leave:
          trainer.leave_briefing();
          break;
      }
      break;
    case Overlay::score: {
      const Session& scored = *trainer.session();
      const bool watched = scored.source().recording() != nullptr;
      answer_score(trainer,
                   draw_score_sheet(theme_, screen_, *scored.result(), trainer.result_files(), trainer.results_due(),
                                    watched, scored.strict(), learner_of(trainer), places_));
      break;
    }
  }
}

void Screen::answer_score(Trainer& trainer, ScoreAnswer answer) {
  Session& session = *trainer.session();
  switch (answer) {
    case ScoreAnswer::again:
      trainer.attempt([&] { session.start_over(); });
      break;
    case ScoreAnswer::own_try:
      trainer.attempt([&] {
        session.take_probe();
        session.start_over();
      });
      break;
    case ScoreAnswer::practice:
      trainer.attempt([&] { session.practise(); });
      break;
    case ScoreAnswer::open_report:
      show_on_desktop(trainer.result_files()->report);
      break;
    case ScoreAnswer::leave:
      trainer.show_start_page();
      break;
    case ScoreAnswer::close:
      closed_sheet_of_ = &*session.result();
      break;
    case ScoreAnswer::none:
      break;
  }
}

void Screen::draw_start_page(Trainer& trainer) {
  if (aside_ != Aside::none) put_aside(Aside::none, trainer);
  const auto attempt = [&](const std::function<void()>& action) { trainer.attempt(action); };
  const StartAnswer answer = start_panel_.draw(theme_, screen_, *trainer.start_page(), attempt, places_);
  switch (answer.kind) {
    case StartAnswer::Kind::none:
      break;
    case StartAnswer::Kind::begin:
      trainer.begin_chosen();
      break;
    case StartAnswer::Kind::help:
      show_page(Overlay::help);
      break;
    case StartAnswer::Kind::settings:
      show_page(Overlay::settings);
      break;
    case StartAnswer::Kind::about:
      show_page(Overlay::about);
      break;
    case StartAnswer::Kind::browse:
      ask_for_path(answer.wanted);
      break;
    case StartAnswer::Kind::reset:
      use_for_setup(*trainer.start_page(), answer.wanted, {});
      break;
  }
}

void Screen::draw_learners_page(Trainer& trainer) {
  const auto run = [&](const std::function<void()>& action) { trainer.attempt(action); };
  switch (learners_panel_.draw(theme_, screen_, *trainer.learners_page(), run, places_)) {
    case LearnersAnswer::none:
      break;
    case LearnersAnswer::leave:
      leave(trainer);
      break;
    case LearnersAnswer::help:
      show_page(Overlay::help);
      break;
    case LearnersAnswer::review:
      trainer.review();
      break;
    case LearnersAnswer::report:
      trainer.report_attempt();
      break;
    case LearnersAnswer::tables:
      trainer.export_tables();
      break;
  }
}

void Screen::draw_check_page(Trainer& trainer) {
  switch (check_panel_.draw(theme_, screen_, *trainer.check_page(), places_)) {
    case CheckAnswer::none:
      break;
    case CheckAnswer::leave:
      leave(trainer);
      break;
    case CheckAnswer::help:
      show_page(Overlay::help);
      break;
    case CheckAnswer::open:
      ask_for_path(Wanted::checked);
      break;
    case CheckAnswer::practise:
      trainer.practise_checked();
      break;
  }
}

}  // namespace insonate::ui
