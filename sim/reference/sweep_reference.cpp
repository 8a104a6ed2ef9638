#include "sim/reference/sweep_reference.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "sim/model/noise.h"
#include "sim/model/waves.h"
#include "sim/reference/clutter_reference.h"
#include "sim/reference/display_reference.h"

namespace insonate {
namespace {

// Positions beyond the outer lines and samples, up to half a step to the fan's edges, take their values.
double bilinear(const SweepValues& values, int plane, double line, double sample) {
  line = std::clamp(line, 0.0, values.lines - 1.0);
  sample = std::clamp(sample, 0.0, values.samples - 1.0);
  const auto at = [&](double i, double k) {
    const std::size_t row = std::size_t(plane) * std::size_t(values.lines) + std::size_t(i);
    return values.values[row * std::size_t(values.samples) + std::size_t(k)];
  };
  const double i = std::floor(line), k = std::floor(sample), fi = line - i, fk = sample - k;
  const double next_i = std::min(i + 1, values.lines - 1.0), next_k = std::min(k + 1, values.samples - 1.0);
  return (1 - fi) * ((1 - fk) * at(i, k) + fk * at(i, next_k)) +
         fi * ((1 - fk) * at(next_i, k) + fk * at(next_i, next_k));
}

// Appends U (6) at each sample of a plane to the values.
void append_fused(SweepValues& values, const Stages<double>& stages, const Image<std::complex<double>>& noise,
                  int plane, const ScanLines& lines, const Settings& settings) {
  const auto scattered_at = [&](int line, int k) {
    return settings.waves ? stages.scattered.at(line, k)
                          : settings.blend * stages.transmission.at(line, k) * stages.speckle.at(line, k);
  };
  const double tail = std::exp(-lines.dr_mm() / kClutterTail_mm);
  const WallClutter wall_clutter = wall_clutter_reference(stages, lines, settings);
  std::vector<double> beside;  // the noise's mean at each depth
  double late = 0;
  for (int k = 0; k < values.samples; ++k) {
    double mean = 0;
    for (int line = 0; line < values.lines; ++line) mean += scattered_at(line, k) / values.lines;
    late = k == 0 ? mean : mean + (late - mean) * tail;
    beside.push_back(noise_level(settings) + clutter_share(settings) * late);
  }
  for (int line = 0; line < values.lines; ++line)
    for (int k = 0; k < values.samples; ++k) {
      const double power = beside[std::size_t(k)] + wall_clutter.at(line, k);
      const std::complex<double> of_receiver = noise.at(noise_line(line, plane, values.lines), k);
      double fused = stages.repeated.at(line, k);
      if (settings.waves)
        fused += std::norm(
            std::complex<double>(stages.wave_re.at(line, k) + ring_down_at(settings, (k + 0.5) * lines.dr_mm()),
                                 stages.wave_im.at(line, k)) +
            std::sqrt(power) * of_receiver);
      else
        fused += stages.reflection_beam.at(line, k) * stages.speckle.at(line, k) + scattered_at(line, k) +
                 power * of_receiver.real();
      values.values.push_back(settings.waves ? heard(fused) : fused);
    }
}

}  // namespace

Volume<double> convert_sweep_reference(const Sweep& sweep, const SweepValues& values, const Grid& grid) {
  const double dr = sweep.depth_mm / values.samples;
  Volume<double> volume{grid, std::vector<double>(grid.count(), std::numeric_limits<double>::quiet_NaN())};
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const auto position = sweep_position(sweep, grid.patient_from_index({i, j, k}));
        if (!position) continue;
        const auto in = [&](int plane, const LinePosition& at) {
          return bilinear(values, plane, at.line, at.r_mm / dr - 0.5);
        };
        volume.at({i, j, k}) = (1 - position->share) * in(position->plane, position->in_this) +
                               position->share * in(position->plane + 1, position->in_next);
      }
  return volume;
}

ReferenceVolume simulate_sweep_reference(const MediumField& field, const TissueTable& table, const Sweep& sweep,
                                         const Settings& settings, const Grid& grid) {
  const ScanLines lines = scan_lines(sweep.probe, sweep.depth_mm, settings.samples);
  Image<std::complex<double>> noise = noise_wave(lines, settings);
  if (!settings.waves) std::ranges::copy(electronic_noise(lines, settings).pixels, noise.pixels.begin());
  Settings without_picture = settings;
  without_picture.image_width = without_picture.image_height = 1;
  SweepValues fused{settings.samples, sweep.probe.lines, {}};
  for (std::size_t i = 0; i < sweep.patient_from_plane.size(); ++i) {
    const Stages<double> stages =
        simulate_reference(field, table, sweep.probe, sweep.depth_mm, without_picture, sweep.patient_from_plane[i]);
    append_fused(fused, stages, noise, int(i), lines, settings);
  }

  ReferenceVolume volume{convert_sweep_reference(sweep, fused, grid), {grid, {}}};
  std::vector<double> gained;
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const auto at = sweep_position(sweep, grid.patient_from_index({i, j, k}));
        if (!at) {
          gained.push_back(-1);
          continue;
        }
        const double r_mm = (1 - at->share) * at->in_this.r_mm + at->share * at->in_next.r_mm;
        gained.push_back(heard(volume.fused.at({i, j, k})) * time_gain(settings, r_mm / sweep.depth_mm));
      }
  const double level = settings.reference_level == ReferenceLevel::fixed
                           ? settings.fixed_level
                           : *std::max_element(gained.begin(), gained.end());
  for (const double echo : gained)
    volume.grey.voxels.push_back(echo < 0 ? std::int16_t(-1) : std::int16_t(grey_level(settings, echo, level)));
  return volume;
}

}  // namespace insonate
