#include "sim/model/beam.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <numeric>

namespace insonate {
namespace {

double window(BeamWindow shape, double t) {  // t in (-1, 1) across the aperture
  switch (shape) {
    case BeamWindow::box:
      return 1.0;
    case BeamWindow::triangle:
      return 1.0 - std::abs(t);
    case BeamWindow::hann:
      return 0.5 + 0.5 * std::cos(glm::pi<double>() * t);
  }
  return 1.0;
}

// Cubic B-spline over its value at 0: the autocorrelation of the hat function.
double interpolation_correlation(double cells) {
  const double d = std::abs(cells);
  if (d >= 2) return 0;
  if (d >= 1) return (2 - d) * (2 - d) * (2 - d) / 4;
  return 1 - 1.5 * d * d + 0.75 * d * d * d;
}

// Mean magnitude of a complex number whose parts are normal with variance 1 (Rayleigh).
const double kRayleighMean = std::sqrt(glm::pi<double>() / 2);

}  // namespace

std::vector<double> beam_weights(const Settings& settings) {
  const int half = (settings.beam_lines - 1) / 2;
  std::vector<double> weights;
  for (int j = -half; j <= half; ++j) weights.push_back(window(settings.beam_window, j / (half + 1.0)));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> envelope_scale(const ScanLines& lines, const Settings& settings) {
  const std::vector<double> weights = beam_weights(settings);
  const int count = int(weights.size());
  // Sum of w_i w_j by distance in lines: the variance is then one short sum a sample.
  std::vector<double> overlap(weights.size(), 0.0);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) overlap[std::size_t(std::abs(i - j))] += weights[i] * weights[j];

  const std::size_t middle = lines.lines.size() / 2;
  std::vector<double> scale;
  for (int k = 0; k < lines.samples; ++k) {
    double spacing = 0;
    if (lines.lines.size() > 1) {
      const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm();
      const ScanLine& a = lines.lines[middle - 1];
      const ScanLine& b = lines.lines[middle];
      spacing = glm::distance(a.start + r * a.direction, b.start + r * b.direction);
    }
    double variance = 0;
    for (std::size_t d = 0; d < overlap.size(); ++d)
      variance += overlap[d] * interpolation_correlation(double(d) * spacing / settings.speckle_cell_mm);
    scale.push_back(1.0 / (kRayleighMean * std::sqrt(variance)));
  }
  return scale;
}

}  // namespace insonate
