#include "app/session/loaded_case.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>
#include <vector>

#include "devices/replay/read_log.h"
#include "scenarios/action.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/tissue/skin_contact.h"
#include "sim/volume/open_case.h"

namespace insonate {
namespace {

bool ends_with(const std::string& name, std::string_view ending) {
  return name.size() >= ending.size() && std::equal(ending.rbegin(), ending.rend(), name.rbegin(), [](char a, char b) {
           return a == char(std::tolower(static_cast<unsigned char>(b)));
         });
}

/// Returns the body's bounding box and a start pose for the probe: on the belly, or above the middle if there is no
/// body.
TrackerContext find_surroundings(const Volume<std::int16_t>& ct) {
  constexpr int kStride = 4;
  TrackerContext found;
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (int k = 0; k < ct.grid.size.z; k += kStride)
    for (int j = 0; j < ct.grid.size.y; j += kStride)
      for (int i = 0; i < ct.grid.size.x; i += kStride) {
        if (ct.at({i, j, k}) <= kSkin_hu) continue;
        const glm::dvec3 p = ct.grid.patient_from_index({i, j, k});
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
  if (low.x > high.x) low = high = ct.grid.centre();
  found.body_min = low;
  found.body_max = high;

  const std::vector<ReferenceView> views = default_views(ct, 0);
  found.start.translation = {(low.x + high.x) / 2, low.y, (low.z + high.z) / 2};
  if (!views.empty()) found.start = views.front().patient_from_probe;
  return found;
}

/// Throws InputError if the exam cannot be taken on this patient. On a patient that was chosen beside the exam, one
/// sentence takes the place of a list of mistakes, because the exam itself is right.
void check_exam(const Scenario& exam, const Case& subject, const CaseSource& source) {
  const bool own_patient = source.case_folder.empty()
                               ? source.ct.empty()
                               : source.case_folder.filename() == std::filesystem::path(exam.case_name).filename();
  const auto lacks_view = [&](const Step& step) { return step.view.empty() || !subject.find_view(step.view); };
  const bool any_view = std::ranges::any_of(exam.steps, [](const Step& step) { return !step.view.empty(); });
  if (!own_patient && any_view && std::ranges::all_of(exam.steps, lacks_view))
    throw InputError(exam.file.string(), "",
                     "'" + exam.title + "' is made for another patient: '" + subject.name + "' has none of its views",
                     "choose steps that are made for this patient, or none");
  check_against_case(exam, subject);
}

}  // namespace

std::string recorded_patient(const Recording& recording) {
  for (const auto& [time_s, actions] : parse_action_log(recording.actions, recording.file))
    for (const Action& action : actions)
      if (action.kind == ActionKind::patient) return action.text;
  return "";
}

void check_recorded_on(const LoadedCase& patient, const Recording& recording) {
  const std::string recorded = recorded_patient(recording);
  if (!recorded.empty() && recorded != patient.patient)
    throw InputError(recording.file, "", "it was recorded on '" + recorded + "', not on '" + patient.patient + "'",
                     "open that patient first, then this recording");
}

std::string patient_words(const std::string& name, const Scenario& scenario) {
  std::string words = name;
  for (const auto& [option, value] : scenario.phantom_options) words += ", " + option + " " + value;
  return words.substr(0, Action::kLongestText);  // as a log stores it
}

std::optional<Scenario> read_exam(const CaseSource& source) {
  if (source.kept) return source.kept;
  if (!source.scenario.empty()) return read_scenario(source.scenario, source.seed);
  if (source.is_bundled()) return read_scenario(assets_folder() / "scenarios" / "ruq_hepatorenal.toml", source.seed);
  return std::nullopt;
}

LoadedCase load_case(const CaseSource& source, const LoadProgress& progress) {
  LoadedCase loaded_case;
  const std::filesystem::path assets = assets_folder();
  loaded_case.tissues = read_tissue_table(assets / "tissues.toml");
  loaded_case.scenario = read_exam(source);

  if (!source.ct.empty()) {
    progress("Reading the CT", 0);
    loaded_case.subject = open_case(source.ct);
  } else if (!source.case_folder.empty()) {
    progress("Reading the case", 0);
    loaded_case.subject = read_case(source.case_folder);
  } else {
    const std::string what = "Preparing the built-in patient";
    progress(what, 0);
    loaded_case.subject =
        load_case(*loaded_case.scenario, assets, cache_folder(), [&](double share) { progress(what, share); });
  }
  loaded_case.patient = source.ct.empty() && source.case_folder.empty()
                            ? patient_words(loaded_case.subject.name, *loaded_case.scenario)
                            : loaded_case.subject.name.substr(0, Action::kLongestText);
  if (loaded_case.scenario) check_exam(*loaded_case.scenario, loaded_case.subject, source);

  progress("Working out what the sound will meet", 0);
  loaded_case.acoustic = make_acoustic_volume(loaded_case.subject.ct, loaded_case.subject.labels,
                                              tissue_by_label(loaded_case.subject), loaded_case.tissues, true);
  loaded_case.surroundings = find_surroundings(loaded_case.subject.ct);
  progress("Starting", 1);
  return loaded_case;
}

bool is_bundled_patient(const CaseSource& source) {
  if (!source.case_folder.empty() || !source.ct.empty()) return false;
  try {
    const std::optional<Scenario> asked = read_exam(source), bundled = read_exam({});
    return asked->case_name == bundled->case_name && asked->phantom_options == bundled->phantom_options;
  } catch (const InputError&) {
    return false;
  }
}

std::shared_ptr<const LoadedCase> with_exam_of(const CaseSource& source, std::shared_ptr<const LoadedCase> patient) {
  std::optional<Scenario> exam = read_exam(source);
  const std::optional<Scenario>& before = patient->scenario;
  if (exam && before && exam->digest == before->digest && exam->seed == before->seed) return patient;
  if (exam) check_exam(*exam, patient->subject, source);
  auto same = std::make_shared<LoadedCase>(*patient);
  same->scenario = std::move(exam);
  return same;
}

Material kind_of_material(const std::filesystem::path& path) {
  std::error_code error;
  const std::string name = path.filename().string();
  if (!std::filesystem::exists(path, error))
    throw InputError(path.string(), "", "there is no such file or folder", "check the name");
  if (std::filesystem::is_directory(path, error))
    return std::filesystem::exists(path / "case.toml", error) ? Material::case_folder : Material::ct;
  if (ends_with(name, ".toml")) return Material::scenario;
  for (const std::string_view ending : {".igs.mha", ".seq.mha", ".seq.nrrd"})
    if (ends_with(name, ending)) return Material::tracker_log;
  for (const std::string_view ending : {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd"})
    if (ends_with(name, ending)) return Material::ct;
  if (is_raw_log(path)) return Material::raw_log;
  throw InputError(path.string(), "", "the trainer does not open files of this kind",
                   "give a case or DICOM folder, a CT (.nii, .nii.gz, .nrrd, .mha, .mhd), a scenario (.toml) or a "
                   "recorded scan (.igs.mha)");
}

}  // namespace insonate
