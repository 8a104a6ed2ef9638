#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sim/phantom/phantom.h"
#include "sim/volume/case.h"
#include "tools/dataset/study.h"

namespace insonate {

/// One patient of a study. All images of a shard show the same one, so that it is read once, and so that training and
/// test sets without a common patient are sets of shards.
struct StudyPatient {
  std::uint32_t number = 0;  ///< in the study, from 0
  std::string name;          ///< "abdomen", or "abdomen 3" where a case has several
  const StudyCase* of = nullptr;
  std::vector<std::pair<std::string, std::string>> options;  ///< of the built-in patient's recipe
  std::uint32_t first_shard = 0, shards = 0;
};

/// Returns all patients of a study, whose shards follow each other. Each case has its share of shards by weight. The
/// study must outlive them. Throws InputError if there are fewer shards than patients.
std::vector<StudyPatient> patients_of(const Study& study);

/// Returns the patient of a shard.
const StudyPatient& patient_of(const std::vector<StudyPatient>& patients, std::uint32_t shard);

/// Opens a patient. The cache keeps as many phantoms as the study has patients, so that every process finds them.
/// Throws InputError.
Case open_patient(const Study& study, const StudyPatient& patient, const Progress& progress = {});

}  // namespace insonate
