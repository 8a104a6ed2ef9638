// Scenario files, in every variant, also held against a case.
#include "scenarios/scenario.h"

#include <cmath>

#include "tests/fuzz/fuzz_target.h"
#include "tests/scenarios/tiny_case.h"

namespace insonate::fuzz {
namespace {

bool is_criterion(const Criterion& criterion) {
  return criterion.sound && std::isfinite(criterion.full) && std::isfinite(criterion.zero) &&
         criterion.full != criterion.zero && criterion.weight > 0 && criterion.weight <= 1000;
}

std::string broken_in(const Scenario& scenario) {
  if (scenario.title.empty() || scenario.steps.empty() || scenario.steps.size() > 100) return "it is not an exam";
  if (!(scenario.pass_mark_percent >= 0 && scenario.pass_mark_percent <= 100)) return "the pass mark is out of range";
  if (!(scenario.time_limit_s >= 1 && scenario.time_limit_s <= 36000)) return "the exam's limit is out of range";
  for (const Criterion& criterion : scenario.criteria)
    if (!is_criterion(criterion)) return "a criterion of the exam is out of range";
  for (const Step& step : scenario.steps) {
    if (!step.sound || !step.task || step.title.empty()) return "a step is not sound";
    if (!(step.time_limit_s >= 1 && step.time_limit_s <= 3600)) return "a step's limit is out of range";
    if (step.hints.size() > 10) return "a step has too many hints";
    for (const Criterion& criterion : step.criteria)
      if (!is_criterion(criterion)) return "a criterion of a step is out of range";
  }
  return "";
}

const Target scenario_target("scenario", [](std::string_view bytes) -> std::string {
  static const Case subject = tiny_case();
  const Scenario scenario = parse_scenario(bytes, "fuzzed.toml");
  if (const std::string broken = broken_in(scenario); !broken.empty()) return broken;
  for (std::uint32_t seed = 1; seed < 4 && scenario.variants > 1; ++seed)
    if (const std::string broken = broken_in(parse_scenario(bytes, "fuzzed.toml", seed)); !broken.empty())
      return broken;
  check_against_case(scenario, subject);
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
