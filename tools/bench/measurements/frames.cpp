#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <numeric>

#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

// In the order of gl::Stage.
constexpr std::array<const char*, gl::kStageCount> kStages = {"traverse", "beam",     "scan_convert", "smooth",
                                                              "fuse",     "compress", "enhance"};

long runs_in_all(const gl::Simulator& simulator) {
  return std::accumulate(simulator.runs().begin(), simulator.runs().end(), 0L);
}

/// Returns the median time of each stage in ms, waiting for the device after each stage.
std::array<double, gl::kStageCount> stage_times(gl::Simulator& simulator, const Pose& start, int frames) {
  std::array<std::vector<double>, gl::kStageCount> times;
  for (int frame = 0; frame < frames; ++frame) {
    simulator.set_pose(wandering(start, frame));
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      simulator.run_through(gl::Stage(i));
      glFinish();
      times[i].push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
  }
  std::array<double, gl::kStageCount> medians;
  std::transform(times.begin(), times.end(), medians.begin(), [](const auto& t) { return spread_of(t).median; });
  return medians;
}

}  // namespace

Table measure_frames(const Request& request) {
  // The trainer's own configuration comes first.
  std::vector<Configuration> usual = {{192, 512, 512, 512}};
  usual.insert(usual.end(), kPaperConfigurations.begin(), kPaperConfigurations.end());
  const std::vector<Configuration> sizes = configurations(request, usual);

  Table table{{"device", "case", "view", "mode", "lines", "samples", "width", "height", "frames", "q1_ms", "median_ms",
               "q3_ms", "runs_still"},
              {}};
  for (const char* stage : kStages) table.columns.push_back(std::string(stage) + "_ms");

  const gl::HeadlessContext context;
  tell_device();
  Request with_structure = request;
  with_structure.structure = true;
  for_each_scene(with_structure, [&](const Scene& scene) {
    gl::Simulator simulator;
    gl::upload_ct(scene.file, scene.volume.grid, [&] { simulator.set_volume(scene.volume, scene.table); });
    for (const std::string mode : {"paper", "trainer", "machine"}) {
      std::printf("\n%s, view %s, %s's mode: a frame with a moving probe, ms\n", scene.name.c_str(), scene.view.c_str(),
                  mode.c_str());
      std::printf("lines x samples  picture       median  (quartiles)        stages of a still frame  each stage\n");
      Probe probe = scene.probe;
      for (const Configuration& c : sizes) {
        probe.lines = c.lines;
        simulator.set_probe(probe, scene.depth_mm);
        const Settings settings = settings_of(scene, c, mode != "paper");
        simulator.set_settings(mode == "machine" ? with_usual_display(settings) : settings);
        const auto frame = [&](const Pose& pose) {
          simulator.set_pose(pose);
          simulator.image_in_motion();
        };
        const Spread ms = spread_of(alternating_times(scene.pose, request.frames, {frame}).front());
        const long before = runs_in_all(simulator);
        simulator.image();
        const long still = runs_in_all(simulator) - before;
        // Of several looks, the stages on the lines run in turn, and cannot be timed one by one.
        const auto stages = mode == "machine" ? std::array<double, gl::kStageCount>{}
                                              : stage_times(simulator, scene.pose, request.frames);

        std::printf("%4d x %-4d      %4d x %-4d  %7.2f  (%.2f to %.2f)  %8ld   ", c.lines, c.samples, c.width, c.height,
                    ms.median, ms.first_quartile, ms.third_quartile, still);
        std::vector<std::string> row = {gl::device_description(),
                                        scene.name,
                                        scene.view,
                                        mode,
                                        std::to_string(c.lines),
                                        std::to_string(c.samples),
                                        std::to_string(c.width),
                                        std::to_string(c.height),
                                        std::to_string(request.frames),
                                        cell_of(ms.first_quartile, 4),
                                        cell_of(ms.median, 4),
                                        cell_of(ms.third_quartile, 4),
                                        std::to_string(still)};
        for (std::size_t i = 0; i < stages.size(); ++i) {
          if (stages[i] >= 0.005) std::printf(" %s %.2f", kStages[i], stages[i]);
          row.push_back(cell_of(stages[i], 4));
        }
        std::printf("\n");
        table.rows.push_back(std::move(row));
      }
    }
  });
  return table;
}

}  // namespace insonate::bench
