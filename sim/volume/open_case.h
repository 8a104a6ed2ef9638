#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/volume/case.h"

namespace insonate {

/// The voxel size to which scans are resampled before they are simulated, mm. Reflections are read from differences
/// over less than a millimetre, and the facets of thicker voxels would appear in them as dashes.
inline constexpr double kInsonatedVoxel_mm = 1.0;

/// Opens a case folder, or a CT file or DICOM folder as a case without labels and landmarks, with default_views().
/// Scans whose voxels are larger than kInsonatedVoxel_mm are resampled to it. Throws InputError.
Case open_case(const std::filesystem::path& case_folder_or_ct);

/// Returns the tissue name for each label value of a case, "" where there is none; 256 entries.
std::vector<std::string> tissue_by_label(const Case& subject);

/// Returns where a ray from outside the body first enters it, patient mm. The skin is the outermost point above -300 HU
/// with 20 mm of body behind it, which excludes the couch. Returns nothing if there is none within `reach_mm`.
/// @param direction  unit
std::optional<glm::dvec3> skin_along(const Volume<std::int16_t>& ct, const glm::dvec3& from,
                                     const glm::dvec3& direction, double reach_mm);

/// Returns views for a body without reference views: from the middle of the skin in front, marker to the patient's
/// right, and from the right flank over the liver, marker to the head. The face is pressed in by `press_mm` from the
/// skin (skin_along()). Returns nothing if there is no such body.
std::vector<ReferenceView> default_views(const Volume<std::int16_t>& ct, double press_mm = 8);

}  // namespace insonate
