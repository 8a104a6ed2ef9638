#include "tools/render_sweep.h"

#include <algorithm>
#include <cmath>

#include "sim/gl/volume_sweep.h"
#include "sim/model/noise.h"
#include "sim/reference/reference.h"

namespace insonate {
namespace {

// U (6) behind gain, of one plane at a time; not smoothed, as that is the picture's.
SweepValues echoes_on_lines(gl::Simulator& simulator, const Sweep& sweep, const Settings& settings) {
  const Image<double> noise = electronic_noise(scan_lines(sweep.probe, sweep.depth_mm, settings.samples), settings);
  const double noise_share = noise_level(settings), beside_share = clutter_share(settings);
  const double late = std::exp(-sweep.depth_mm / settings.samples / kClutterTail_mm);
  SweepValues echoes{settings.samples, sweep.probe.lines, {}};
  const std::size_t n = std::size_t(echoes.lines), d = std::size_t(echoes.samples);
  echoes.values.resize(sweep.patient_from_plane.size() * n * d);
  for (std::size_t plane = 0; plane < sweep.patient_from_plane.size(); ++plane) {
    simulator.set_pose(sweep.patient_from_plane[plane]);
    const Stages<float> stages = simulator.read_stages();
    const auto scattered = [&](int line, int k) {
      return settings.blend * stages.transmission.at(line, k) * stages.speckle.at(line, k);
    };
    double beside = 0;  // the scatterers' mean echo, as clutter_share() has it
    for (int k = 0; k < echoes.samples; ++k) {
      double mean = 0;
      for (int line = 0; line < echoes.lines; ++line) mean += scattered(line, k) / echoes.lines;
      beside = k == 0 ? mean : mean + (beside - mean) * late;
      for (int line = 0; line < echoes.lines; ++line) {
        const double heard = stages.reflection_beam.at(line, k) * stages.speckle.at(line, k) + scattered(line, k) +
                             stages.repeated.at(line, k) + (noise_share + beside_share * beside) * noise.at(line, k);
        echoes.values[(plane * n + std::size_t(line)) * d + std::size_t(k)] =
            float(heard * time_gain(settings, (k + 0.5) / echoes.samples));
      }
    }
  }
  return echoes;
}

}  // namespace

Volume<std::int16_t> render_sweep(gl::Simulator& simulator, const Sweep& sweep, const Settings& settings,
                                  const Grid& grid) {
  simulator.set_probe(sweep.probe, sweep.depth_mm);
  simulator.set_settings(settings);
  const SweepValues echoes = echoes_on_lines(simulator, sweep, settings);
  gl::VolumeSweep converter;
  const Volume<float> swept = gl::read_swept_volume(converter.convert(sweep, echoes, grid), grid);

  double level = settings.fixed_level;
  if (settings.reference_level == ReferenceLevel::frame_maximum) {
    level = 0;
    for (const float echo : swept.voxels)
      if (!std::isnan(echo)) level = std::max(level, double(echo));
  }
  Volume<std::int16_t> grey{grid, {}};
  grey.voxels.reserve(swept.voxels.size());
  for (const float echo : swept.voxels)
    grey.voxels.push_back(std::isnan(echo) ? std::int16_t(-1) : std::int16_t(grey_level(settings, echo, level)));
  return grey;
}

}  // namespace insonate
