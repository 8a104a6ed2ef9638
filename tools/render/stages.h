#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/pose.h"
#include "sim/model/beam.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// The inputs of a picture.
struct RenderedScene {
  const AcousticVolume& volume;
  const Volume<std::uint8_t>& labels;         ///< labels that the volume was made from; empty if there are none
  const std::vector<std::string>& tissue_of;  ///< by label value, "" for none
  const TissueTable& table;
  const Probe& probe;
  double depth_mm;
  const Settings& settings;
  const Pose& patient_from_probe;
};

/// Returns the stages rounded to float.
Stages<float> in_single_precision(const Stages<double>& stages);

/// Returns the folder of one plane's files within the folder of stages: "" if the slice has only one plane.
std::string slice_folder(const std::vector<SlicePlane>& planes, std::size_t plane);

/// Writes the data that pass between the stages to a folder, for users who recompute them.
///
/// `scanlines.json` holds the lines (patient mm), the positions of their samples, the pose, the tissue table, every
/// setting, the weights of the beam and of the slice's planes, the constants of the model, and the positions of pixels
/// in the probe's plane. The folder also holds the insonated volume (volume.nrrd, volume_echogenicity.nrrd, and
/// volume_labels.nrrd if there are labels) and NRRD files of raw little-endian float32. Their `content` describes their
/// values:
///   sizes N D, x line, y sample   hounsfield, echogenicity, impedance, absorption, alpha, incidence (by the model's
///                                 definitions on these lines, in double precision). If the slice has several planes,
///                                 each has them in its own folder (plane_1 and so on), together with its
///                                 transmission and reflection; impedance and alpha of the middle plane are here
///                                 too. echo_re, echo_im (the same, weighted sum of all planes); transmission,
///                                 reflection, reflection_beam, speckle (as in `stages`)
///   sizes W H, marker (+x) right  pixel_line, pixel_sample (position of the pixel among the lines); fused, image
/// Throws InputError if they cannot be written.
/// @param scene    settings without skipping: where skipping omits a normal, R does not match the incidence
/// @param made_by  what computed `stages`: the device, or the reference
void write_stages(const std::filesystem::path& folder, const RenderedScene& scene, const Stages<float>& stages,
                  const std::string& made_by);

}  // namespace insonate
