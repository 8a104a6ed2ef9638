#include "sim/acoustics/speckle_sample.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "sim/acoustics/beam_profile.h"
#include "sim/acoustics/echo_lines.h"
#include "sim/acoustics/scenes.h"

namespace insonate {
namespace {

constexpr double kMargin = 1.5, kApart = 1.5;  // axial widths

// Returns how much the logarithm of the envelope's root mean square rises per sample, by least squares.
double log_slope(const std::vector<std::vector<double>>& envelopes) {
  double count = 0, sum_k = 0, sum_kk = 0, sum_y = 0, sum_ky = 0;
  for (std::size_t k = 0; k < envelopes[0].size(); ++k) {
    double square = 0;
    for (const std::vector<double>& envelope : envelopes) square += envelope[k] * envelope[k];
    if (square == 0) continue;
    const double at = double(k), y = std::log(square) / 2;
    count += 1;
    sum_k += at;
    sum_kk += at * at;
    sum_y += y;
    sum_ky += at * y;
  }
  const double spread = count * sum_kk - sum_k * sum_k;
  return spread > 0 ? (count * sum_ky - sum_k * sum_y) / spread : 0;
}

}  // namespace

SpeckleSample sample_speckle(const Transducer& transducer, const Beamforming& beamforming, double per_cell, int lines,
                             double cells) {
  const ScanLine line = line_at(transducer, 0);
  const double focus = beamforming.transmit_focus_mm;
  const BeamProfile cell = beam_profile(transducer, beamforming, line, focus);
  const ScanBeam beam(transducer, beamforming, line);
  const Pulse pulse(transducer);
  const double half = cells * cell.axial_mm, outer = half + kMargin * cell.axial_mm;
  const SceneBox box{glm::dvec3(-cell.lateral_mm, focus - outer, -cell.elevation_mm),
                     glm::dvec3(cell.lateral_mm, focus + outer, cell.elevation_mm)};

  std::vector<std::vector<double>> envelopes(std::size_t(lines), std::vector<double>{});
  tbb::parallel_for(0, lines, [&](int i) {
    const std::vector<PointScatterer> block =
        uniform_block(box, per_cell / cell_volume_mm3(cell), std::uint32_t(i + 1));
    envelopes[std::size_t(i)] = echo_line(beam, pulse, block, focus - half, focus + half).envelope();
  });

  const double step_mm = beamforming.sampling.step_us() * beamforming.sampling.speed_mm_us / 2;
  const auto apart = std::size_t(std::ceil(kApart * cell.axial_mm / step_mm));
  const double slope = log_slope(envelopes);
  SpeckleSample sample;
  for (const std::vector<double>& envelope : envelopes)
    for (std::size_t k = 0; k < envelope.size(); ++k) {
      sample.all.push_back(envelope[k] * std::exp(-slope * double(k)));
      if (k % apart == 0) sample.independent.push_back(sample.all.back());
    }
  return sample;
}

}  // namespace insonate
