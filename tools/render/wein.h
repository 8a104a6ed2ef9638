#pragma once

#include <filesystem>
#include <string>

#include "sim/core/pose.h"
#include "sim/model/acoustic_volume.h"
#include "sim/probe/probe.h"
#include "sim/registration/wein_settings.h"
#include "sim/registration/wein_stages.h"

namespace insonate {

/// What a picture of model W is made of.
struct WeinScene {
  const AcousticVolume& volume;
  const Probe& probe;
  double depth_mm;
  const WeinSettings& settings;
  const Pose& patient_from_probe;
};

struct RenderedWein {
  WeinStages<float> stages;  ///< the terms behind scan conversion are left out; the marker (+x) on the right
  std::string made_by;       ///< the device, or the reference
};

/// One picture of model W; on the graphics card, or by the reference without OpenGL.
/// @param file  what the person who gave the CT calls it
RenderedWein render_wein(const std::string& file, const WeinScene& scene, bool by_reference);

/// Writes what crosses the stages into a folder, for those who recompute them as sim/registration/wein_settings.h has
/// them.
///
/// `scanlines.json` holds the lines (patient mm), where their samples lie, the pose, every setting, the model's
/// constants, and how pixels lie in the probe's plane. Beside it lie the volume that was used (volume.nrrd) and NRRD
/// files of raw little-endian float32, whose `content` says what their values are:
///   sizes N D, x line, y sample   intensity, scan_echogenicity, scan_reflection
///   sizes W H, marker (+x) right  pixel_line, pixel_sample (where the pixel lies among the lines); image
/// Throws InputError when they cannot be written.
void write_stages(const std::filesystem::path& folder, const WeinScene& scene, const RenderedWein& rendered);

}  // namespace insonate
