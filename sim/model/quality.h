#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/model/settings.h"

namespace insonate {

/// Points of the front of run time against error that `insonate-bench front` measures: what a frame costs, and how far
/// its grey levels are from the converged reference. docs/benchmarks has both, by device.
///
///     fast      three quarters of the samples, and of the pixels along each side
///     balanced  trainer_settings(): two samples a reflection length, 640 x 480
///     exact     four times the samples
enum class Quality { fast, balanced, exact };
inline constexpr std::array kQualities = {Quality::fast, Quality::balanced, Quality::exact};

/// "fast", "balanced", "exact".
std::string name_of(Quality quality);
/// In the order of kQualities.
std::vector<std::string> quality_names();
/// Throws std::invalid_argument for a name that is none of them.
Quality quality_named(const std::string& name);

/// Settings at another quality; samples and pixels stay within 1 and 8192.
/// @param balanced  as trainer_settings() gives them, of any picture size
Settings at_quality(Settings balanced, Quality quality);

}  // namespace insonate
