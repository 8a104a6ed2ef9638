#pragma once

#include <filesystem>
#include <string>

#include "sim/core/pose.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/wein/wein_settings.h"
#include "sim/wein/wein_stages.h"

namespace insonate {

/// The inputs of a picture of model W.
struct WeinScene {
  const AcousticVolume& volume;
  const Probe& probe;
  double depth_mm;
  const WeinSettings& settings;
  const Pose& patient_from_probe;
};

/// A picture of model W.
struct RenderedWein {
  WeinStages<float> stages;  ///< without the terms after scan conversion; the marker (+x) on the right
  std::string made_by;       ///< the device, or the reference
};

/// Returns one picture of model W, from the graphics card, or from the reference without OpenGL.
/// @param file  the user's name for the CT
RenderedWein render_wein(const std::string& file, const WeinScene& scene, bool by_reference);

/// Writes the data that pass between the stages to a folder, for users who recompute them as
/// sim/wein/wein_settings.h defines them.
///
/// `scanlines.json` holds the lines (patient mm), the positions of their samples, the pose, every setting, the model's
/// constants, and the positions of pixels in the probe's plane. The folder also holds the insonated volume
/// (volume.nrrd) and NRRD files of raw little-endian float32. Their `content` describes their values:
///   sizes N D, x line, y sample   intensity, scan_echogenicity, scan_reflection
///   sizes W H, marker (+x) right  pixel_line, pixel_sample (position of the pixel among the lines); image
/// Throws InputError if they cannot be written.
void write_stages(const std::filesystem::path& folder, const WeinScene& scene, const RenderedWein& rendered);

}  // namespace insonate
