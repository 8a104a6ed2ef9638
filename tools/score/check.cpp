#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/runner.h"
#include "scenarios/scenario.h"
#include "sim/core/files.h"
#include "sim/model/tissue.h"
#include "tools/score/attempt_cases.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

struct Given {
  std::filesystem::path scenario;
  std::filesystem::path case_folder;
  bool without_case = false;
};

/// Returns the reason why a patient cannot be used, placed where the scenario names it.
Mistake unusable(const Scenario& scenario, const InputError& error) {
  const std::string sentence = error.what();  // "FILE: PLACE: PROBLEM; REMEDY."
  const std::size_t remedy = sentence.rfind("; ");
  if (remedy == std::string::npos) return {scenario.case_place, sentence, "correct it"};
  return {scenario.case_place, "the case cannot be used: " + sentence.substr(0, remedy),
          sentence.substr(remedy + 2, sentence.size() - remedy - 3)};
}

/// Shows the progress of the check of the patients, on a terminal only. Scripts expect only problems on standard error.
class CheckProgress {
public:
  explicit CheckProgress(std::size_t variants) : variants_(variants) {}
  ~CheckProgress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  CheckProgress(const CheckProgress&) = delete;
  CheckProgress& operator=(const CheckProgress&) = delete;

  void begin(const Scenario& variant) {
    name_ = variant.variant;
    ++begun_;
    show(0);
  }

  /// progress of the patient, from 0 to 1
  void show(double share) {
    if (!on_terminal_) return;
    shown_ = true;
    const double done = (double(begun_ - 1) + share) / double(variants_);
    const double taken_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::fprintf(stderr, "\r\033[Kvariant %zu of %zu%s%s: making its patient, %.0f %%", begun_, variants_,
                 name_.empty() ? "" : ", ", name_.c_str(), 100 * share);
    if (done > 0) std::fprintf(stderr, "; about %.0f s left", taken_s * (1 - done) / done);
  }

private:
  const std::size_t variants_;
  const bool on_terminal_ = isatty(STDERR_FILENO) != 0;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t begun_ = 0;
  std::string name_;
  bool shown_ = false;
};

/// Returns the problems that do not need the patients: of the text, and of how each variant names its case.
std::vector<Mistake> problems_before_patients(const ReadScenario& read, const Given& given) {
  std::vector<Mistake> problems = read.problems;
  if (!given.case_folder.empty() || given.without_case) return problems;
  for (const Scenario& variant : read.variants)
    if (!variant.case_name.empty())
      for (Mistake& problem : problems_before_case(variant, assets_folder())) problems.push_back(std::move(problem));
  return problems;
}

/// Returns the variants that can be checked on their patient. Variants with the same patient follow each other.
std::vector<Scenario> with_patients(std::vector<Scenario> variants, const Given& given) {
  if (given.without_case) return {};
  std::erase_if(variants, [&](const Scenario& variant) {
    if (variant.steps.empty()) return true;
    if (!given.case_folder.empty() || variant.case_name == "abdomen") return false;
    return variant.case_name.empty() || !problems_before_case(variant, assets_folder()).empty();
  });
  std::stable_sort(variants.begin(), variants.end(), [&](const Scenario& a, const Scenario& b) {
    return AttemptCases::key_of(given.case_folder.string(), a) < AttemptCases::key_of(given.case_folder.string(), b);
  });
  return variants;
}

/// Returns the problems of a variant on its patient. Options that the phantom refuses are removed first, so that the
/// rest can be checked.
std::vector<Mistake> problems_with_patient(Scenario variant, const Given& given, bool text_is_right,
                                           AttemptCases& cases, CheckProgress& progress) {
  bool takes_options = true;
  if (given.case_folder.empty() && !problems_with_phantom(variant, assets_folder()).empty()) {
    takes_options = false;
    std::erase_if(variant.phantom_options, [&](const auto& option) {
      Scenario with_it = variant;
      with_it.phantom_options = {option};
      return !problems_with_phantom(with_it, assets_folder()).empty();
    });
  }
  std::vector<Mistake> problems;
  try {
    const Case& subject = cases.of(given.case_folder.string(), variant, [&](double share) { progress.show(share); });
    problems = problems_with_case(variant, subject);
    // Building the runner checks the case's views against themselves.
    if (text_is_right && takes_options && problems.empty())
      Runner(variant, subject, read_tissue_table(assets_folder() / "tissues.toml"));
  } catch (const ScenarioError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  } catch (const InputError& error) {
    if (!given.case_folder.empty()) throw;
    problems.push_back(unusable(variant, error));
  }
  return problems;
}

int check(const Given& given) {
  const ReadScenario read = read_every_variant(given.scenario);
  std::vector<Mistake> first = problems_before_patients(read, given);
  const bool right_so_far = first.empty();
  const std::vector<Scenario> variants = with_patients(read.variants, given);
  if (!right_so_far) {
    const ScenarioError error(given.scenario.string(), std::move(first));
    if (variants.empty()) throw error;
    // Printed now, because each patient takes seconds.
    std::fprintf(stderr, "insonate-score: %s\n", error.what());
  }
  std::vector<Mistake> problems;
  {
    AttemptCases cases;
    CheckProgress progress(variants.size());
    for (const Scenario& variant : variants) {
      progress.begin(variant);
      const std::vector<Mistake> more = problems_with_patient(variant, given, read.problems.empty(), cases, progress);
      problems.insert(problems.end(), more.begin(), more.end());
    }
  }
  if (!problems.empty()) throw ScenarioError(given.scenario.string(), std::move(problems));
  if (!right_so_far) return 2;
  const Scenario& exam = read.variants.front();
  std::printf("%s: \"%s\", %zu steps: no problems found\n", given.scenario.string().c_str(), exam.title.c_str(),
              exam.steps.size());
  return 0;
}

}  // namespace

void add_check_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<Given>();
  CLI::App* command = arguments.add_subcommand("check",
                                               "Check a scenario file and list all its problems: first those of the "
                                               "file, then those that appear on its patients");
  command->add_option("SCENARIO", given->scenario, "Check this scenario file (TOML)")->type_name("FILE")->required();
  command->add_option("--case", given->case_folder, "Check it on the patient of this case folder")
      ->type_name("FOLDER")
      ->default_str("the scenario's patient");
  command->add_flag("--without-case", given->without_case, "Check the text alone, not its names against the case");
  command->callback([given, &run] { run = [given] { return check(*given); }; });
}

}  // namespace insonate
