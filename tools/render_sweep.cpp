#include "tools/render_sweep.h"

#include <algorithm>
#include <cmath>

#include "sim/gl/volume_sweep.h"
#include "sim/model/noise.h"
#include "sim/reference/reference.h"

namespace insonate {
namespace {

// U (6) behind gain, of one plane at a time.
SweepValues echoes_on_lines(gl::Simulator& simulator, const Sweep& sweep, const Settings& settings) {
  const Image<double> noise = electronic_noise(scan_lines(sweep.probe, sweep.depth_mm, settings.samples), settings);
  const double noise_share = noise_level(settings);
  SweepValues echoes{settings.samples, sweep.probe.lines, {}};
  for (const Pose& patient_from_plane : sweep.patient_from_plane) {
    simulator.set_pose(patient_from_plane);
    const Stages<float> stages = simulator.read_stages();
    for (int line = 0; line < echoes.lines; ++line)
      for (int k = 0; k < echoes.samples; ++k) {
        const double echo = stages.reflection_beam.at(line, k) + settings.blend * stages.transmission.at(line, k);
        const double heard = echo * stages.speckle.at(line, k) + noise_share * noise.at(line, k);
        echoes.values.push_back(float(heard * time_gain(settings, (k + 0.5) / echoes.samples)));
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
