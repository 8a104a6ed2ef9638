#include "tools/dataset/patients.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/volume/open_case.h"
#include "tools/dataset/draws.h"

namespace insonate {
namespace {

/// Keeps the draws of patients apart from those of images.
constexpr std::uint32_t kPatientDraws = 0x70617469u;

std::string draw_option(const PhantomOption& option, const Draws& draws) {
  if (!option.range) return option.choices[draws.below(std::uint32_t(option.choices.size()), option.name)];
  constexpr double kPerUnit = 100;  // two decimals are finer than any voxel
  const double drawn = std::round(draws.within(*option.range, option.name) * kPerUnit) / kPerUnit;
  return exact_text(std::clamp(drawn, option.range->least, option.range->most));
}

}  // namespace

std::vector<StudyPatient> patients_of(const Study& study) {
  double all_weights = 0;
  for (const StudyCase& subject : study.cases) all_weights += subject.weight;
  std::vector<StudyPatient> patients;
  double before = 0;
  for (const StudyCase& subject : study.cases) {
    for (std::uint32_t n = 0; n < subject.patients; ++n) {
      StudyPatient patient;
      patient.number = std::uint32_t(patients.size());
      patient.name = subject.patients == 1 ? subject.name : subject.name + " " + std::to_string(n + 1);
      patient.of = &subject;
      const Draws draws(hash(study.seed, kPatientDraws), patient.number);
      for (const PhantomOption& option : subject.options)
        patient.options.emplace_back(option.name, draw_option(option, draws));
      const auto shard_at = [&](double weight) {
        return std::uint32_t(std::lround(study.shards() * (weight / all_weights)));
      };
      const double share = subject.weight / subject.patients;
      patient.first_shard = shard_at(before + n * share);
      patient.shards = shard_at(before + (n + 1) * share) - patient.first_shard;
      patients.push_back(std::move(patient));
    }
    before += subject.weight;
  }
  for (const StudyPatient& patient : patients)
    if (patient.shards == 0)
      throw input_error(study.file.string(), {{patient.of->place,
                                               "no shard is left for the patient " + in_quotes(patient.name) +
                                                   ": there are " + std::to_string(study.shards()) + " shards for " +
                                                   std::to_string(patients.size()) + " patients",
                                               "take more images, fewer images per shard, or a larger weight"}});
  return patients;
}

const StudyPatient& patient_of(const std::vector<StudyPatient>& patients, std::uint32_t shard) {
  for (const StudyPatient& patient : patients)
    if (shard >= patient.first_shard && shard < patient.first_shard + patient.shards) return patient;
  throw std::out_of_range("there is no shard " + std::to_string(shard));
}

Case open_patient(const Study& study, const StudyPatient& patient, const Progress& progress) {
  if (patient.of->source != kBuiltIn) return open_case(patient.of->source);
  std::size_t in_study = 0;
  for (const StudyCase& subject : study.cases) in_study += subject.patients;
  return cached_phantom(built_in_recipe(), patient.options, cache_folder(), progress,
                        std::max(kKeptPhantoms, in_study));
}

}  // namespace insonate
