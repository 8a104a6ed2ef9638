#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

constexpr int kTissue_hu = 60, kGas_hu = -1000, kBone_hu = 1500;
constexpr double kVoxel_mm = 0.1, kDepth_mm = 160;
constexpr int kVoxelsALayer = 10;  // so that each face of a layer is a separate interface at l = 0.6 mm

/// Returns the fraction of I behind an interface (1).
double passed(const TissueTable& table, int one, int other) {
  const double z1 = table.at(one).impedance_mrayl, z2 = table.at(other).impedance_mrayl;
  return 4 * z1 * z2 / ((z1 + z2) * (z1 + z2));
}

/// A sequence of strong layers, followed by a thousand weak ones. Gas and bone reduce I until its square, which R and T
/// hold, is below the normal numbers of single precision, but not so far that a line ends.
AcousticVolume layered(const TissueTable& table, bool shadowed) {
  std::vector<int> layers;
  constexpr double kLeft = 4e-20;
  double left = 1;
  for (const int hu : {kGas_hu, kBone_hu})
    for (const double both = std::pow(passed(table, kTissue_hu, hu), 2); left * both > kLeft; left *= both)
      layers.insert(layers.end(), {kTissue_hu, shadowed ? hu : kTissue_hu});
  AcousticVolume volume;
  volume.grid.size = {2, int(kDepth_mm / kVoxel_mm) + 1, 2};
  volume.grid.spacing = {100, kVoxel_mm, 100};
  volume.grid.origin = {-50, 0, -50};
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < volume.grid.size.y; ++y)
      for (int x = 0; x < 2; ++x) {
        const std::size_t layer = std::size_t(y / kVoxelsALayer);
        const int hu = layer < layers.size() ? layers[layer] : kTissue_hu + y % 2;
        volume.voxels.push_back({std::int16_t(hu), 0});
      }
  return volume;
}

}  // namespace

Table measure_denormals(const Request& request) {
  Table table{{"device", "case", "frames", "q1_ms", "median_ms", "q3_ms", "faintest", "denormal"}, {}};
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  const gl::HeadlessContext context;
  tell_device();

  const Probe& probe = *find_probe("linear");
  Settings settings = trainer_settings(3.5, kDepth_mm);
  settings.gel_mm = 0;
  // Disables everything that would end the line, hide the rest, or take its own time for gas and bone.
  settings.absorption = settings.electronic_noise = settings.clutter = settings.reverberation = false;
  settings.face_reflection = 0;
  const char* const kCases[] = {"tissue", "behind gas and bone"};
  std::vector<gl::Simulator> simulators;
  std::vector<std::function<void(const Pose&)>> frames;
  for (const bool shadowed : {false, true}) {
    gl::Simulator simulator;
    simulator.set_volume(layered(tissues, shadowed), tissues);
    simulator.set_probe(probe, kDepth_mm);
    simulator.set_settings(settings);
    simulators.push_back(std::move(simulator));
  }
  for (gl::Simulator& simulator : simulators)
    frames.push_back([&](const Pose& pose) {
      simulator.set_pose(pose);
      simulator.image();
    });
  const auto times = alternating_times({}, request.frames, frames);
  double tissue_ms = 0;
  for (std::size_t i = 0; i < simulators.size(); ++i) {
    const Spread ms = spread_of(times[i]);
    simulators[i].set_pose({});
    const Stages<float> stages = simulators[i].read_stages();
    long denormal = 0;
    for (const auto* stage : {&stages.intensity, &stages.reflection, &stages.reflection_beam, &stages.transmission,
                              &stages.repeated, &stages.speckle, &stages.scattered, &stages.echo_re, &stages.echo_im,
                              &stages.wave_re, &stages.wave_im, &stages.fused})
      denormal += std::ranges::count_if(stage->pixels, [](float v) { return std::fpclassify(v) == FP_SUBNORMAL; });
    double faintest = 1;
    for (const float intensity : stages.intensity.pixels)
      if (intensity > 0) faintest = std::min(faintest, double(intensity));
    if (i == 0) tissue_ms = ms.median;
    std::printf("%-20s  %8.2f ms (%.2f to %.2f), %.2f of tissue's; least I %.0e, %ld denormal numbers between stages\n",
                kCases[i], ms.median, ms.first_quartile, ms.third_quartile, ms.median / tissue_ms, faintest, denormal);
    table.rows.push_back({gl::device_description(), kCases[i], std::to_string(request.frames),
                          cell_of(ms.first_quartile, 4), cell_of(ms.median, 4), cell_of(ms.third_quartile, 4),
                          cell_of(faintest, 25), std::to_string(denormal)});
  }
  return table;
}

}  // namespace insonate::bench
