#include <array>
#include <cstdio>

#include "sim/gl/headless_context.h"
#include "sim/imaging/sweep_simulator.h"
#include "sim/imaging/upload.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

constexpr int kPlanes = 64;

// Returns a grid of the requested number of voxels over all lines of the sweep.
Grid grid_over(const Sweep& sweep, const glm::ivec3& size) {
  Grid grid = sweep_grid(sweep, 1);
  grid.spacing = glm::dvec3(grid.size) / glm::dvec3(size);
  grid.size = size;
  return grid;
}

}  // namespace

Table measure_sweep(const Request& request) {
  constexpr std::array<const char*, 3> kMethods = {"moved", "scan converted", "gained"};
  Table table{{"device", "case", "view", "planes", "lines", "samples", "width", "height", "depth", "method", "frames",
               "q1_ms", "median_ms", "q3_ms"},
              {}};

  const gl::HeadlessContext context;
  tell_device();
  const std::vector<Configuration> sizes = configurations(request, {{128, 256, 128, 128}});
  for_each_scene(request, [&](const Scene& scene) {
    gl::SweepSimulator simulator;
    gl::upload_ct(scene.file, scene.volume.grid, [&] { simulator.set_volume(scene.volume, scene.table); });
    std::printf("\n%s, view %s, trainer's mode: a volume of %d planes, ms\n", scene.name.c_str(), scene.view.c_str(),
                kPlanes);
    std::printf("lines x samples  volume             what            median  (quartiles)\n");
    for (const Configuration& c : sizes) {
      Sweep sweep{scene.probe, scene.depth_mm, {}};
      sweep.probe.lines = c.lines;
      Settings settings = settings_of(scene, c, true);
      const glm::ivec3 size(c.width, c.height, c.width);
      Grid grid;
      const auto volume = [&] {
        simulator.set_sweep(sweep);
        simulator.set_settings(settings);
        simulator.set_grid(grid);
        simulator.volume();
      };
      // Cases: a moved probe, the same lines converted to another grid, and another gain.
      const auto times = alternating_times(scene.pose, request.frames,
                                           {[&](const Pose& pose) {
                                              sweep.patient_from_plane =
                                                  swept_planes(pose, kPlanes, kSwept_deg, kPivot_mm);
                                              grid = grid_over(sweep, size);
                                              volume();
                                            },
                                            [&](const Pose&) {
                                              grid.origin += grid.spacing / 2.0;
                                              volume();
                                            },
                                            [&](const Pose&) {
                                              settings.gain_db = 1 - settings.gain_db;
                                              volume();
                                            }});
      for (std::size_t i = 0; i < kMethods.size(); ++i) {
        const Spread ms = spread_of(times[i]);
        std::printf("%4d x %-4d      %4d x %d x %-6d %-14s %7.1f  (%.1f to %.1f)\n", c.lines, c.samples, size.x, size.y,
                    size.z, kMethods[i], ms.median, ms.first_quartile, ms.third_quartile);
        table.rows.push_back({gl::device_description(), scene.name, scene.view, std::to_string(kPlanes),
                              std::to_string(c.lines), std::to_string(c.samples), std::to_string(size.x),
                              std::to_string(size.y), std::to_string(size.z), kMethods[i],
                              std::to_string(request.frames), cell_of(ms.first_quartile, 4), cell_of(ms.median, 4),
                              cell_of(ms.third_quartile, 4)});
      }
    }
  });
  return table;
}

}  // namespace insonate::bench
