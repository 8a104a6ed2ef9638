#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/model/settings.h"

namespace insonate {

/// Selects a point on the Pareto front of run time against error that `insonate-bench front` measures: the cost of a
/// frame, and the distance of its grey levels from the converged reference. docs/benchmarks has both, by device.
///
///     fast      half of the samples, and three quarters of the pixels along each side
///     balanced  trainer_settings(): two samples per reflection length, 640 x 480
///     exact     four times the samples
enum class Quality { fast, balanced, exact };
inline constexpr std::array kQualities = {Quality::fast, Quality::balanced, Quality::exact};

/// Returns "fast", "balanced" or "exact".
std::string name_of(Quality quality);
/// Returns the names in the order of kQualities.
std::vector<std::string> quality_names();
/// Returns the quality of that name. Throws std::invalid_argument for any other name.
Quality quality_named(const std::string& name);

/// Returns settings at another quality; samples and pixels stay within 1 and 8192.
/// @param balanced  as trainer_settings() returns them, for any picture size
Settings at_quality(Settings balanced, Quality quality);

}  // namespace insonate
