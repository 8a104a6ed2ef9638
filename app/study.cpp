#include "app/study.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

#include "scenarios/skin_contact.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/volume/ct_reader.h"
#include "sim/volume/phantom.h"

namespace insonate {
namespace {

/// Fine enough that gradients between thick slices are smooth, coarse enough for a graphics card's memory.
constexpr double kSpacing_mm = 1.0;

bool ends_with(const std::string& name, std::string_view ending) {
  return name.size() >= ending.size() && std::equal(ending.rbegin(), ending.rend(), name.rbegin(), [](char a, char b) {
           return a == char(std::tolower(static_cast<unsigned char>(b)));
         });
}

Case case_of_ct(const std::filesystem::path& path, const LoadProgress& progress) {
  progress("Reading the CT", 0);
  Case subject;
  subject.name = path.filename().string();
  if (subject.name.empty()) subject.name = path.parent_path().filename().string();
  const Volume<std::int16_t> ct = read_ct(path);
  progress("Resampling the CT to " + std::to_string(int(kSpacing_mm)) + " mm", 0.5);
  subject.ct = resample_isotropic(ct, kSpacing_mm);
  return subject;
}

std::vector<std::string> tissue_names(const Case& subject) {
  std::vector<std::string> names(256);
  for (const Label& label : subject.label_table) names[label.value] = label.tissue;
  return names;
}

/// The body's bounding box and a pose on the belly: across the body, beam to the back, marker to the patient's right.
TrackerContext find_surroundings(const Volume<std::int16_t>& ct) {
  constexpr int kStride = 4;
  TrackerContext found;
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (int k = 0; k < ct.grid.size.z; k += kStride)
    for (int j = 0; j < ct.grid.size.y; j += kStride)
      for (int i = 0; i < ct.grid.size.x; i += kStride) {
        if (ct.at({i, j, k}) <= kSkinHu) continue;
        const glm::dvec3 p = ct.grid.patient_from_index({i, j, k});
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
  if (low.x > high.x) low = high = ct.grid.centre();
  found.body_min = low;
  found.body_max = high;

  found.start.rotation = glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1));
  const double reach = high.y - low.y + 100;
  glm::dvec3 start((low.x + high.x) / 2, low.y - 20, (low.z + high.z) / 2);
  if (const auto skin = distance_to_skin(ct, start, {0, 1, 0}, reach)) start.y += *skin;
  found.start.translation = start;
  return found;
}

}  // namespace

Study load_study(const StudySource& source, const LoadProgress& progress) {
  Study study;
  const std::filesystem::path assets = assets_folder();
  study.tissues = read_tissue_table(assets / "tissues.toml");
  if (!source.scenario.empty())
    study.scenario = read_scenario(source.scenario);
  else if (source.is_bundled())
    study.scenario = read_scenario(assets / "scenarios" / "ruq_hepatorenal.toml");

  if (!source.ct.empty()) {
    study.subject = case_of_ct(source.ct, progress);
  } else if (!source.case_folder.empty()) {
    progress("Reading the case", 0);
    study.subject = read_case(source.case_folder);
  } else {
    const std::string what = "Preparing the built-in patient";
    progress(what, 0);
    study.subject = load_case(*study.scenario, assets, cache_folder(), [&](double share) { progress(what, share); });
  }
  if (study.scenario) check_against_case(*study.scenario, study.subject);

  progress("Working out what the sound will meet", 0);
  study.acoustic =
      make_acoustic_volume(study.subject.ct, study.subject.labels, tissue_names(study.subject), study.tissues);
  study.surroundings = find_surroundings(study.subject.ct);
  progress("Starting", 1);
  return study;
}

Material kind_of_material(const std::filesystem::path& path) {
  std::error_code error;
  const std::string name = path.filename().string();
  if (!std::filesystem::exists(path, error))
    throw InputError(path.string(), "", "there is no such file or folder", "check the name");
  if (std::filesystem::is_directory(path, error))
    return std::filesystem::exists(path / "case.toml", error) ? Material::case_folder : Material::ct;
  if (ends_with(name, ".toml")) return Material::scenario;
  for (const std::string_view ending : {".igs.mha", ".seq.mha"})
    if (ends_with(name, ending)) return Material::tracker_log;
  for (const std::string_view ending : {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd"})
    if (ends_with(name, ending)) return Material::ct;
  throw InputError(path.string(), "", "the trainer does not open files of this kind",
                   "give a case or DICOM folder, a CT (.nii, .nii.gz, .nrrd, .mha, .mhd), a scenario (.toml) or a "
                   "recorded scan (.igs.mha)");
}

}  // namespace insonate
