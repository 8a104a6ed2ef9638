#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "devices/recording.h"
#include "devices/tracker_context.h"
#include "scenarios/scenario.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

/// Says what a session loads. An empty path selects what is built in.
struct CaseSource {
  std::filesystem::path case_folder;
  std::filesystem::path ct;  ///< a file or a DICOM folder
  std::filesystem::path scenario;
  std::optional<Scenario> kept;  ///< scenario of a stored attempt, used in place of a file's
  std::uint32_t seed = 0;        ///< selects the scenario's variant

  /// Returns whether this is the bundled exam on the built-in patient.
  bool is_bundled() const { return case_folder.empty() && ct.empty() && scenario.empty() && !kept; }
};

/// A patient ready to be scanned, and the exam if there is one. Sessions and their runners keep references to it.
struct LoadedCase {
  Case subject;
  std::string patient;  ///< in words, as recordings name it: patient_words(), or the name of a CT or case; may be empty
  TissueTable tissues;
  AcousticVolume acoustic;
  std::optional<Scenario> scenario;  ///< empty: free practice
  TrackerContext surroundings;       ///< where the body is, and where a probe starts: on the belly, transverse
};

/// Returns a built-in patient in words, with what a scenario has changed on it: "Abdomen phantom, aorta_diameter_mm
/// 45".
std::string patient_words(const std::string& name, const Scenario& scenario);

/// Returns the patient that a recording names; empty if it names none. Throws InputError if its actions cannot be read.
std::string recorded_patient(const Recording& recording);

/// Throws InputError if the recording names another patient.
void check_recorded_on(const LoadedCase& patient, const Recording& recording);

/// Reads the exam that `source` names; empty for free practice. Throws InputError.
std::optional<Scenario> read_exam(const CaseSource& source);

/// Called from the loading thread with the current activity and its completed share, 0 to 1.
using LoadProgress = std::function<void(const std::string& what, double share)>;

/// Loads the patient and the exam, which takes seconds. Throws InputError.
LoadedCase load_case(const CaseSource& source, const LoadProgress& progress);

/// Returns whether `source` names the patient of the bundled exam, perhaps with another exam. False if the exam cannot
/// be read.
bool is_bundled_patient(const CaseSource& source);

/// Returns the same patient with the exam that `source` names. Copies the volumes for another exam than the patient's,
/// which takes tenths of a second. Throws InputError if the exam cannot be read or does not fit the patient.
std::shared_ptr<const LoadedCase> with_exam_of(const CaseSource& source, std::shared_ptr<const LoadedCase> patient);

/// What a path that a person drops on the trainer contains.
enum class Material { case_folder, ct, scenario, tracker_log, raw_log };

/// Judges a path by its file name extension, a folder by its content, and a raw recording by its first bytes. Throws
/// InputError if it is none of the kinds.
Material kind_of_material(const std::filesystem::path& path);

}  // namespace insonate
