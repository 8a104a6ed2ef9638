#include "sim/model/beam.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace insonate {
namespace {

double window(BeamWindow shape, double t) {  // t is in (-1, 1) across the aperture
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

// Returns the cubic B-spline relative to its value at 0: the autocorrelation of the hat function.
double interpolation_correlation(double cells) {
  const double d = std::abs(cells);
  if (d >= 2) return 0;
  if (d >= 1) return (2 - d) * (2 - d) * (2 - d) / 4;
  return 1 - 1.5 * d * d + 0.75 * d * d * d;
}

// Returns the distance between the two middle lines, mm; 0 for a single line.
double line_spacing_mm(const ScanLines& lines, double r_mm) {
  if (lines.lines.size() < 2) return 0;
  const std::size_t middle = lines.lines.size() / 2;
  const ScanLine& a = lines.lines[middle - 1];
  const ScanLine& b = lines.lines[middle];
  return glm::distance(a.start + r_mm * a.direction, b.start + r_mm * b.direction);
}

std::vector<double> with_sum_1(std::vector<double> weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

// Mean magnitude of a complex number whose parts are normal with variance 1 (Rayleigh).
const double kRayleighMean = std::sqrt(glm::pi<double>() / 2);

}  // namespace

std::vector<double> beam_weights(const Settings& settings) {
  const int half = (settings.beam_lines - 1) / 2;
  std::vector<double> weights;
  for (int j = -half; j <= half; ++j) weights.push_back(window(settings.beam_window, j / (half + 1.0)));
  return with_sum_1(std::move(weights));
}

double focused_beam_fwhm_mm(const Settings& settings, double aperture_mm, double r_mm) {
  constexpr double kOfSincSquared = 0.8859;  // full width at half maximum of sinc^2
  const double lambda = 1.54 / settings.frequency_mhz;
  const auto width = [&](double distance_mm) {
    return kOfSincSquared * lambda * std::max(settings.f_number, distance_mm / aperture_mm);
  };
  const double waist = width(settings.focus_mm), spread = 2 * std::log(2.0) * lambda / (glm::pi<double>() * waist);
  const double sent = std::hypot(waist, (r_mm - settings.focus_mm) * spread);
  return 1 / std::hypot(1 / sent, 1 / width(r_mm));
}

std::vector<double> focused_beam_sigma(const ScanLines& lines, const Settings& settings) {
  const double of_fwhm = 1 / std::sqrt(8 * std::log(2.0));
  std::vector<double> sigma;
  for (int k = 0; k < lines.samples; ++k) {
    const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm(), spacing = line_spacing_mm(lines, r);
    double of_window = spacing > 0 ? of_fwhm * focused_beam_fwhm_mm(settings, lines.aperture_mm, r) / spacing : 0;
    // Waves add up as amplitudes, whose width is 2^(1/2) times that of a Gaussian intensity. The linear weights that
    // place scatterers between lines (waves.h) have a variance of 1/6 of it already.
    if (settings.waves) of_window = std::sqrt(std::max(2 * of_window * of_window - 1.0 / 6.0, 0.0));
    sigma.push_back(std::min(of_window, kMaxFocusedRadius / 3.0));
  }
  return sigma;
}

int focused_radius(double sigma_lines) {
  return int(3 * sigma_lines + 1e-9);
}

std::vector<double> beam_weights_at(const Settings& settings, double sigma_lines) {
  if (!settings.focused_beam) return beam_weights(settings);
  const int radius = focused_radius(sigma_lines);
  std::vector<double> weights;
  for (int j = -radius; j <= radius; ++j)
    weights.push_back(j == 0 ? 1 : std::exp(-0.5 * j * j / (sigma_lines * sigma_lines)));
  return with_sum_1(std::move(weights));
}

bool has_slice(const Settings& settings) {
  return settings.slice_planes > 1 || settings.waves;
}

bool has_elevation_focus(const Settings& settings) {
  return has_slice(settings) && settings.elevation_focus_mm > 0;
}

double slice_spread(const Settings& settings) {
  if (settings.elevation_focus_mm == 0) return 0;
  return std::log(2.0) * 1.54 / settings.frequency_mhz / (glm::pi<double>() * settings.slice_thickness_mm);
}

double slice_thickness_at_mm(const Settings& settings, double r_mm) {
  return std::hypot(settings.slice_thickness_mm, (r_mm - settings.elevation_focus_mm) * slice_spread(settings));
}

std::vector<SlicePlane> slice_planes(const Settings& settings) {
  const int count = settings.slice_planes;
  const double sigma = 1 / std::sqrt(8 * std::log(2.0)), between = 4.0 / count;
  std::vector<SlicePlane> planes;
  planes.resize(std::size_t(count));
  for (std::size_t line = 0; line < 2; ++line) {
    const double moved = settings.waves && count > 1 ? between * (line == 0 ? -0.25 : 0.25) : 0;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
      const double offset = between * (i + 0.5) - 2 + moved;
      SlicePlane::Place& place = planes[std::size_t(i)].places[line];
      const int from_middle = i - count / 2;
      const double lateral = settings.waves && from_middle % 2 != 0 ? std::copysign(0.5, from_middle) : 0;
      place = {sigma * offset, std::exp(-0.5 * offset * offset), lateral};
      sum += place.weight;
    }
    for (SlicePlane& plane : planes) plane.places[line].weight /= sum;
  }
  return planes;
}

ScanLine line_beside(const ScanLines& lines, std::size_t line, double share) {
  const ScanLine& here = lines.lines[line];
  if (share == 0 || lines.lines.size() == 1) return here;
  const bool has_next = share > 0 ? line + 1 < lines.lines.size() : line > 0;
  const bool after = has_next == (share > 0);
  const ScanLine& other = lines.lines[after ? line + 1 : line - 1];
  const double towards = has_next ? std::abs(share) : -std::abs(share);
  return {here.start + towards * (other.start - here.start),
          glm::normalize(here.direction + towards * (other.direction - here.direction))};
}

std::vector<double> envelope_scale(const ScanLines& lines, const Settings& settings) {
  const std::vector<double> sigma = focused_beam_sigma(lines, settings);
  std::vector<double> weights = beam_weights(settings);
  const std::vector<SlicePlane> planes = slice_planes(settings);
  const auto of_planes = [&](double r) {  // variance of the sum over the planes
    const double cells = slice_thickness_at_mm(settings, r) / settings.speckle_cell_mm;
    double variance = 0;
    for (const SlicePlane& a : planes)
      for (const SlicePlane& b : planes)
        variance += a.of_line(0).weight * b.of_line(0).weight *
                    interpolation_correlation((a.of_line(0).offset - b.of_line(0).offset) * cells);
    return variance;
  };
  std::vector<double> scale;
  for (int k = 0; k < lines.samples; ++k) {
    if (settings.focused_beam) weights = beam_weights_at(settings, sigma[std::size_t(k)]);
    const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm(), spacing = line_spacing_mm(lines, r);
    double variance = 0;
    for (std::size_t d = 0; d < weights.size(); ++d) {
      const double correlation = interpolation_correlation(double(d) * spacing / settings.speckle_cell_mm);
      if (correlation == 0) break;  // all farther lines have correlation 0 too
      double overlap = 0;
      for (std::size_t i = d; i < weights.size(); ++i) overlap += weights[i] * weights[i - d];
      variance += (d == 0 ? 1 : 2) * overlap * correlation;
    }
    scale.push_back(1.0 / (kRayleighMean * std::sqrt(variance * of_planes(r))));
  }
  return scale;
}

}  // namespace insonate
