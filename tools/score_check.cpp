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
#include "tools/attempt_cases.h"
#include "tools/score_commands.h"

namespace insonate {
namespace {

struct Given {
  std::filesystem::path scenario;
  std::filesystem::path case_folder;
  bool without_case = false;
};

/// What keeps a patient from being used, told where the scenario names him.
ScenarioProblem unusable(const Scenario& scenario, const InputError& error) {
  const std::string sentence = error.what();  // "FILE: PLACE: PROBLEM; REMEDY."
  const std::size_t remedy = sentence.rfind("; ");
  if (remedy == std::string::npos) return {scenario.case_place, sentence, "correct it"};
  return {scenario.case_place, "the case cannot be used: " + sentence.substr(0, remedy),
          sentence.substr(remedy + 2, sentence.size() - remedy - 3)};
}

/// What is wrong with a variant on its patient. What the phantom does not take is left out of it, so that the rest can
/// be looked at.
std::vector<ScenarioProblem> problems_with_patient(Scenario variant, const Given& given, bool text_is_right,
                                                   AttemptCases& cases) {
  std::vector<ScenarioProblem> problems;
  if (given.case_folder.empty()) {
    problems = problems_with_phantom(variant, assets_folder());
    std::erase_if(variant.phantom_options, [&](const auto& option) {
      Scenario with_it = variant;
      with_it.phantom_options = {option};
      return !problems_with_phantom(with_it, assets_folder()).empty();
    });
  }
  try {
    const Case& subject = cases.of(given.case_folder.string(), variant);
    const std::vector<ScenarioProblem> more = problems_with_case(variant, subject);
    problems.insert(problems.end(), more.begin(), more.end());
    // Building the runner checks the case's views against themselves.
    if (text_is_right && problems.empty())
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
  ReadScenario read = read_every_variant(given.scenario);
  const bool text_is_right = read.problems.empty();
  AttemptCases cases;
  if (!given.without_case)
    for (const Scenario& variant : read.variants) {
      const std::vector<ScenarioProblem> more = problems_with_patient(variant, given, text_is_right, cases);
      read.problems.insert(read.problems.end(), more.begin(), more.end());
    }
  if (!read.problems.empty()) throw ScenarioError(given.scenario.string(), std::move(read.problems));
  const Scenario& first = read.variants.front();
  std::printf("%s: \"%s\", %zu steps: no problems found\n", given.scenario.string().c_str(), first.title.c_str(),
              first.steps.size());
  return 0;
}

}  // namespace

void add_check_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<Given>();
  CLI::App* command = arguments.add_subcommand("check", "Checks a scenario file and lists all its problems");
  command->add_option("file", given->scenario, "The scenario, a TOML file")->required();
  command->add_option("--case", given->case_folder, "A case folder to take instead of the scenario's own case");
  command->add_flag("--without-case", given->without_case, "Checks the text alone, not its names against the case");
  command->callback([given, &run] { run = [given] { return check(*given); }; });
}

}  // namespace insonate
