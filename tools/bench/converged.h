#pragma once

#include <vector>

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "tools/bench/scene.h"

namespace insonate::bench {

/// How many times as many samples a line the converged reference takes; even.
inline constexpr int kFiner = 8;

/// The traversal in double precision with kFiner times as many samples, at the places of the fewer.
struct Converged {
  std::vector<int> lines;               ///< which of the fan's: all, or as many spread over it
  Image<double> intensity, reflection;  ///< x as `lines`, y as the fewer samples
};

/// @param most_lines  as each costs a tenth of a second
Converged converge(const Scene& scene, const ScanLines& lines, const Settings& settings, int most_lines);

}  // namespace insonate::bench
