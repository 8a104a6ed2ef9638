#include <algorithm>

#include "scenarios/machine.h"
#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"
#include "scenarios/steps/structures.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

std::filesystem::path phantom_in(const std::filesystem::path& assets) {
  return assets / "phantoms" / "abdomen.toml";
}

std::filesystem::path folder_of_case(const Scenario& scenario) {
  return scenario.file.parent_path() / scenario.case_name;
}

/// Returns what a metric needs and the view lacks, as the end of a sentence. Empty if the metric can be measured.
std::string lacking(const MetricInfo& metric, const ReferenceView& view, const Case& subject) {
  if (metric.needs_targets) {
    if (subject.labels.empty()) return "but the case has no labels";
    if (view.targets.empty()) return "but the view names no targets";
  }
  if (metric.needs_landmarks && view.landmarks.empty()) return "but the view names no landmarks";
  return "";
}

void check_step(const Step& step, const std::string& where, const LabelIndex& labels, std::vector<Mistake>& problems) {
  const Case& subject = labels.subject();
  if (!step.view.empty() && !subject.find_view(step.view)) {
    problems.push_back(
        {step.view_place,
         where + " names the view '" + step.view + "', which the case '" + subject.name + "' does not have",
         suggest(step.view, names_of(subject.views))});
    return;
  }
  for (const Criterion& criterion : step.criteria)
    if (criterion.sound) check_metric(criterion.metric, criterion.place, step, subject, where, problems);
  if (step.sound) step.task->check(step, labels, where, problems);
}

}  // namespace

void check_metric(Metric metric, const SourcePlace& place, const Step& step, const Case& subject,
                  const std::string& where, std::vector<Mistake>& problems) {
  const ReferenceView* view = subject.find_view(step.view);
  const std::string lack = view ? lacking(info(metric), *view, subject) : "";
  if (!lack.empty())
    problems.push_back({place, where + " asks for " + std::string(info(metric).name) + ", " + lack,
                        "add them to the case or remove the metric"});
}

std::vector<Mistake> problems_with_case(const Scenario& scenario, const Case& subject) {
  const LabelIndex labels(subject);
  const std::string first_probe = starting_machine(scenario, subject).probe;
  std::vector<Mistake> problems;
  for (std::size_t i = 0; i < scenario.steps.size(); ++i) {
    const Step& step = scenario.steps[i];
    const std::string where = "step " + std::to_string(i + 1);
    check_step(step, where, labels, problems);
    const ReferenceView* view = subject.find_view(step.view);
    if (view && scenario.locked.contains(ActionKind::probe) && view->probe != first_probe)
      problems.push_back({step.view_place,
                          where + " shows the view '" + step.view + "' with the probe '" + view->probe +
                              "', but the exam locks the probe, and begins with '" + first_probe + "'",
                          "remove \"probe\" from 'locked'"});
  }
  return problems;
}

void check_against_case(const Scenario& scenario, const Case& subject) {
  const std::vector<Mistake> problems = problems_with_case(scenario, subject);
  if (!problems.empty()) throw ScenarioError(scenario.file.string(), problems);
}

std::vector<Mistake> problems_with_phantom(const Scenario& scenario, const std::filesystem::path& assets) {
  std::vector<Mistake> problems;
  if (scenario.case_name != "abdomen") return problems;
  const std::filesystem::path recipe = phantom_in(assets);
  for (const OptionProblem& wrong :
       problems_with_options(recipe.string(), read_file(recipe), scenario.phantom_options)) {
    const auto place = scenario.option_places.find(wrong.option);
    problems.push_back({place == scenario.option_places.end() ? scenario.case_place : place->second,
                        "the phantom's option '" + wrong.option + "': " + wrong.problem, wrong.remedy});
  }
  return problems;
}

std::vector<Mistake> problems_before_case(const Scenario& scenario, const std::filesystem::path& assets) {
  if (scenario.case_name == "abdomen") return problems_with_phantom(scenario, assets);
  std::error_code error;
  if (std::filesystem::exists(folder_of_case(scenario), error)) return {};
  return {{scenario.case_place, "the case '" + scenario.case_name + "' is not a folder beside the file",
           "name a case folder, or \"abdomen\" for the built-in patient"}};
}

Case load_case(const Scenario& scenario, const std::filesystem::path& assets, const std::filesystem::path& cache,
               const Progress& progress) {
  const std::vector<Mistake> problems = problems_before_case(scenario, assets);
  if (!problems.empty()) throw ScenarioError(scenario.file.string(), problems);
  if (scenario.case_name != "abdomen") return read_case(folder_of_case(scenario));
  return cached_phantom(phantom_in(assets), scenario.phantom_options, cache, progress);
}

}  // namespace insonate
