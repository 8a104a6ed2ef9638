#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/cases/import_case.h"
#include "sim/volume/case.h"

namespace insonate {

/// What insonate-case does, a function a command. All throw InputError.

/// Prints what a case, CT file or DICOM folder holds, for people or as JSON.
void inspect(const std::filesystem::path& path, bool json);

/// @param recipe  the built-in abdomen's when empty
void make_and_write(std::filesystem::path recipe, const std::vector<std::string>& settings,
                    const std::filesystem::path& folder);

/// @param replace  whether a case of that folder is written over, with what an expert has added to it
void import_and_write(ImportRequest request, const std::filesystem::path& folder, bool replace);

/// A moment of a recorded log.
struct RecordedMoment {
  std::filesystem::path log;  ///< a PLUS/IGSIO sequence file
  double at_s = 0;            ///< after the log's first frame
  std::string transform;      ///< as probe_samples() takes it
};

/// Adds a view whose pose is in a file or a log, one of them; see add_view().
void add_recorded_view(const std::filesystem::path& folder, ReferenceView view, const std::string& pose_file,
                       const RecordedMoment& moment);

}  // namespace insonate
