#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "tools/bench/commands.h"
#include "tools/bench/converged.h"
#include "tools/bench/paper_traversal.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

constexpr int kReferenceLines = 64;
/// Thresholds of the comparison: I above this value, as in the accuracy contract; R above this share of the brightest.
constexpr double kMin = 1e-6;

/// Returns the RMS error in dB. A value that is far too weak counts as 1/100 of the threshold.
double error_db(const Image<float>& got, const Image<double>& expected, const std::vector<int>& lines, double least) {
  RootMeanSquare db;
  for (int i = 0; i < expected.width; ++i)
    for (int k = 0; k < expected.height; ++k)
      if (expected.at(i, k) > least)
        db.add(10 * std::log10(std::max(double(got.at(lines[std::size_t(i)], k)), least / 100) / expected.at(i, k)));
  return db.value();
}

struct Error {
  double intensity_db = 0, reflection_db = 0;
};

Error error_of(const Image<float>& intensity, const Image<float>& reflection, const Converged& converged) {
  const auto& expected = converged.reflection.pixels;
  const double brightest = *std::max_element(expected.begin(), expected.end());
  return {error_db(intensity, converged.intensity, converged.lines, kMin),
          error_db(reflection, converged.reflection, converged.lines, kMin * brightest)};
}

}  // namespace

Table measure_paper(const Request& request) {
  const std::vector<Configuration> sizes = configurations(request, kPaperConfigurations);
  Table table{{"device", "case", "view", "mode", "lines", "samples", "width", "height", "method", "frames", "q1_ms",
               "median_ms", "q3_ms", "error_db", "error_r_db", "evaluated", "possible"},
              {}};
  std::vector<double> ratios;

  const gl::HeadlessContext context;
  tell_device();
  for_each_scene(request, [&](const Scene& scene) {
    gl::Simulator simulator;
    gl::PaperTraversal paper;
    gl::upload_ct(scene.file, scene.volume.grid, [&] {
      simulator.set_volume(scene.volume, scene.table);
      paper.set_volume(scene.volume, scene.table);
    });
    for (const bool trainer : {false, true}) {
      const char* mode = trainer ? "trainer" : "paper";
      std::printf("\n%s, view %s, %s's mode: traversal with a moving probe, ms\n", scene.name.c_str(),
                  scene.view.c_str(), mode);
      std::printf(
          "lines x samples  picture      the paper's passes         insonate                   ratio   "
          "error of I, dB    error of R, dB   evaluated\n");
      Probe probe = scene.probe;
      for (const Configuration& c : sizes) {
        probe.lines = c.lines;
        Settings settings = settings_of(scene, c, trainer);
        settings.skipping = settings.edge_shadow = false;  // so that both methods compute the same
        settings.slice_planes = 1;
        settings.speckle = settings.waves = false;  // the comparison is without scatterers, of I and R
        const ScanLines lines = scan_lines(probe, scene.depth_mm, c.samples);
        simulator.set_probe(probe, scene.depth_mm);
        simulator.set_settings(settings);
        paper.set_lines(lines, settings);

        const auto times = alternating_times(scene.pose, request.frames,
                                             {[&](const Pose& pose) { paper.run(pose); },
                                              [&](const Pose& pose) {
                                                simulator.set_pose(pose);
                                                simulator.run_through(gl::Stage::traverse);
                                              }});
        const Spread passes = spread_of(times[0]), own = spread_of(times[1]);
        ratios.push_back(passes.median / own.median);

        const Converged converged = converge(scene, lines, settings, kReferenceLines);
        paper.run(scene.pose);
        const gl::PaperTraversal::Scan paper_scan = paper.read();
        simulator.set_pose(scene.pose);
        const Stages<float> stages = simulator.read_stages();
        const Error paper_error = error_of(paper_scan.intensity, paper_scan.reflection, converged);
        const Error own_error = error_of(stages.intensity, stages.reflection, converged);
        const long possible = long(c.lines) * c.samples, evaluated = long(simulator.sample_counts().traversed);

        std::printf(
            "%4d x %-4d      %4d x %-4d  %7.2f (%.2f to %.2f)  %7.2f (%.2f to %.2f)  %6.2f   %.4f / %.4f   "
            "%.4f / %.4f   %.0f %%\n",
            c.lines, c.samples, c.width, c.height, passes.median, passes.first_quartile, passes.third_quartile,
            own.median, own.first_quartile, own.third_quartile, ratios.back(), paper_error.intensity_db,
            own_error.intensity_db, paper_error.reflection_db, own_error.reflection_db,
            100.0 * double(evaluated) / double(possible));
        const auto add = [&](const char* method, const Spread& ms, const Error& error, long samples) {
          table.rows.push_back({gl::device_description(), scene.name, scene.view, mode, std::to_string(c.lines),
                                std::to_string(c.samples), std::to_string(c.width), std::to_string(c.height), method,
                                std::to_string(request.frames), cell_of(ms.first_quartile, 4), cell_of(ms.median, 4),
                                cell_of(ms.third_quartile, 4), cell_of(error.intensity_db, 6),
                                cell_of(error.reflection_db, 6), std::to_string(samples), std::to_string(possible)});
        };
        add("passes", passes, paper_error, possible);
        add("insonate", own, own_error, evaluated);
      }
    }
  });
  std::printf("\nsmallest ratio %.2f, median ratio %.2f\n", *std::min_element(ratios.begin(), ratios.end()),
              spread_of(ratios).median);
  return table;
}

}  // namespace insonate::bench
