#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/core/pose.h"
#include "sim/model/settings_file.h"
#include "tests/core/run_program.h"
#include "tests/tools/render/nrrd_file.h"

namespace insonate::test {

/// The output of `insonate-render --stages`.
struct StageFolder {
  nlohmann::json description;             ///< scanlines.json
  std::map<std::string, NrrdFile> files;  ///< by their names in the folder, without .nrrd

  /// Throws std::runtime_error if a file cannot be read.
  explicit StageFolder(const std::filesystem::path& folder);

  Image<float> image(const std::string& name) const { return files.at(name).image(); }
  /// Returns `image`. Throws std::runtime_error if it holds anything but grey levels.
  Image<std::uint8_t> grey() const;
};

/// What a picture of either model shows, as its user gives it.
struct View {
  std::string probe;
  double depth_mm;
  Pose patient_from_probe;
  std::string settings;  ///< TOML
};

/// Runs insonate-render on a patient, and returns what it wrote.
/// @param folder   gets settings.toml, among others
/// @param patient  --ct or --case and a path
StageFolder export_stages(const TemporaryFolder& folder, const std::string& patient, const View& view,
                          const std::string& more);

/// A file of the folder, and the quantity or unit that it has to name.
struct FileForm {
  std::string name;     ///< without .nrrd
  std::string content;  ///< words of the header's `content`
};

/// Checks that the folder has these images and volumes and no other, and that each image has the axes, the size and the
/// unit that docs/stages.md states.
void check_forms(const StageFolder& stages, const std::vector<FileForm>& among_lines,
                 const std::vector<FileForm>& as_picture, const std::vector<std::string>& volumes);

/// Checks the part of scanlines.json that both models share, and that pixel_line and pixel_sample are what it says.
void check_geometry(const StageFolder& stages, const View& view, int samples, int width, int height, const Grid& grid);

/// Checks that scanlines.json has these settings and no other.
void check_settings(const StageFolder& stages, const std::vector<std::pair<std::string, SettingValue>>& settings);

/// Checks that a file holds values that were computed in double precision as `expected` was.
void check_rounded(const StageFolder& stages, const std::string& name, const Image<double>& expected);

}  // namespace insonate::test
