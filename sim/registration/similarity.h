#pragma once

#include <glm/mat4x4.hpp>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/core/image_range.h"
#include "sim/registration/tracked_sweep.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/wein/wein_settings.h"

namespace insonate {

/// By what a sweep and a CT are compared.
enum class Measure {
  lc2,                 ///< LC2 with the images that model W simulates (sim/wein/wein_reference.h)
  mutual_information,  ///< of the ultrasound and the CT's own slices, normalised
  correlation_ratio,   ///< how much of the ultrasound's variance the CT's own slices explain
};
/// Returns "lc2", "mi" or "cr".
std::string_view to_string(Measure measure);
/// Returns the measure of a name that to_string() gives; throws std::out_of_range for another name.
Measure measure_named(std::string_view name);

/// Evaluates how similar a sweep is to a CT, for many places of the sweep in one call.
class Similarity {
public:
  virtual ~Similarity() = default;
  /// Returns one number per place, higher where they are more similar. LC2 and the correlation ratio are 0 to 1,
  /// mutual information is 1 to 2.
  /// @param used  only these of the sweep's images count; at least one
  virtual std::vector<double> at(std::span<const glm::dmat4> ct_from_sweep, ImageRange used) = 0;
  std::vector<double> at(std::span<const glm::dmat4> ct_from_sweep) { return at(ct_from_sweep, ImageRange{}); }
  /// Replaces the sweep's images, which costs far less than another similarity. There may be more or fewer than before.
  /// Throws std::invalid_argument for images of another size than the first ones.
  virtual void set_images(std::span<const SweepImage> images) = 0;
};

/// Returns LC2 of a sweep: the mean over its images, or over patches of them, weighted by the ultrasound's variation.
/// Runs on the graphics card and needs a context that is current. Throws what WeinSimulator throws.
/// @param volume    must outlive the construction alone
/// @param settings  the image's size is that of the sweep's images
std::unique_ptr<Similarity> lc2_similarity(const AcousticVolume& volume, const TrackedSweep& sweep,
                                           const WeinSettings& settings);

/// Returns the similarity of a sweep with the CT's slices: Measure::mutual_information, (H(u) + H(v)) / H(u, v) of
/// Studholme, Hill, Hawkes, "An overlap invariant entropy measure of 3D medical image alignment", Pattern Recognition
/// 32 (1999); or Measure::correlation_ratio, 1 - sum over bins of n_i var_i / (n var) of Roche, Malandain, Pennec,
/// Ayache, "The correlation ratio as a new similarity measure for multimodal image registration", MICCAI 1998. Both are
/// of one histogram of all pixels that count. Runs on the processor.
/// @param volume    must outlive the result
/// @param settings  dark_hu and bright_hu give the range of the histogram, widened by half of it at either end
std::unique_ptr<Similarity> slice_similarity(Measure measure, const AcousticVolume& volume, const TrackedSweep& sweep,
                                             const WeinSettings& settings);

}  // namespace insonate
