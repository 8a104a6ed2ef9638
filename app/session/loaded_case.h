#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "devices/tracker_context.h"
#include "scenarios/scenario.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

/// What a session is to be about. Empty paths mean: what is built in.
struct CaseSource {
  std::filesystem::path case_folder;
  std::filesystem::path ct;  ///< a file or a DICOM folder
  std::filesystem::path scenario;
  std::optional<Scenario> kept;  ///< that of an attempt that was kept, in place of a file's
  std::uint32_t seed = 0;        ///< draws the scenario's variant

  /// Whether this is the bundled exam on the built-in patient.
  bool is_bundled() const { return case_folder.empty() && ct.empty() && scenario.empty() && !kept; }
};

/// A patient ready to be scanned, and the exam if there is one. Sessions and their runners keep references to it.
struct LoadedCase {
  Case subject;
  TissueTable tissues;
  AcousticVolume acoustic;
  std::optional<Scenario> scenario;  ///< none: free practice
  TrackerContext surroundings;       ///< where the body is, and where a probe starts: on the belly, across
};

/// The exam of it; none: free practice. Throws InputError.
std::optional<Scenario> read_exam(const CaseSource& source);

/// Called from the loading thread with what is being done and how much of that is done, from 0 to 1.
using LoadProgress = std::function<void(const std::string& what, double share)>;

/// Loads it all: takes seconds. Throws InputError.
LoadedCase load_case(const CaseSource& source, const LoadProgress& progress);

/// What a path that a person drops on the trainer turns out to be.
enum class Material { case_folder, ct, scenario, tracker_log, raw_log };

/// By its ending, by what is in it when it is a folder, or by its beginning when it is a raw recording. Throws
/// InputError when it is none of them.
Material kind_of_material(const std::filesystem::path& path);

}  // namespace insonate
