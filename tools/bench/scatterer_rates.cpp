#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/model/beam.h"
#include "sim/model/waves.h"
#include "sim/reference/wave_reference.h"
#include "tools/bench/acoustics.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

AcousticVolume liver_block() {
  AcousticVolume volume;
  volume.grid.size = {2, 2, 2};
  volume.grid.spacing = glm::dvec3(1000);
  volume.grid.origin = {-500, 0, -500};
  volume.voxels.assign(volume.grid.count(), {60, 0});
  return volume;
}

/// Returns how many scatterers lie in the slice between the lines' ends.
double scatterers_in_slice(const ScanLines& lines, const Settings& settings) {
  double volume = 0;
  for (int k = 0; k < lines.samples; ++k) {
    const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm();
    const double spacing = lines.fan.step * (lines.fan.face == LineFan::Face::parallel ? 1 : lines.fan.apex_mm + r);
    volume +=
        lines.dr_mm() * spacing * double(lines.lines.size()) * 2 * kSliceHalf * slice_thickness_at_mm(settings, r);
  }
  const double pitch = scatterer_pitch_mm(lines, settings);
  return volume / (pitch * pitch * pitch);
}

double median_s(int times, const std::function<void(int)>& work) {
  std::vector<double> spent;
  for (int i = 0; i < times; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work(i);
    spent.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return spread_of(spent).median;
}

}  // namespace

Table measure_scatterer_rates() {
  constexpr int kFrames = 15, kSums = 3;
  Table table{{"probe", "scatterers", "live_ms", "live_per_s", "direct_ms", "direct_per_s", "ratio"}, {}};
  const gl::HeadlessContext context;
  tell_device();
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  std::printf(
      "Scatterers a second: of the live stages on the lines, tissue included, and of the direct sum of the same field "
      "in "
      "double precision, without it\n%-12s %11s %9s %12s %10s %12s %7s\n",
      "probe", "scatterers", "live ms", "a second", "direct ms", "a second", "ratio");
  for (const Probe& probe : probes()) {
    const Settings settings = trainer_settings(probe.frequency_mhz, probe.depth_mm);
    const ScanLines lines = scan_lines(probe, probe.depth_mm, settings.samples);
    const auto pose_of = [](int i) {
      Pose pose;
      pose.translation = {0.37 * i, 30, 0.21 * i};
      return pose;
    };
    gl::Simulator simulator;
    simulator.set_volume(liver_block(), tissues);
    simulator.set_probe(probe, probe.depth_mm);
    simulator.set_settings(settings);
    const auto frame = [&](int i) {
      simulator.set_pose(pose_of(i));
      simulator.run_through(gl::Stage::beam);
      glFinish();
    };
    frame(-1);  // compiles
    const double count = scatterers_in_slice(lines, settings), live = median_s(kFrames, frame),
                 direct = median_s(kSums, [&](int i) {
                   const volatile double sum =
                       wave_reference(scatterers_reference(lines, settings, pose_of(i)), lines, settings)
                           .at(0, 0)
                           .real();
                   static_cast<void>(sum);
                 });
    std::printf("%-12s %11.0f %9.2f %12.3g %10.0f %12.3g %7.0f\n", probe.name.c_str(), count, 1e3 * live, count / live,
                1e3 * direct, count / direct, direct / live);
    table.rows.push_back({probe.name, cell_of(count, 0), cell_of(1e3 * live, 3), cell_of(count / live, 0),
                          cell_of(1e3 * direct, 1), cell_of(count / direct, 0), cell_of(direct / live, 1)});
  }
  return table;
}

}  // namespace insonate::bench
