#include "sim/reference/clutter_reference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/reference/reference.h"

namespace insonate {

double WallClutter::at(double line, double sample) const {
  return std::min(bilinear(most, 0, sample), bilinear(per_arriving, 0, sample) * bilinear(arriving, line, sample));
}

WallClutter wall_clutter_reference(const Stages<double>& stages, const ScanLines& lines, const Settings& settings) {
  const int samples = lines.samples, n = stages.intensity.width;
  WallClutter clutter{Image<double>(1, samples), Image<double>(1, samples), Image<double>(n, samples)};
  if (!settings.waves || !settings.clutter) return clutter;
  std::vector<double> layers;  // E
  for (int k = 0; k < samples; ++k) {
    double sum = 0;
    for (int line = 0; line < n; ++line) {
      const double echo = std::pow(stages.wave_re.at(line, k), 2) + std::pow(stages.wave_im.at(line, k), 2);
      const double squared = heard(std::pow(stages.intensity.at(line, k), 2));
      clutter.arriving.at(line, k) = squared;
      sum += std::min(echo, kLayerShare * squared);
    }
    layers.push_back(std::max(sum / n - kMinLayerEcho, 0.0));
  }
  for (int i = 0; i < samples; ++i)
    for (int j = 0; i + j < samples; ++j) {
      const double echo = kWallReturn * lines.dr_mm() / settings.reflection_length_mm / 2 * layers[std::size_t(i)] *
                          layers[std::size_t(j)];
      clutter.most.at(0, i + j) += echo;
      if (i + j + 1 < samples) clutter.most.at(0, i + j + 1) += echo;
    }
  for (int k = 0; k < samples; ++k) {
    double mean = 0;
    for (int line = 0; line < n; ++line) mean += clutter.arriving.at(line, k) / n;
    if (mean <= kMinEcho)
      clutter.most.at(0, k) = 0;
    else
      clutter.per_arriving.at(0, k) = clutter.most.at(0, k) / mean;
  }
  return clutter;
}

}  // namespace insonate
