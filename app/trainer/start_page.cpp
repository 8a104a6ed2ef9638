#include "app/trainer/start_page.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "app/trainer/folder_list.h"
#include "devices/calibrated_tracker.h"
#include "devices/calibration/setup_input.h"
#include "devices/registry.h"
#include "scenarios/format/variants.h"
#include "scenarios/results/roster.h"
#include "scenarios/words.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"
#include "sim/volume/case.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

/// How often the page looks for trackers that have been plugged in or out.
constexpr double kSearch_s = 3;
/// More attempts than a person looks through.
constexpr std::size_t kListedAttempts = 50;

constexpr const char* kMouse = "mouse:";

std::vector<fs::path> files_in(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().filename().string().ends_with(ending)) files.push_back(at->path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Returns the case folders in a folder, in the order of their names.
std::vector<fs::path> cases_in(const fs::path& folder) {
  std::vector<fs::path> cases;
  std::error_code error;
  if (folder.empty()) return cases;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code missing;
    if (!at->path().filename().string().starts_with(".") && fs::exists(at->path() / "case.toml", missing))
      cases.push_back(at->path());
  }
  std::sort(cases.begin(), cases.end());
  return cases;
}

/// Returns the name of a case, or its folder's if case.toml cannot be read: opening the case says why.
std::string name_of_case(const fs::path& folder) {
  try {
    return read_case_name(folder);
  } catch (const InputError&) {
    return folder.filename().string();
  }
}

bool is_patient_of(const CaseSource& a, const CaseSource& b) {
  return a.ct == b.ct && a.case_folder == b.case_folder;
}

/// Returns the smallest seed that draws this variant.
std::uint32_t seed_of(std::size_t variant, std::size_t variants) {
  std::uint32_t seed = 0;
  while (selected_variant(seed, variants) != variant) ++seed;
  return seed;
}

bool is_live(const std::string& uri) {
  try {
    const PosesOf poses = kind_of(parse_tracker_uri(uri)).poses;
    return poses != PosesOf::recording;
  } catch (const InputError&) {
    return false;
  }
}

bool has_sensor(const std::string& uri) {
  try {
    check_can_be_calibrated(uri);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string summary_of(const AttemptSummary& attempt) {
  char score[48];
  std::snprintf(score, sizeof score, "%s %%, %s", fixed(attempt.percent, 1).c_str(),
                attempt.passed ? "passed" : "not passed");
  return attempt.learner + ", " + score + ", " + (attempt.mode ? name_of(attempt.mode) + ", " : "") +
         time_text(attempt.finished_ms / 1000);
}

}  // namespace

const char* to_string(Task task) {
  switch (task) {
    case Task::first_scan:
      return "first_scan";
    case Task::demonstration:
      return "demonstration";
    case Task::practice:
      return "practice";
    case Task::exam:
      return "exam";
    case Task::patients:
      return "patients";
    case Task::replay:
      return "replay";
    case Task::setup:
      return "setup";
    case Task::learners:
      return "learners";
  }
  return "";
}

StartPage::StartPage(Options options, ResultsDatabase* database) : options_(std::move(options)) {
  options_.mode = Mode::practice;
  options_.case_folder.clear();
  options_.ct.clear();
  options_.scenario.clear();
  options_.seed.reset();
  options_.replay = {};
  if (options_.tracker.empty() || !is_live(options_.tracker)) {
    options_.tracker = kMouse;
    options_.calibration.clear();
    options_.record_raw.clear();
  }
  read_scenarios();
  read_patients();
  read_again(options_.out, database);
  list_trackers({});
}

void StartPage::read_again(const fs::path& out, ResultsDatabase* database) {
  options_.out = out;
  database_.clear();
  attempts_.clear();
  sittings_.clear();
  learners_.clear();
  runs_.clear();
  expert_of_.clear();
  run = 0;
  if (database) {
    database_ = database->file();
    try {
      read_database(*database);
    } catch (const std::exception& error) {
      problem_ = error.what();
    }
  }
  read_runs();
  if (database_.empty() && task == Task::learners) task = Task::first_scan;
}

std::vector<Task> StartPage::tasks() const {
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < kTasks; ++i)
    if (Task(i) != Task::learners || !database_.empty()) tasks.push_back(Task(i));
  return tasks;
}

void StartPage::move_choice(int places) {
  const std::vector<Task> offered = tasks();
  const auto chosen = std::find(offered.begin(), offered.end(), task) - offered.begin();
  task = offered[std::size_t(std::clamp(chosen + places, std::ptrdiff_t(0), std::ptrdiff_t(offered.size()) - 1))];
}

void StartPage::add_scenario(const fs::path& file) {
  const Scenario first = read_scenario(file);
  OfferedScenario offered{file, first.title, first.briefing, first.steps.size(), first.time_limit_s, {}, first.digest};
  for (std::size_t i = 0; i < first.variants; ++i) {
    const std::uint32_t seed = seed_of(i, first.variants);
    offered.variants.push_back({read_scenario(file, seed).variant, seed});
  }
  scenarios_.push_back(std::move(offered));
}

void StartPage::read_scenarios() {
  for (const fs::path& file : files_in(assets_folder() / "scenarios", ".toml")) {
    try {
      add_scenario(file);
    } catch (const InputError& error) {
      problem_ = error.what();
    }
  }
  std::stable_sort(scenarios_.begin(), scenarios_.end(),
                   [](const OfferedScenario& a, const OfferedScenario& b) { return a.time_limit_s < b.time_limit_s; });
  if (!scenarios_.empty()) scenario = 0;
}

void StartPage::read_patients() {
  using PhantomOptions = std::vector<std::pair<std::string, std::string>>;
  std::map<PhantomOptions, OfferedPatient> found;
  for (const OfferedScenario& offered : scenarios_) {
    std::vector<OfferedVariant> variants = offered.variants;
    if (variants.empty()) variants.emplace_back();
    for (const OfferedVariant& drawn_by : variants) {
      const Scenario drawn = read_scenario(offered.file, drawn_by.seed);
      OfferedPatient made{"", "Built-in patient", CaseSource{}, patient_words("", drawn), fs::path()};
      std::string finding = drawn.variant;
      for (const auto& [option, value] : drawn.phantom_options)
        if (finding.empty()) finding = in_words(option);
      made.name = drawn.phantom_options.empty() ? "Nothing abnormal" : offered.title + ": " + finding;
      made.source.scenario = offered.file;
      made.source.seed = drawn_by.seed;
      found.emplace(drawn.phantom_options, std::move(made));
    }
  }
  for (auto& [phantom, offered] : found) patients_.push_back(std::move(offered));
  list_cases();
}

void StartPage::list_cases_in(const fs::path& folder) {
  std::error_code error;
  case_folder_ = folder == fs::current_path(error) ? fs::path() : folder;
  list_cases();
  if (case_folder_.empty()) return;
  if (const FolderList list = list_folder(folder, Wanted::patient); !list.problem.empty())
    throw InputError(folder.string(), "", "its cases cannot be listed", "choose another folder in the settings");
}

/// Lists the cases that are there now. The chosen patient stays chosen if it is still there.
void StartPage::list_cases() {
  std::error_code error;
  std::vector<OfferedPatient> cases;
  for (const fs::path& folder : {fs::current_path(error), case_folder_})
    for (const fs::path& found : cases_in(folder)) {
      OfferedPatient offered{"", "Case " + found.filename().string() + " in " + folder.string(), CaseSource{}, "",
                             folder};
      offered.source.case_folder = found;
      cases.push_back(std::move(offered));
    }
  const auto listed = [](const OfferedPatient& offered) { return !offered.listed_in.empty(); };
  const auto same = [](const OfferedPatient& a, const OfferedPatient& b) {
    return is_patient_of(a.source, b.source) && a.listed_in == b.listed_in;
  };
  std::vector<OfferedPatient> before;
  std::copy_if(patients_.begin(), patients_.end(), std::back_inserter(before), listed);
  if (std::equal(before.begin(), before.end(), cases.begin(), cases.end(), same)) return;
  for (OfferedPatient& offered : cases) offered.name = name_of_case(offered.source.case_folder);
  const std::optional<OfferedPatient> chosen =
      patient < patients_.size() ? std::optional(patients_[patient]) : std::nullopt;
  std::erase_if(patients_, listed);
  patients_.insert(patients_.end(), cases.begin(), cases.end());
  const auto found = std::ranges::find_if(patients_, [&](const OfferedPatient& offered) {
    return chosen && same(offered, *chosen) && offered.name == chosen->name;
  });
  patient = found == patients_.end() ? 0 : std::size_t(found - patients_.begin());
}

void StartPage::read_database(ResultsDatabase& database) {
  attempts_ = database.attempts();
  std::reverse(attempts_.begin(), attempts_.end());
  sittings_ = database.sittings();
  std::set<std::string> known;
  for (const LearnerSummary& learner : database.learners())
    if (learner.id != kNobodyInParticular) known.insert(learner.id);
  for (const char* name : {"learners.csv", "learners.toml"}) {
    std::error_code error;
    const fs::path roster = database_.parent_path() / name;
    if (!fs::exists(roster, error)) continue;
    for (std::string& id : read_roster(roster)) known.insert(std::move(id));
  }
  learners_.assign(known.begin(), known.end());
}

void StartPage::read_runs() {
  std::vector<OfferedRun> bundled;
  for (const fs::path& log : files_in(assets_folder() / "logs", ".igs.mha")) {
    const std::string name = log.filename().string();
    const fs::path plan = log.parent_path() / (name.substr(0, name.find('.')) + ".toml");
    try {
      const TomlDocument document(plan.string(), read_file(plan));
      const fs::path file = fs::weakly_canonical(plan.parent_path() / document.root().text("scenario"));
      const auto of = std::find_if(scenarios_.begin(), scenarios_.end(), [&](const OfferedScenario& offered) {
        std::error_code error;
        return fs::equivalent(offered.file, file, error);
      });
      if (of == scenarios_.end()) continue;
      const bool good = name.find("_good.") != std::string::npos;
      OfferedRun offered_run(of->title, good ? "Recorded scan of a skilled hand" : "Recorded scan of a beginner");
      offered_run.scenario = of->file;
      offered_run.seed = std::uint32_t(document.root().whole_number("scenario_seed", 0, 0xffffffff, 0));
      offered_run.replay.log = log;
      offered_run.is_skilled = good;
      if (good) expert_of_[of->digest] = log;
      bundled.push_back(std::move(offered_run));
    } catch (const std::exception& error) {
      problem_ = error.what();
    }
  }
  std::vector<std::pair<std::int64_t, OfferedRun>> own;  // with the time since 1970, s
  for (std::size_t i = 0; i < std::min(attempts_.size(), kListedAttempts); ++i) {
    const AttemptSummary& attempt = attempts_[i];
    OfferedRun offered_run(attempt.title, summary_of(attempt));
    offered_run.replay.database = database_;
    offered_run.replay.attempt = attempt.number;
    if (const auto skilled = expert_of_.find(attempt.scenario_digest); skilled != expert_of_.end())
      offered_run.expert = skilled->second;
    own.emplace_back(attempt.finished_ms / 1000, std::move(offered_run));
  }
  for (const fs::path& log : files_in(options_.out, ".igs.mha")) {
    if (log.filename().string().ends_with("-images.igs.mha")) continue;  // beside a recording of the same run
    OfferedRun offered_run(log.filename().string(),
                           time_text(changed_s(log)) + ", recording in " + options_.out.string());
    offered_run.replay.log = log;
    own.emplace_back(changed_s(log), std::move(offered_run));
  }
  std::ranges::stable_sort(own, std::ranges::greater(), [](const auto& each) { return each.first; });
  for (auto& [time_s, offered_run] : own) runs_.push_back(std::move(offered_run));
  for (OfferedRun& offered_run : bundled) {
    for (const OfferedScenario& offered : scenarios_)
      if (offered.file == offered_run.scenario && expert_of_[offered.digest] != offered_run.replay.log)
        offered_run.expert = expert_of_[offered.digest];
    runs_.push_back(std::move(offered_run));
  }
}

std::vector<AttemptSummary> StartPage::attempts() const {
  if (learner() == kNobodyInParticular) return attempts_;
  std::vector<AttemptSummary> own;
  for (const AttemptSummary& attempt : attempts_)
    if (attempt.learner == learner()) own.push_back(attempt);
  return own;
}

void StartPage::update(double now_s) {
  using namespace std::chrono_literals;
  if (search_.valid() && search_.wait_for(0s) == std::future_status::ready) list_trackers(search_.get());
  if (search_.valid() || (searched_s_ > 0 && now_s - searched_s_ < kSearch_s)) return;
  searched_s_ = now_s;
  list_cases();
  search_ = std::async(std::launch::async, [] { return find_trackers(); });
}

void StartPage::list_trackers(const std::vector<FoundTracker>& found) {
  const bool rehearsed = std::ranges::any_of(trackers_, is_rehearsal, &OfferedTracker::uri);
  trackers_ = {{kMouse, "Mouse and keyboard", FoundTracker::State::ready, "", false}};
  for (const FoundTracker& tracker : found)
    trackers_.push_back(
        {tracker.uri(), tracker.name, tracker.state, tracker.why, tracker.kind->poses == PosesOf::sensor});
  // The command line's, and one on the network, are not found on a bus.
  offer_tracker(network_tracker_);
  offer_tracker(tracker());
  if (rehearsed) offer_tracker(kRehearsal);  // stays, after another one was chosen
}

/// Lists a tracker that no search has found.
void StartPage::offer_tracker(const std::string& uri) {
  const auto same = [&](const OfferedTracker& offered) { return offered.uri == uri; };
  if (uri.empty() || std::ranges::any_of(trackers_, same)) return;
  if (is_rehearsal(uri))
    trackers_.push_back({uri, "Made-up hand, a rehearsal", FoundTracker::State::ready, "", true});
  else
    trackers_.push_back({uri, uri, FoundTracker::State::ready, "", has_sensor(uri), false});
}

void StartPage::offer_network_tracker(const std::string& uri) {
  network_tracker_ = uri;
  offer_tracker(uri);
}

fs::path path_of(const CaseSource& source) {
  return source.ct.empty() ? source.case_folder : source.ct;
}

std::string tracker_uri_of(std::string_view typed) {
  const std::size_t colon = typed.find(':');
  const auto is_of = [&](const TrackerKind& kind) { return typed.substr(0, colon) == kind.scheme; };
  // A computer can have the name of a scheme.
  const bool is_port = colon + 1 < typed.size() && typed.find_first_not_of("0123456789", colon + 1) == typed.npos;
  const bool is_uri = colon != typed.npos && !is_port && std::ranges::any_of(tracker_kinds(), is_of);
  return (is_uri ? "" : "igtl://") + std::string(typed);
}

void StartPage::choose_tracker(const std::string& uri) {
  if (uri == tracker()) return;
  open_unless_device(uri);
  options_.tracker = uri;
  options_.calibration.clear();
  options_.record_raw.clear();
  if (uri.starts_with("igtl:")) network_tracker_ = uri;
  offer_tracker(uri);
}

void StartPage::choose_learner(const std::string& id) {
  refused_learner_ = id;
  if (!id.empty()) check_learner_id(id, "learner", "");
  options_.learner = id.empty() ? kNobodyInParticular : id;
  refused_learner_.clear();
}

void StartPage::choose_landmarks(const fs::path& file) {
  if (!file.empty()) read_landmark_list(file);
  options_.landmarks = file;
}

void StartPage::choose_drawing(const fs::path& file) {
  if (!file.empty()) read_probe_drawing(file);
  options_.drawing = file;
}

void StartPage::withdraw(const CaseSource& source) {
  const auto found = std::ranges::find_if(patients_, [&](const OfferedPatient& offered) {
    return offered.opened && is_patient_of(offered.source, source);
  });
  if (found == patients_.end()) return;
  patients_.erase(found);
  patient = 0;
}

std::vector<fs::path> StartPage::opened_patients() const {
  std::vector<fs::path> opened;
  for (const OfferedPatient& offered : patients_)
    if (offered.opened) opened.push_back(path_of(offered.source));
  return opened;
}

void StartPage::offer_again(const std::vector<fs::path>& opened, const CaseSource& chosen) {
  for (const fs::path& path : opened) {
    try {
      const Material material = kind_of_material(path);
      if (material == Material::ct || material == Material::case_folder) offer_patient(path, material);
    } catch (const InputError&) {  // on a disk that is not there now, for example
    }
  }
  const auto same = [&](const OfferedPatient& offered) {
    return offered.opened && is_patient_of(offered.source, chosen);
  };
  const auto found = std::ranges::find_if(patients_, same);
  patient = found == patients_.end() ? 0 : std::size_t(found - patients_.begin());
}

/// Lists a CT or a case folder among the patients, unless it is there, and chooses it.
void StartPage::offer_patient(const fs::path& path, Material material) {
  const bool is_ct = material == Material::ct;
  const std::string name = path.filename().string();
  OfferedPatient offered{is_ct ? name : name_of_case(path), is_ct ? "CT" : "Case " + name, CaseSource{}, "",
                         fs::path()};
  (is_ct ? offered.source.ct : offered.source.case_folder) = path;
  offered.about += " in " + path.parent_path().string();
  offered.opened = true;
  const auto there = std::ranges::find_if(patients_, [&](const OfferedPatient& other) {
    return other.opened && is_patient_of(other.source, offered.source);
  });
  patient = std::size_t(there - patients_.begin());
  if (there == patients_.end()) patients_.push_back(std::move(offered));
}

void StartPage::add(const fs::path& path) {
  if (task == Task::setup) return choose_calibration(path);
  const Material material = kind_of_material(path);
  const std::string name = path.filename().string();
  switch (material) {
    case Material::scenario:
      add_scenario(path);
      scenario = scenarios_.size() - 1;
      variant.reset();
      if (task != Task::exam) task = Task::practice;
      return;
    case Material::case_folder:
    case Material::ct:
      task = Task::patients;
      return offer_patient(path, material);
    case Material::raw_log:
      return choose_tracker("raw:" + path.string());
    case Material::tracker_log: {
      OfferedRun offered(name, time_text(changed_s(path)) + ", recording in " + path.parent_path().string());
      offered.replay.log = path;
      runs_.push_back(std::move(offered));
      run = runs_.size() - 1;
      task = Task::replay;
      return;
    }
  }
}

}  // namespace insonate
