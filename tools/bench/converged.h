#pragma once

#include <vector>

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "tools/bench/scene.h"

namespace insonate::bench {

/// Factor of the converged reference's samples per line; even.
inline constexpr int kFiner = 8;

/// The traversal in double precision with kFiner times as many samples, evaluated at the positions of the original
/// samples.
struct Converged {
  std::vector<int> lines;  ///< indices into the fan's lines: all, or as many as were requested, evenly distributed
  Image<double> intensity, reflection;  ///< x: index into `lines`, y: original sample
};

/// Computes the converged reference.
/// @param most_lines  limits the lines, because each takes about 0.1 s
Converged converge(const Scene& scene, const ScanLines& lines, const Settings& settings, int most_lines);

}  // namespace insonate::bench
