#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/model/settings.h"

namespace insonate {

/// Points of the front of run time against error that `insonate-bench front` measures: what a frame costs, and how far
/// its grey levels are from the converged reference. Measured on two processor cores (docs/benchmarks/epyc-2-cores; the
/// built-in abdomen and a real CT); a graphics card is faster, and the ratios are of the same order:
///
///     fast      8.6 and  8.6 ms    1.5 and 1.3 dB    three quarters of the samples, and of the pixels along each side
///     balanced  11.9 and 11.8 ms   0.9 and 0.8 dB    trainer_settings(): two samples a reflection length, 640 x 480
///     exact     26.5 and 26.8 ms   0.13 and 0.11 dB  four times the samples
enum class Quality { fast, balanced, exact };
inline constexpr std::array kQualities = {Quality::fast, Quality::balanced, Quality::exact};

/// "fast", "balanced", "exact".
std::string name_of(Quality quality);
/// In the order of kQualities.
std::vector<std::string> quality_names();
/// Throws std::invalid_argument for a name that is none of them.
Quality quality_named(const std::string& name);

/// Settings at another quality.
/// @param balanced  as trainer_settings() gives them, of any picture size
Settings at_quality(Settings balanced, Quality quality);

}  // namespace insonate
