#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/wein/wein_settings.h"
#include "sim/wein/wein_stages.h"

namespace insonate {

/// The medium of model W at a point.
struct WeinMedium {
  double hu = -1000;
  glm::dvec3 gradient_hu{0.0};  ///< g = l grad mu in the patient's frame, HU
};
using WeinField = std::function<WeinMedium(const glm::dvec3& patient_mm)>;

/// Returns the field of a volume, as sim/wein/wein_settings.h defines it. The volume must outlive it.
WeinField wein_field(const AcousticVolume& volume, double reflection_length_mm);

/// Runs model W in double precision and plain loops. The simulator on the graphics card is measured against it.
WeinStages<double> wein_reference(const WeinField& field, const Probe& probe, double depth_mm,
                                  const WeinSettings& settings, const Pose& patient_from_probe);

/// Returns LC2, the linear correlation of linear combination (Wein 2008; Wein, Ladikos, Fuerst, Shah, Sharma, Navab,
/// "Global registration of ultrasound to MRI using the LC2 metric", MICCAI 2013): the share, 0 to 1, of an ultrasound
/// image's variance that the best a E + b R + c explains, 1 - sum (u - a E - b R - c)^2 / sum (u - mean u)^2.
/// 0 if the ultrasound image has no variance or no pixel counts. A term whose standard deviation is below
/// kMinTermDeviation is constant within single precision and is left out.
///
/// With patches (Fuerst, Wein, Mueller, Navab, "Automatic ultrasound-MRI registration for neurosurgery using the 2D and
/// 3D LC2 metric", Medical Image Analysis 18, 2014) the picture is cut into adjacent squares from its top left. Each
/// has its own a, b and c. Their LC2 are averaged; the weights are the ultrasound's variance times the number of pixels
/// that count.
/// @param counts  1 where a pixel counts; all images have the same size
/// @param patch   pixels along a patch's side; 0: the whole picture is one patch
double lc2_reference(const Image<double>& ultrasound, const Image<std::uint8_t>& counts,
                     const Image<double>& echogenicity, const Image<double>& reflection, int patch = 0);

inline constexpr double kMinTermDeviation = 1e-5;

}  // namespace insonate
