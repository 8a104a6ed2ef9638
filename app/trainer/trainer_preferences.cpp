// What the trainer takes from a person's preferences, and stores of them.

#include <utility>

#include "app/trainer/trainer.h"
#include "sim/view/body/transfer_function_file.h"

namespace insonate {

/// Serves OpenIGTLink clients as the person prefers. An address that cannot be used stops nothing else.
void Trainer::serve() {
  feed_.reset();
  if (preferences_.igtl_server.empty()) return;
  attempt([&] {
    feed_ = std::make_unique<IgtlFeed>(parse_server_address(preferences_.igtl_server, "settings", "igtl_server"));
  });
}

void Trainer::take_look(const std::filesystem::path& file) {
  attempt([&] { pictures_.look.take(view::read_transfer_function(file)); });
}

void Trainer::save_look() {
  attempt([&] {
    const std::filesystem::path file = pictures_.look.save();
    notices_.push_back(notice_of_saved(file));
  });
}

void Trainer::keep_look() {
  attempt([&] { pictures_.look.keep(); });
}

void Trainer::prefer(const Preferences& preferences) {
  const Preferences before = std::exchange(preferences_, preferences);
  if (before == preferences_) return;
  if (preferences_.quality != before.quality) {
    options_.quality = given_.quality = preferences_.quality;
    pictures_.choose(quality_named(preferences_.quality));
  }
  if (preferences_.igtl_server != before.igtl_server) serve();
  if (preferences_.results != before.results && !in_exam() && given_.results.empty()) {  // an exam stays as it began
    const bool opened =
        attempt([&] { use_results(preferences_.results.empty() ? own_results() : preferences_.results); });
    if (!opened) preferences_.results = before.results;
  }
  if (StartPage* page = start_page()) given_ = page->options();
  if (preferences_.out != before.out)
    options_.out = given_.out = preferences_.out.empty() ? Options().out : preferences_.out;
  if (StartPage* page = start_page()) {
    if (preferences_.out != before.out || preferences_.results != before.results)
      page->read_again(options_.out, results_ ? &*results_ : nullptr);
    if (preferences_.cases != before.cases) attempt([&] { page->list_cases_in(preferences_.cases); });
  }
  keep_preferences();
}

/// Puts a CT or case folder last among those that are offered again, and drops the oldest if there are too many.
void Trainer::append_patient(const std::filesystem::path& path) {
  std::vector<std::filesystem::path>& kept = preferences_.patients;
  const std::filesystem::path whole = std::filesystem::absolute(path);
  std::erase(kept, whole);
  if (can_be_kept(whole)) kept.push_back(whole);
  if (kept.size() > Preferences::kMaxPatients) kept.erase(kept.begin(), kept.end() - Preferences::kMaxPatients);
}

/// Stores what the person has opened and typed on the start page, for the next one. What is not there now, such as a CT
/// on a disk that is away, stays.
void Trainer::remember(const StartPage& page) {
  const Preferences before = preferences_;
  const std::vector<std::filesystem::path>& kept = preferences_.patients;
  for (const std::filesystem::path& opened : page.opened_patients())
    if (std::ranges::find(kept, std::filesystem::absolute(opened)) == kept.end()) append_patient(opened);
  const bool is_used = page.task == Task::patients && page.patient < page.patients().size();
  if (is_used && page.patients()[page.patient].opened) append_patient(path_of(page.patients()[page.patient].source));
  if (can_be_kept(page.network_tracker())) preferences_.network_tracker = page.network_tracker();
  if (before != preferences_) keep_preferences();
}

/// Forgets a patient that cannot be used.
void Trainer::forget_patient(const CaseSource& patient) {
  const std::filesystem::path path = path_of(patient);
  if (path.empty()) return;  // the built-in patient
  if (std::erase(preferences_.patients, std::filesystem::absolute(path)) > 0) keep_preferences();
}

void Trainer::toggle_landmarks() {
  Preferences preferences = preferences_;
  preferences.look.landmarks = !preferences.look.landmarks;
  prefer(preferences);
}

bool Trainer::may_name_landmarks() const {
  const Session* shown = session();
  if (!shown) return replay() != nullptr;
  if (!shown->shows_anatomy()) return false;
  const bool scored = shown->runner() && !shown->runner()->live().finished;
  return !scored || guide_.now(*shown).has_value();
}

void Trainer::keep_preferences() {
  kept_ct_look_ = preferences_.ct;
  if (!preferences_file_.empty()) attempt([&] { write_preferences(preferences_file_, preferences_); });
}

void Trainer::keep_ct_look() {
  CtLook kept = preferences_.ct;
  kept.grey = kept_ct_look_.grey;  // which the file does not hold
  if (kept != kept_ct_look_) keep_preferences();
}

void Trainer::open_results() {
  if (options_.replay.any()) return;  // a replay stores nothing
  if (!options_.results.empty())
    use_results(options_.results);
  else if (!options_.headless)
    attempt([&] { use_results(preferences_.results.empty() ? own_results() : preferences_.results); });
}

/// Opens a database in place of the present one, unless it is the same. If it cannot be opened, the present one stays.
void Trainer::use_results(const std::filesystem::path& file) {
  if (results_ && results_->file() == file) return;
  ResultsDatabase opened = ResultsDatabase::open_or_make(file);
  results_.emplace(std::move(opened));
}

}  // namespace insonate
