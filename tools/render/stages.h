#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/pose.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/beam.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/model/tissue.h"
#include "sim/probe/probe.h"

namespace insonate {

/// What a picture is made of.
struct RenderedScene {
  const AcousticVolume& volume;
  const Volume<std::uint8_t>& labels;         ///< that the volume was made of; empty if there are none
  const std::vector<std::string>& tissue_of;  ///< of each label's value, "" for none
  const TissueTable& table;
  const Probe& probe;
  double depth_mm;
  const Settings& settings;
  const Pose& patient_from_probe;
};

Stages<float> in_single_precision(const Stages<double>& stages);

/// Where the files of one plane of the slice lie, within the folder of stages: "" if it is the only one.
std::string slice_folder(const std::vector<SlicePlane>& planes, std::size_t plane);

/// Writes what crosses the stages into a folder, for those who recompute them.
///
/// `scanlines.json` holds the lines (patient mm), where their samples lie, the pose, the tissue table, every setting,
/// the weights of the beam and of the slice's planes, the constants of the model, and how pixels lie in the probe's
/// plane. Beside it lie the volume that was used (volume.nrrd, volume_echogenicity.nrrd, and volume_labels.nrrd where
/// there are labels) and NRRD files of raw little-endian float32, whose `content` says what their values are:
///   sizes N D, x line, y sample   hounsfield, echogenicity, impedance, absorption, alpha, incidence (what the model's
///                                 definitions give on these lines, in double precision; if the slice has several
///                                 planes, in a folder of each, plane_1 and so on, with its
///                                 transmission and reflection beside them, and impedance and alpha of the middle
///                                 one, which is the imaging plane, here too); echo_re, echo_im (the same, all
///                                 planes' sum by weight); transmission, reflection, reflection_beam, speckle (what
///                                 `stages` hold)
///   sizes W H, marker (+x) right  pixel_line, pixel_sample (where the pixel lies among the lines); fused, image
/// Throws InputError when they cannot be written.
/// @param scene    settings without skipping: where that leaves out a normal, R is not what incidence says
/// @param made_by  what computed `stages`: the device, or the reference
void write_stages(const std::filesystem::path& folder, const RenderedScene& scene, const Stages<float>& stages,
                  const std::string& made_by);

}  // namespace insonate
