// What a choice on the start page turns into, and why it cannot begin.

#include <algorithm>
#include <random>

#include "app/trainer/start_page.h"
#include "sim/core/text.h"
#include "sim/files/files.h"

namespace insonate {

const OfferedTracker* StartPage::chosen_tracker() const {
  const auto chosen = std::find_if(trackers_.begin(), trackers_.end(),
                                   [&](const OfferedTracker& offered) { return offered.uri == tracker(); });
  return chosen == trackers_.end() ? nullptr : &*chosen;
}

std::string StartPage::why_no_tracker() const {
  const OfferedTracker* chosen = chosen_tracker();
  return chosen && !chosen->usable() ? chosen->why : "";
}

std::string StartPage::why_no_learner() const {
  if (refused_learner_.empty()) return "";
  return "Correct on the right who is learning: " + why_no_learner_id(refused_learner_) + ".";
}

std::int64_t StartPage::taken_in(const OfferedScenario& exam) const {
  if (learner() == kNobodyInParticular) return 0;
  for (const AttemptSummary& attempt : attempts_)
    if (attempt.learner == learner() && attempt.scenario_digest == exam.digest &&
        is_of(attempt.mode, AttemptMode::exam))
      return attempt.number;
  return 0;
}

void StartPage::choose_scenario(const std::filesystem::path& file) {
  const auto found =
      std::ranges::find_if(scenarios_, [&](const OfferedScenario& offered) { return offered.file == file; });
  if (found != scenarios_.end()) scenario = std::size_t(found - scenarios_.begin());
}

const Sitting* StartPage::begun_in(const OfferedScenario& exam) const {
  const auto found = std::ranges::find_if(sittings_, [&](const Sitting& sitting) {
    return sitting.learner == learner() && sitting.scenario_digest == exam.digest;
  });
  return found == sittings_.end() ? nullptr : &*found;
}

std::string StartPage::why_no_exam() const {
  if (!scenario) return "Choose an exam.";
  if (database_.empty()) return "There is no database to keep the attempt in: start the trainer with --results.";
  if (learner() == kNobodyInParticular)
    return learner_is_typed ? "Enter takes the id that is typed on the right."
                            : "An exam is kept under a learner's id: say on the right who is learning.";
  if (const std::int64_t number = taken_in(scenarios_[*scenario]))
    return learner() + " has taken this exam already: it is no. " + std::to_string(number) +
           " of the results. Choose another, or practise.";
  if (const Sitting* begun = begun_in(scenarios_[*scenario]))
    return learner() + " began this exam on " + time_text(begun->began_ms / 1000) +
           " and has not handed it in. End it where it is being taken, or have what there is of it scored: "
           "insonate-score hand-in " +
           shell_word(database_.string());
  return "";
}

std::string StartPage::why_not() const {
  switch (task) {
    case Task::demonstration:
    case Task::learners:
      return "";
    case Task::first_scan:
      return why_no_learner();
    case Task::practice:
      if (!why_no_learner().empty()) return why_no_learner();
      if (scenario && is_rehearsal(tracker()))
        return "The made-up hand takes no steps: choose Free practice, or another tracker on the right.";
      return why_no_tracker();
    case Task::exam:
      if (is_rehearsal(tracker())) return "The made-up hand takes no exam: choose another tracker on the right.";
      if (!why_no_learner().empty()) return why_no_learner();
      return why_no_exam().empty() ? why_no_tracker() : why_no_exam();
    case Task::patients:
      if (!why_no_learner().empty()) return why_no_learner();
      return patient < patients_.size() ? why_no_tracker() : "Choose a patient.";
    case Task::replay:
      return run < runs_.size() ? "" : "Choose a run.";
    case Task::setup: {
      if (std::string why = why_no_tracker(); !why.empty()) return why;
      const OfferedTracker* chosen = chosen_tracker();
      return chosen && chosen->has_sensor
                 ? ""
                 : "This tracker has no sensor to set up: choose another one on the right, or rehearse.";
    }
  }
  return "";
}

Options as_replay(Options options, const ReplaySource& replay) {
  options.mode = Mode::replay;
  options.tracker.clear();
  options.calibration.clear();
  options.record_raw.clear();
  options.replay = replay;
  return options;
}

std::filesystem::path StartPage::expert() const {
  if (run >= runs_.size()) return {};
  if (!runs_[run].needs_scenario() || !run_scenario) return runs_[run].expert;
  const auto known = expert_of_.find(scenarios_[*run_scenario].digest);
  return known == expert_of_.end() ? std::filesystem::path() : known->second;
}

/// Takes the patient that a recording names, if the page offers it, and the steps that were chosen for it. A file that
/// cannot be read any more is refused when it is loaded.
void StartPage::take_patient_of(const OfferedRun& chosen, Options& options) const {
  const std::string recorded = recorded_patient(chosen.replay.log);
  const std::string changes = recorded.substr(std::min(recorded.find(','), recorded.size()));
  options.replay.without_steps = !run_scenario;
  const auto found = std::find_if(patients_.begin(), patients_.end(), [&](const OfferedPatient& offered) {
    return !path_of(offered.source).empty() && offered.name == recorded;
  });
  if (found != patients_.end()) {
    options.case_folder = found->source.case_folder;
    options.ct = found->source.ct;
  }
  if (run_scenario) {
    const OfferedScenario& steps = scenarios_[*run_scenario];
    options.scenario = steps.file;
    try {
      for (const OfferedVariant& each : steps.variants)
        if (patient_words("", read_scenario(steps.file, each.seed)) == changes) options.seed = each.seed;
    } catch (const InputError&) {
    }
    return;
  }
  if (found != patients_.end() || recorded.empty()) return;
  const auto built_in = std::find_if(patients_.begin(), patients_.end(), [&](const OfferedPatient& offered) {
    return path_of(offered.source).empty() && offered.options == changes;
  });
  if (built_in == patients_.end()) return;
  options.scenario = built_in->source.scenario;
  options.seed = built_in->source.seed;
}

Beginning StartPage::chosen() const {
  Beginning chosen{options_, false, false};
  Options& options = chosen.options;
  const auto take_scenario = [&] {
    const OfferedScenario& offered = scenarios_[*scenario];
    options.scenario = offered.file;
    if (task == Task::practice && !offered.variants.empty())
      options.seed = variant ? offered.variants[*variant].seed : std::random_device()();
  };
  switch (task) {
    case Task::first_scan:
      options.tracker = "mouse:";
      options.calibration.clear();
      options.record_raw.clear();
      options.scenario = assets_folder() / "lessons" / "first_scan.toml";
      chosen.guided = true;
      break;
    case Task::demonstration:
      options.tracker.clear();
      options.calibration.clear();
      options.record_raw.clear();
      break;
    case Task::practice:
      if (scenario) take_scenario();
      chosen.free_practice = !scenario;
      break;
    case Task::exam:
      options.mode = Mode::exam;
      take_scenario();
      break;
    case Task::patients: {
      const CaseSource& source = patients_[patient].source;
      options.case_folder = source.case_folder;
      options.ct = source.ct;
      options.scenario = source.scenario;
      if (!source.scenario.empty()) options.seed = source.seed;
      const bool authoring = makes_views && !source.case_folder.empty();
      if (authoring) options.mode = Mode::author;
      chosen.free_practice = !authoring;
      break;
    }
    case Task::replay: {
      const OfferedRun& chosen_run = runs_[run];
      options = as_replay(options, chosen_run.replay);
      if (chosen_run.replay.attempt > 0) options.results = chosen_run.replay.database;
      options.scenario = chosen_run.scenario;
      if (!chosen_run.scenario.empty()) options.seed = chosen_run.seed;
      if (chosen_run.needs_scenario()) take_patient_of(chosen_run, options);
      if (beside_expert) options.replay.beside_log = expert();
      break;
    }
    case Task::setup:
      options.mode = Mode::setup;
      break;
    case Task::learners:
      break;  // a page of its own, which Trainer::show_learners() shows
  }
  return chosen;
}

}  // namespace insonate
