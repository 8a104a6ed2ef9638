// The trainer's start page: what it prepares in the background, what is begun from it, and the way back to it.

#include <chrono>
#include <thread>
#include <utility>

#include "app/trainer/trainer.h"

namespace insonate {

bool Trainer::can_leave() const {
  if (options_.headless || start_page()) return false;
  const bool taken =
      in_exam() && session() && scan()->begun && session()->runner()->live().started && !session()->result();
  const bool only_this = given_.mode == Mode::exam && std::holds_alternative<Idle>(mode_);
  return !taken && !only_this;
}

bool Trainer::loses_by_leaving() const {
  const Runner* runner = session() ? session()->runner() : nullptr;
  return runner && runner->live().started && !session()->result() && !session()->source().recording();
}

std::string_view Trainer::lost_sweep() const {
  if (!session()) return "";
  if (sweep_.running())
    return "The sweep that runs will be lost. To keep it: stay, then T ends it, and U and S save it.";
  if (sweep_.reconstructing())
    return "The sweep's volume is being made, and will be lost. Stay until it is there, then U and S.";
  return swept_ && !swept_is_saved_ ? "The volume of the last sweep will be lost. To save it: stay, then U and S." : "";
}

void Trainer::leave() {
  if (leads_to_check()) {
    const std::filesystem::path file = *checked_;
    show_start_page();
    return check_scenario(file);
  }
  if (!replay() || !reviewed_) return show_start_page();
  const LearnersChoice choice = *reviewed_;
  show_start_page();
  show_learners(choice);
}

bool Trainer::leads_to_learners() const {
  return replay() && reviewed_;
}

bool Trainer::leads_to_check() const {
  return session() && checked_;
}

void Trainer::show_learners(const LearnersChoice& choice) {
  const StartPage* page = start_page();
  if (!page || page->database().empty()) return;
  remember(*page);
  given_ = options_ = page->options();
  attempt([&] { mode_ = Overseeing{std::make_unique<LearnersPage>(page->database(), choice)}; });
}

void Trainer::check_scenario(const std::filesystem::path& file) {
  if (loading_) return;
  if (const StartPage* page = start_page()) {
    remember(*page);
    given_ = options_ = page->options();
  }
  if (!start_page() && !check_page() && !std::holds_alternative<Idle>(mode_)) return;
  mode_ = Checking{std::make_unique<CheckPage>(file, options_.case_folder)};
}

void Trainer::practise_checked() {
  const CheckPage* page = check_page();
  if (!page || loading_ || page->state() != CheckPage::State::right) return;
  Options options = given_;
  options.mode = Mode::practice;
  options.scenario = page->file();
  options.case_folder = page->case_folder();
  if (options.tracker.empty()) options.tracker = "mouse:";
  const std::filesystem::path file = page->file();
  begin(Beginning{std::move(options), false, false});
  checked_ = file;
}

void Trainer::review() {
  const LearnersPage* page = learners_page();
  if (!page || loading_ || !page->attempt()) return;
  ReplaySource replay;
  replay.database = page->database();
  replay.attempt = page->attempt()->number;
  Beginning chosen{as_replay(given_, replay), false, false};
  chosen.options.results = page->database();
  const LearnersChoice choice = page->choice();
  begin(chosen);
  reviewed_ = choice;
}

void Trainer::report_attempt() {
  attempt([&] {
    const std::filesystem::path report = learners_page()->write_report(options_.out);
    notices_.push_back({"Report written to " + std::filesystem::absolute(report).string(), report});
  });
}

void Trainer::export_tables() {
  attempt([&] {
    const std::filesystem::path tables = learners_page()->export_tables(options_.out);
    notices_.push_back({"Tables written to " + std::filesystem::absolute(tables).string(), tables});
  });
}

void Trainer::show_start_page() {
  if (!can_leave()) return;
  reviewed_.reset();
  checked_.reset();
  write_results_if_due();
  recorder_.stop();
  clip_.stop();
  loading_.reset();
  loaded_replay_.reset();
  if (loaded_case_ && is_bundled_patient(current_.source)) built_in_ = loaded_case_;
  options_ = given_;
  mode_ = Idle();  // which lets go of the tracker
  make_start_page();
  raw_.reset();
  reader_.forget();
  result_files_.reset();
  calibration_warning_.clear();
  setup_left_ = false;
  prepare_built_in();
}

void Trainer::make_start_page() {
  const Task task = start_page() ? start_page()->task : begun_;
  open_results();
  mode_ = Choosing{std::make_unique<StartPage>(given_, results_ ? &*results_ : nullptr)};
  start_page()->task = task;
  start_page()->choose_scenario(begun_scenario_);
  start_page()->offer_again(preferences_.patients, current_.source);
  start_page()->offer_network_tracker(preferences_.network_tracker);
  attempt([&] { start_page()->list_cases_in(preferences_.cases); });
  given_ = start_page()->options();
  options_ = given_;
}

void Trainer::prepare_built_in() {
  if (built_in_ || preparing_) return;
  preparing_ = std::make_shared<Loading>([](const LoadProgress& progress) {
    return std::make_shared<const LoadedCase>(load_case(CaseSource{}, progress));
  });
}

void Trainer::take_over_prepared() {
  if (!preparing_ || !preparing_->done()) return;
  try {
    built_in_ = preparing_->take();
  } catch (const std::exception&) {
    // The person who chooses this patient sees the reason then.
  }
  preparing_.reset();
}

void Trainer::begin_chosen() {
  const StartPage* page = start_page();
  if (!page || loading_ || !page->why_not().empty()) return;
  begun_ = page->task;
  begun_scenario_ = page->scenario ? page->scenarios()[*page->scenario].file : std::filesystem::path();
  if (page->task == Task::learners) return show_learners();
  begin(page->chosen());
}

void Trainer::begin(const Beginning& chosen) {
  const bool possible = attempt([&] { check(chosen.options); });
  if (!possible) return;
  if (const StartPage* page = start_page()) {
    given_ = page->options();
    remember(*page);
  }
  options_ = chosen.options;
  guide_.turn(chosen.guided);
  why_not_calibrated_.clear();
  find_calibration();
  load(request_of(options_, chosen.free_practice));
}

/// After what was chosen has not begun: the page is there again, with the options that it had.
void Trainer::give_up_choice() {
  if (start_page() || learners_page() || check_page()) options_ = given_;
}

/// Takes the built-in patient from what the start page has prepared, or prepares still. Returns false if it is not the
/// one that is wanted.
bool Trainer::load_prepared() {
  if ((!built_in_ && !preparing_) || requested_.replay.any() || !is_bundled_patient(requested_.source)) return false;
  const auto patient = [built_in = built_in_, preparing = preparing_](const LoadProgress& progress) {
    while (!built_in && !preparing->done()) {
      const Loading::Progress sofar = preparing->progress();
      progress(sofar.what, sofar.share);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return built_in ? built_in : preparing->take();
  };
  loading_ = std::make_unique<Loading>(
      [source = requested_.source, refuse = refusals(requested_), patient](const LoadProgress& progress) {
        refuse();
        return with_exam_of(source, patient(progress));
      });
  return true;
}

}  // namespace insonate
