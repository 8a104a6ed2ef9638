#pragma once

#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/trainer/options.h"
#include "devices/found_trackers.h"
#include "scenarios/results/database/results_database.h"

namespace insonate {

/// What there is to do, in the order of the start page.
enum class Task { first_scan, demonstration, practice, exam, patients, replay, setup, learners };
inline constexpr std::size_t kTasks = 8;

/// Returns the task's name, as state files have it: "first_scan".
const char* to_string(Task task);

/// One version of a scenario, and the smallest seed that draws it.
struct OfferedVariant {
  std::string name;
  std::uint32_t seed = 0;
};

/// A scenario that can be practised or taken as an exam.
struct OfferedScenario {
  std::filesystem::path file;
  std::string title, briefing;
  std::size_t steps = 0;
  double time_limit_s = 0;
  std::vector<OfferedVariant> variants;  ///< empty if there is one patient only
  std::string digest;
};

/// A patient for free practice.
struct OfferedPatient {
  std::string name, about;
  CaseSource source;
  std::string options{};              ///< of a built-in patient, as patient_words() adds them to its name
  std::filesystem::path listed_in{};  ///< the folder whose cases the page lists; empty for other patients
  bool opened = false;                ///< from a file that the person chose
};

/// A run that can be looked at again.
struct OfferedRun {
  OfferedRun(std::string its_name, std::string its_about) : name(std::move(its_name)), about(std::move(its_about)) {}

  std::string name, about;
  ReplaySource replay;
  std::filesystem::path scenario, expert;  ///< empty if unknown
  std::uint32_t seed = 0;                  ///< draws the scenario's variant
  bool is_skilled = false;                 ///< what other runs are compared with

  /// Returns whether a person has to say which scenario the run is of.
  bool needs_scenario() const { return replay.attempt == 0 && scenario.empty(); }
};

/// The tracker that stands in for one in a rehearsal of the set-up.
inline constexpr const char* kRehearsal = "rehearsal:";
inline bool is_rehearsal(std::string_view uri) {
  return uri.starts_with(kRehearsal);
}

/// A tracker that can be chosen.
struct OfferedTracker {
  std::string uri, name;
  FoundTracker::State state = FoundTracker::State::ready;
  std::string why;  ///< why it cannot be used, or what a learner should know about it
  bool has_sensor = false;
  bool checked = true;  ///< false for one that no search finds, such as one on the network: its state is not known

  bool usable() const { return state == FoundTracker::State::ready; }
};

/// What the person's choice begins: the trainer as if it had been started with `options`.
struct Beginning {
  Options options;
  bool guided = false;         ///< with the guide on
  bool free_practice = false;  ///< without the scenario's steps
};

/// Returns the CT or the case folder of a patient; empty for the built-in one.
std::filesystem::path path_of(const CaseSource& source);

/// Returns the URI of what a person types for a tracker: a computer on the network by its HOST:PORT, or a URI.
std::string tracker_uri_of(std::string_view typed);

/// Returns the options that replay a run, which needs no tracker.
Options as_replay(Options options, const ReplaySource& replay);

/// What the start page offers and what has been chosen on it. It reads files and the database and looks for trackers,
/// and does not know a screen. A file that cannot be read is a problem() and stops nothing else.
class StartPage {
public:
  /// @param options   the command line's, with the learner and the tracker that were chosen before
  /// @param database  results, or nullptr; used in the constructor alone
  StartPage(Options options, ResultsDatabase* database);

  // What is offered
  /// Returns the tasks: that of the learners only if there is a database of results.
  std::vector<Task> tasks() const;
  /// Chooses the task that many places below the chosen one, or above it if negative.
  void move_choice(int places);
  const std::vector<OfferedScenario>& scenarios() const { return scenarios_; }
  const std::vector<OfferedPatient>& patients() const { return patients_; }
  /// Returns the CTs and case folders of those of them that the person opened, in that order.
  std::vector<std::filesystem::path> opened_patients() const;
  /// Offers patients that an earlier page had opened, and chooses the one that was chosen. Leaves out what is gone.
  void offer_again(const std::vector<std::filesystem::path>& opened, const CaseSource& chosen);
  const std::vector<OfferedRun>& runs() const { return runs_; }
  const std::vector<OfferedTracker>& trackers() const { return trackers_; }
  /// Returns the URI of the tracker on the network that was chosen or offered last; empty if there was none.
  const std::string& network_tracker() const { return network_tracker_; }
  void offer_network_tracker(const std::string& uri);
  const std::vector<std::string>& learners() const { return learners_; }
  /// Returns the number of the attempt in which the chosen learner took this exam; 0 if there is none.
  std::int64_t taken_in(const OfferedScenario& exam) const;
  /// Returns the learner's sitting of an exam that was begun and is not handed in; null if there is none.
  const Sitting* begun_in(const OfferedScenario& exam) const;
  /// Returns the attempts of the chosen learner, of all if nobody is chosen, newest first.
  std::vector<AttemptSummary> attempts() const;
  /// Returns the database of results; empty if there is none.
  const std::filesystem::path& database() const { return database_; }
  /// Returns what could not be read, a sentence; empty if nothing.
  const std::string& problem() const { return problem_; }

  /// Takes over the trackers that were found since, and looks again from time to time for trackers and cases.
  void update(double now_s);

  // What is chosen
  Task task = Task::first_scan;
  std::optional<std::size_t> scenario;  ///< of scenarios(), of both practice and exam; empty: free practice
  std::optional<std::size_t> variant;   ///< of the scenario, in practice; empty: by chance
  std::size_t patient = 0, run = 0;
  std::optional<std::size_t> run_scenario;  ///< whose steps a recording is shown with that does not name its scenario
  bool makes_views = false;                 ///< of the patient, if it is a case, instead of practising on it
  bool beside_expert = false;               ///< a replay shows the expert's run too, if there is one
  const std::string& tracker() const { return options_.tracker; }
  const std::string& learner() const { return options_.learner; }
  const std::filesystem::path& calibration() const { return options_.calibration; }

  /// Chooses the scenario of a file that is offered; else the choice stays.
  void choose_scenario(const std::filesystem::path& file);
  /// Throws InputError for a URI that no tracker has.
  void choose_tracker(const std::string& uri);
  /// Chooses a learner; nobody in particular for an empty id. Throws InputError if the id is not valid. Then nothing
  /// that a learner does can begin until one is chosen.
  void choose_learner(const std::string& id);
  bool learner_is_typed = false;  ///< an id is being typed, and not taken yet
  /// Returns the id that was refused last; empty once a learner is chosen.
  const std::string& refused_learner() const { return refused_learner_; }
  /// The set-up's files; empty: what is built in. Throw InputError for a file that cannot be used.
  void choose_calibration(const std::filesystem::path& file) { options_.calibration = file; }
  void choose_landmarks(const std::filesystem::path& file);
  void choose_drawing(const std::filesystem::path& file);
  const std::filesystem::path& landmarks() const { return options_.landmarks; }
  const std::filesystem::path& drawing() const { return options_.drawing; }
  /// Adds a file or folder that a person has chosen for the task, and chooses it. Throws InputError.
  void add(const std::filesystem::path& path);
  /// Takes a patient that could not be loaded from the list, if a person has opened it.
  void withdraw(const CaseSource& patient);
  /// Lists the cases of the person's own folder, in place of the one before; none for an empty path. Cases that come
  /// and go later are listed by update(). Throws InputError if it cannot be listed.
  void list_cases_in(const std::filesystem::path& folder);
  /// Reads the database and the recordings again, or others.
  /// @param out       the folder of recordings
  /// @param database  results, or nullptr; used in the call alone
  void read_again(const std::filesystem::path& out, ResultsDatabase* database);

  /// Returns the skilled scan that the chosen run can be compared with; empty if there is none.
  std::filesystem::path expert() const;
  /// Returns why the task cannot begin, a sentence that says what to do; empty if it can.
  std::string why_not() const;
  /// Returns what the task begins. To be called only if why_not() is empty.
  Beginning chosen() const;
  /// Returns the options that a later start page takes: the command line's, with the learner and the tracker.
  const Options& options() const { return options_; }

private:
  void read_scenarios();
  void take_patient_of(const OfferedRun& chosen, Options& options) const;
  void read_patients();
  void list_cases();
  void read_runs();
  void read_database(ResultsDatabase& database);
  void list_trackers(const std::vector<FoundTracker>& found);
  void offer_tracker(const std::string& uri);
  void offer_patient(const std::filesystem::path& path, Material material);
  void add_scenario(const std::filesystem::path& file);
  const OfferedTracker* chosen_tracker() const;
  std::string why_no_learner() const;
  std::string why_no_tracker() const;
  std::string why_no_exam() const;

  Options options_;
  std::string refused_learner_;
  std::filesystem::path database_;  ///< empty if there is none
  std::vector<OfferedScenario> scenarios_;
  std::vector<OfferedPatient> patients_;
  std::filesystem::path case_folder_;  ///< the person's own; empty if there is none
  std::vector<OfferedRun> runs_;
  std::map<std::string, std::filesystem::path> expert_of_;  ///< a skilled scan, by its scenario's digest
  std::vector<OfferedTracker> trackers_;
  std::string network_tracker_;
  std::vector<std::string> learners_;
  std::vector<AttemptSummary> attempts_;  ///< newest first
  std::vector<Sitting> sittings_;         ///< begun and not handed in
  std::string problem_;
  std::future<std::vector<FoundTracker>> search_;
  double searched_s_ = 0;
};

}  // namespace insonate
