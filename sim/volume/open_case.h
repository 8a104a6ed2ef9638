#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/volume/case.h"

namespace insonate {

/// The voxel pitch that scans are brought to before they are insonated: reflections are read from differences over less
/// than a millimetre, and the facets of thicker voxels would show in them as dashes.
inline constexpr double kInsonatedVoxelMm = 1.0;

/// A case folder as it is, or a CT file or DICOM folder as a case without labels, landmarks and views. Scans whose
/// voxels are larger than kInsonatedVoxelMm are resampled to it. Throws InputError.
Case open_case(const std::filesystem::path& case_folder_or_ct);

/// For each label value of a case the name of its tissue, "" where there is none; 256 entries.
std::vector<std::string> tissue_by_label(const Case& subject);

/// Poses looking into a body that nobody has marked views on: from the middle of the skin in front, marker to the
/// patient's right, and from the right flank over the liver, marker to the head. The face is pressed in by `press_mm`.
/// What counts as skin is the outermost voxel above -300 HU that has 20 mm of body behind it, which leaves out the
/// couch. Empty when there is no such body.
std::vector<ReferenceView> default_views(const Volume<std::int16_t>& ct, double press_mm = 8);

}  // namespace insonate
