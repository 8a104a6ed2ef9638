#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/files/mistake.h"

namespace insonate {

/// The patients on which a scenario is checked.
enum class CheckedOn { its_patients, given_patient, no_patient };

/// What is known of a scenario file without its patients.
struct CheckedText {
  ReadScenario read;
  std::vector<Mistake> problems;      ///< of the text, and of how each variant names its case
  std::vector<Scenario> on_patients;  ///< the variants to check on patients; those of one patient follow each other
};

/// Checks the text of a scenario file, which takes no time. Throws InputError if the file cannot be read.
CheckedText check_text(const std::filesystem::path& file, CheckedOn on);

/// Returns the patient of a variant, which may take seconds. It is used until the next call. Throws InputError.
using PatientOf = std::function<const Case&(const Scenario&)>;

/// Returns the problems of one variant in CheckedText::on_patients on its patient. Options that the phantom refuses are
/// left out, so that the rest can be checked. Throws InputError if a given patient cannot be used; another patient that
/// cannot be used is a problem.
std::vector<Mistake> check_on_patient(const CheckedText& text, const Scenario& variant, CheckedOn on,
                                      const PatientOf& patient_of);

/// Returns a text that is equal for variants with equal patients.
std::string patient_key(const Scenario& scenario);

}  // namespace insonate
