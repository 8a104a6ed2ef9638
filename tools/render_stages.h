#pragma once

#include <filesystem>
#include <string>

#include "sim/core/pose.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/model/tissue.h"
#include "sim/probe/probe.h"

namespace insonate {

/// What a picture is made of.
struct RenderedScene {
  const AcousticVolume& volume;
  const TissueTable& table;
  const Probe& probe;
  double depth_mm;
  const Settings& settings;
  const Pose& patient_from_probe;
};

Stages<float> in_single_precision(const Stages<double>& stages);

/// Writes what crosses the stages into a folder, for those who recompute them.
///
/// `scanlines.json` holds the lines (patient mm), where their samples lie, the pose, the tissue table, every setting,
/// the weights of the beam, and how pixels lie in the probe's plane. Beside it lie NRRD files of raw little-endian
/// float32, whose `content` says what their values are:
///   sizes N D, x line, y sample   hounsfield, echogenicity, impedance, absorption, alpha, incidence, echo_re, echo_im
///                                 (what the model's definitions give on these lines, in double precision);
///                                 transmission, reflection, reflection_beam, speckle (what `stages` hold)
///   sizes W H, marker (+x) right  pixel_line, pixel_sample (where the pixel lies among the lines); fused, image
/// Throws InputError when they cannot be written.
/// @param made_by  what computed `stages`: the device, or the reference
void write_stages(const std::filesystem::path& folder, const RenderedScene& scene, const Stages<float>& stages,
                  const std::string& made_by);

}  // namespace insonate
