#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/cases/import_case.h"
#include "sim/volume/case.h"

namespace insonate {

/// The commands of insonate-case, one function each. All throw InputError.

/// Prints the content of a case, CT file or DICOM folder, as text or as JSON.
void inspect(const std::filesystem::path& path, bool json);

/// Builds a phantom and writes it as a case.
/// @param recipe  the recipe of the built-in abdomen if empty
void make_and_write(std::filesystem::path recipe, const std::vector<std::string>& settings,
                    const std::filesystem::path& folder);

/// Imports a patient and writes the case.
/// @param replace  overwrites an existing case in the folder, including an expert's additions
void import_and_write(ImportRequest request, const std::filesystem::path& folder, bool replace);

/// A time in a recorded log.
struct RecordedMoment {
  std::filesystem::path log;  ///< a PLUS/IGSIO sequence file
  double at_s = 0;            ///< seconds after the log's first frame
  std::string transform;      ///< name of the transform, as for probe_samples()
};

/// Adds a view whose pose comes from either a pose file or a log; see add_view().
void add_recorded_view(const std::filesystem::path& folder, ReferenceView view, const std::string& pose_file,
                       const RecordedMoment& moment);

}  // namespace insonate
