#include "sim/model/waves.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

#include "sim/core/hash.h"
#include "sim/model/beam.h"
#include "sim/model/scatterers.h"

namespace insonate {
namespace {

constexpr double kMaxCells = 1 << 22, kMaxInBin = 64;

// Returns the distance between neighbouring lines, perpendicular to them, mm.
double spacing_mm(const ScanLines& lines, double r_mm) {
  const LineFan& fan = lines.fan;
  const double cosine = std::cos(fan.steering);
  return fan.face == LineFan::Face::parallel ? fan.step * cosine : fan.step * (fan.apex_mm * cosine + r_mm);
}

double depth_mm(const ScanLines& lines, int k) {
  return lines.r_min_mm + (k + 0.5) * lines.dr_mm();
}

// Returns the variance of the sum of two neighbours' weights w, for numbers that linear weights have spread over the
// places nearest to them: these have a variance of 2/3, and neighbours a covariance of 1/6.
double variance_of(const std::vector<double>& w) {
  double variance = 0;
  for (std::size_t i = 0; i < w.size(); ++i)
    variance += w[i] * w[i] * 2 / 3 + (i + 1 < w.size() ? 2 * w[i] * w[i + 1] / 6 : 0);
  return variance;
}

// Returns the integral of v^2 over the distance from the imaging plane, mm.
double window_energy_mm(const Settings& settings, double r_mm) {
  return 256.0 / 315.0 * kSliceHalf * slice_thickness_at_mm(settings, r_mm);
}

// Returns the volume between two neighbouring lines and samples, weighted by v^2, mm^3.
double bin_volume(const ScanLines& lines, const Settings& settings, double r_mm) {
  return lines.dr_mm() * spacing_mm(lines, r_mm) * window_energy_mm(settings, r_mm);
}

double most_bin_volume(const ScanLines& lines, const Settings& settings) {
  return std::max(bin_volume(lines, settings, depth_mm(lines, 0)),
                  bin_volume(lines, settings, depth_mm(lines, lines.samples - 1)));
}

}  // namespace

double scatterer_pitch_mm(const ScanLines& lines, const Settings& settings) {
  const double middle = (lines.r_min_mm + lines.r_max_mm) / 2, length = lines.r_max_mm - lines.r_min_mm;
  const double slice =
      2 * kSliceHalf *
      std::max(slice_thickness_at_mm(settings, lines.r_min_mm), slice_thickness_at_mm(settings, lines.r_max_mm));
  const double volume = double(lines.lines.size()) * spacing_mm(lines, middle) * length * slice;
  const double in_bin = most_bin_volume(lines, settings);
  return std::max({settings.speckle_cell_mm, std::cbrt(volume / kMaxCells), std::cbrt(in_bin / kMaxInBin)});
}

glm::dmat4 cells_from_patient(double pitch_mm) {
  return glm::scale(glm::dmat4(1.0), glm::dvec3(ScattererLattice::kSide)) * lattice_from_patient(pitch_mm);
}

Scatterer scatterer_of(const glm::ivec3& cell, std::uint32_t seed) {
  std::uint32_t key = hash(seed);
  for (int axis = 0; axis < 3; ++axis) key += std::uint32_t(cell[axis]) * kCellKeys[std::size_t(axis)];
  const std::uint32_t h = hash(key);
  const auto share = [&](int lowest_bit) { return (double(h >> lowest_bit & 1023u) + 0.5) / 1024.0; };
  const bool imaginary = h >> 30 & 1u;
  const double size = h >> 31 ? -1 : 1;
  return {{share(0), share(10), share(20)}, {imaginary ? 0 : size, imaginary ? size : 0}};
}

double slice_window(double z_mm, double thickness_mm) {
  const double share = z_mm / (kSliceHalf * thickness_mm);
  const double v = std::max(1 - share * share, 0.0);
  return v * v;
}

std::vector<double> pulse_weights(const ScanLines& lines, const Settings& settings) {
  const double of_fwhm = 1 / std::sqrt(8 * std::log(2.0));
  const double sigma = of_fwhm * settings.reflection_length_mm / lines.dr_mm(), variance = sigma * sigma - 1.0 / 6.0;
  if (variance <= 0) return {1.0};
  const int radius = std::min(int(std::ceil(3 * std::sqrt(variance))), kMaxPulseRadius);
  std::vector<double> weights;
  double sum = 0;
  for (int m = -radius; m <= radius; ++m) sum += weights.emplace_back(std::exp(-0.5 * m * m / variance));
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> scatterer_scale(const ScanLines& lines, const Settings& settings) {
  const std::vector<double> sigma = focused_beam_sigma(lines, settings);
  const double along = variance_of(pulse_weights(lines, settings));
  const double cell = std::pow(scatterer_pitch_mm(lines, settings), 3);
  std::vector<double> scale;
  for (int k = 0; k < lines.samples; ++k) {
    const double across = variance_of(beam_weights_at(settings, sigma[std::size_t(k)]));
    scale.push_back(std::sqrt(cell / (along * across * bin_volume(lines, settings, depth_mm(lines, k)))));
  }
  return scale;
}

double scatterer_rms(const ScanLines& lines, const Settings& settings) {
  return std::sqrt(most_bin_volume(lines, settings) / std::pow(scatterer_pitch_mm(lines, settings), 3)) * 2 / 3;
}

double ring_down_at(const Settings& settings, double r_mm) {
  if (!settings.waves) return 0;
  const double lambda = 1.54 / settings.frequency_mhz;
  return settings.ring_down * std::sqrt(settings.fixed_level) * std::pow(10.0, -r_mm / (kRingDownWavelengths * lambda));
}

}  // namespace insonate
