#include <array>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "sim/gl/headless_context.h"
#include "sim/imaging/line_stages.h"
#include "sim/imaging/stage_tables.h"
#include "sim/imaging/upload.h"
#include "sim/probe/sweep.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

/// Lines that are traversed in one dispatch.
struct LineSet {
  int planes, lines, samples;
};

/// Returns the line sets of the trainer's picture and of the paper's. Adds sweeps with enough lines to fill a graphics
/// card.
std::vector<LineSet> line_sets(const Request& request) {
  const std::vector<Configuration> usual = {
      {192, 512, 512, 512}, {256, 256, 256, 256}, {512, 512, 512, 512}, {1024, 1024, 1024, 1024}};
  std::vector<LineSet> sets;
  for (const Configuration& c : configurations(request, usual)) sets.push_back({1, c.lines, c.samples});
  if (!request.configurations.empty()) return sets;
  for (const int planes : {16, 64}) sets.push_back({planes, 128, 256});
  if (!gl::is_software_renderer()) sets.push_back({256, 128, 256});
  return sets;
}

/// One of the two work divisions.
struct Method {
  const char* name;
  gl::LineStages stages;
};

Method method(const char* name, std::size_t lines_that_fill) {
  gl::WorkDivision division = gl::WorkDivision::of_device();
  division.lines_that_fill = lines_that_fill;
  return {name, gl::LineStages({}, division)};
}

void tell_choice(const gl::WorkDivision& division) {
  if (division.lines_that_fill == 0)
    std::printf("of this device: a line an invocation, %d a group\n", division.group);
  else
    std::printf("of this device: a line a group of %d, from %zu lines on a line an invocation\n", division.group,
                division.lines_that_fill);
}

}  // namespace

Table measure_work_divisions(const Request& request) {
  Table table{{"device", "case", "view", "mode", "planes", "lines", "samples", "method", "group", "frames", "q1_ms",
               "median_ms", "q3_ms", "evaluated", "possible"},
              {}};
  const gl::HeadlessContext context;
  tell_device();
  const gl::WorkDivision own = gl::WorkDivision::of_device();
  tell_choice(own);
  std::array methods = {method("invocation", 0), method("group", std::numeric_limits<std::size_t>::max())};
  for_each_scene(request, [&](const Scene& scene) {
    gl::DeviceVolume volume;
    gl::upload_ct(scene.file, scene.volume.grid, [&] { volume = gl::DeviceVolume(scene.volume, scene.table); });
    for (const bool trainer : {false, true}) {
      const char* mode = trainer ? "trainer" : "paper";
      std::printf("\n%s, view %s, %s's mode: traversal with a moving probe, ms\n", scene.name.c_str(),
                  scene.view.c_str(), mode);
      std::printf(
          "planes x lines x samples  a line an invocation        a line a group              ratio  evaluated\n");
      for (const LineSet& set : line_sets(request)) {
        Probe probe = scene.probe;
        probe.lines = set.lines;
        const Settings settings = settings_of(scene, {set.lines, set.samples, 1, 1}, trainer);
        const ScanLines lines = scan_lines(probe, scene.depth_mm, set.samples);
        gl::SimulationParameters parameters = gl::parameters_of(settings, lines, {}, {});
        parameters.planes = set.planes;
        const gl::Buffer block(sizeof parameters, &parameters);
        block.bind_uniform(0);

        std::vector<std::function<void(const Pose&)>> runs;
        for (Method& method : methods) {
          method.stages.lay_out(lines, set.planes, settings);
          runs.push_back([&](const Pose& pose) {
            method.stages.restart_counts();
            const std::vector<Pose> planes =
                set.planes == 1 ? std::vector{pose} : swept_planes(pose, set.planes, kSwept_deg, kPivot_mm);
            method.stages.traverse(volume, planes, settings);
          });
        }
        const auto times = alternating_times(scene.pose, request.frames, runs);

        std::array<Spread, 2> ms;
        std::array<double, 2> evaluated;
        const double possible = double(settings.slice_planes) * set.planes * set.lines * set.samples;
        for (std::size_t i = 0; i < methods.size(); ++i) {
          ms[i] = spread_of(times[i]);
          runs[i](scene.pose);
          const gl::SampleCounts counts = methods[i].stages.sample_counts();
          evaluated[i] = counts.traversed / possible;
          table.rows.push_back(
              {gl::device_description(), scene.name, scene.view, mode, std::to_string(set.planes),
               std::to_string(set.lines), std::to_string(set.samples), methods[i].name, std::to_string(own.group),
               std::to_string(request.frames), cell_of(ms[i].first_quartile, 4), cell_of(ms[i].median, 4),
               cell_of(ms[i].third_quartile, 4), std::to_string(counts.traversed), cell_of(possible, 0)});
        }
        std::printf("%3d x %4d x %-4d        %7.2f (%.2f to %.2f)  %7.2f (%.2f to %.2f)  %6.2f   %.0f %% / %.0f %%\n",
                    set.planes, set.lines, set.samples, ms[0].median, ms[0].first_quartile, ms[0].third_quartile,
                    ms[1].median, ms[1].first_quartile, ms[1].third_quartile, ms[0].median / ms[1].median,
                    100 * evaluated[0], 100 * evaluated[1]);
      }
    }
  });
  return table;
}

}  // namespace insonate::bench
