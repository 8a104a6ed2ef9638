#include "scenarios/scenario_check.h"

#include <algorithm>
#include <utility>

#include "scenarios/runner.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/tissue/tissue.h"

namespace insonate {
namespace {

/// Returns the reason why a patient cannot be used, placed where the scenario names it.
Mistake unusable(const Scenario& scenario, const InputError& error) {
  const std::string sentence = error.what();  // "FILE: PLACE: PROBLEM; REMEDY."
  const std::size_t remedy = sentence.rfind("; ");
  if (remedy == std::string::npos) return {scenario.case_place, sentence, "correct it"};
  return {scenario.case_place, "the case cannot be used: " + sentence.substr(0, remedy),
          sentence.substr(remedy + 2, sentence.size() - remedy - 3)};
}

bool can_be_checked(const Scenario& variant, CheckedOn on) {
  if (variant.steps.empty()) return false;
  if (on == CheckedOn::given_patient || variant.case_name == "abdomen") return true;
  return !variant.case_name.empty() && problems_before_case(variant, assets_folder()).empty();
}

}  // namespace

CheckedText check_text(const std::filesystem::path& file, CheckedOn on) {
  CheckedText text;
  text.read = read_every_variant(file);
  text.problems = text.read.problems;
  if (on == CheckedOn::its_patients)
    for (const Scenario& variant : text.read.variants)
      if (!variant.case_name.empty())
        for (Mistake& problem : problems_before_case(variant, assets_folder()))
          text.problems.push_back(std::move(problem));
  if (on == CheckedOn::no_patient) return text;
  for (const Scenario& variant : text.read.variants)
    if (can_be_checked(variant, on)) text.on_patients.push_back(variant);
  if (on == CheckedOn::its_patients)
    std::stable_sort(text.on_patients.begin(), text.on_patients.end(),
                     [](const Scenario& a, const Scenario& b) { return patient_key(a) < patient_key(b); });
  return text;
}

std::vector<Mistake> check_on_patient(const CheckedText& text, const Scenario& variant, CheckedOn on,
                                      const PatientOf& patient_of) {
  Scenario checked = variant;
  bool takes_options = true;
  if (on == CheckedOn::its_patients && !problems_with_phantom(checked, assets_folder()).empty()) {
    takes_options = false;
    std::erase_if(checked.phantom_options, [&](const auto& option) {
      Scenario with_it = checked;
      with_it.phantom_options = {option};
      return !problems_with_phantom(with_it, assets_folder()).empty();
    });
  }
  std::vector<Mistake> problems;
  try {
    const Case& subject = patient_of(checked);
    problems = problems_with_case(checked, subject);
    // Building the runner checks the case's views against themselves.
    if (text.read.problems.empty() && takes_options && problems.empty())
      Runner(checked, subject, read_tissue_table(assets_folder() / "tissues.toml"));
  } catch (const ScenarioError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  } catch (const InputError& error) {
    if (on == CheckedOn::given_patient) throw;
    problems.push_back(unusable(checked, error));
  }
  return problems;
}

std::string patient_key(const Scenario& scenario) {
  std::string key = '\n' + scenario.case_name + '\n' + scenario.file.parent_path().string();
  for (const auto& [name, value] : scenario.phantom_options) key.append("\n").append(name).append("=").append(value);
  return key;
}

}  // namespace insonate
