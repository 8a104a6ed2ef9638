#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/model/settings_file.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "tools/render/stages.h"

namespace insonate {

/// The scan lines and the pixel layout of a picture of either model.
struct StageGeometry {
  StageGeometry(const Probe& probe, double depth_mm, int samples, int width, int height);
  const Probe& probe;
  double depth_mm;
  ScanLines lines;
  ImageGeometry image;
};

/// Value of `made_by` for stages that were computed without a device.
inline constexpr char kMadeByReference[] = "reference in double precision";

/// Returns the part of scanlines.json that both models share.
/// @param model  S or W
nlohmann::ordered_json describe_geometry(const char* model, const StageGeometry& geometry,
                                         const Pose& patient_from_probe, const AcousticVolume& volume,
                                         const std::string& made_by);

/// Adds every setting by its name.
void describe_settings(nlohmann::ordered_json& text, const std::vector<std::pair<std::string, SettingValue>>& settings);

/// Returns the complete scanlines.json of model S.
nlohmann::ordered_json describe(const RenderedScene& scene, const StageGeometry& geometry, const std::string& made_by);

/// Writes the position of each pixel among the lines: pixel_line, pixel_sample.
void write_pixel_positions(const std::filesystem::path& folder, const StageGeometry& geometry);

/// Write the insonated volume in the patient's frame (LPS): volume.nrrd, Hounsfield units, and
/// volume_echogenicity.nrrd, hundredths of a dB.
void write_hounsfield(const std::filesystem::path& folder, const AcousticVolume& volume);
void write_echogenicity(const std::filesystem::path& folder, const AcousticVolume& volume);

}  // namespace insonate
