#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/scenario_check.h"
#include "tools/score/attempt_cases.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

struct CheckRequest {
  std::filesystem::path scenario;
  std::filesystem::path case_folder;
  bool without_case = false;
};

CheckedOn patients_of(const CheckRequest& given) {
  if (given.without_case) return CheckedOn::no_patient;
  return given.case_folder.empty() ? CheckedOn::its_patients : CheckedOn::given_patient;
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

int check(const CheckRequest& given) {
  const CheckedOn on = patients_of(given);
  const CheckedText text = check_text(given.scenario, on);
  const bool right_so_far = text.problems.empty();
  if (!right_so_far) {
    const ScenarioError error(given.scenario.string(), text.problems);
    if (text.on_patients.empty()) throw error;
    // Printed now, because each patient takes seconds.
    std::fprintf(stderr, "insonate-score: %s\n", error.what());
  }
  std::vector<Mistake> problems;
  {
    AttemptCases cases;
    CheckProgress progress(text.on_patients.size());
    for (const Scenario& variant : text.on_patients) {
      progress.begin(variant);
      const std::vector<Mistake> more =
          check_on_patient(text, variant, on, [&](const Scenario& checked) -> const Case& {
            return cases.of(given.case_folder.string(), checked, [&](double share) { progress.show(share); });
          });
      problems.insert(problems.end(), more.begin(), more.end());
    }
  }
  if (!problems.empty()) throw ScenarioError(given.scenario.string(), problems);
  if (!right_so_far) return 2;
  const Scenario& exam = text.read.variants.front();
  std::printf("%s: \"%s\", %zu steps: no problems found\n", given.scenario.string().c_str(), exam.title.c_str(),
              exam.steps.size());
  return 0;
}

}  // namespace

void add_check_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<CheckRequest>();
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
