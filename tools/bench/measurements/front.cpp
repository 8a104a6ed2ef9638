#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <utility>

#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "sim/model/quality.h"
#include "sim/reference/reference.h"
#include "tools/bench/commands.h"
#include "tools/bench/converged.h"
#include "tools/bench/display.h"
#include "tools/bench/tables/plot.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

/// The frames of each setting are measured in this many rounds over all settings. So if the machine is slower for a few
/// seconds, only a few frames of each setting are affected.
constexpr int kRounds = 10;

constexpr double kMiB = 1 << 20;

struct Setting {
  std::string name;
  int lines;
  Settings settings;
  bool whole = true;  ///< draws the same; other pictures are not on the front
};

std::string size_name(const Settings& settings) {
  return std::to_string(settings.samples) + " samples, " + std::to_string(settings.image_width) + " x " +
         std::to_string(settings.image_height);
}

/// Returns the level of quality that a setting represents; "" for none.
std::string quality_of(const Setting& setting, const Setting& balanced) {
  for (const Quality quality : kQualities)
    if (setting.settings == at_quality(balanced.settings, quality)) return name_of(quality);
  return "";
}

/// Returns the settings to measure, the defaults first.
std::vector<Setting> settings_to_try(const Request& request, const Scene& scene) {
  const Settings defaults = trainer_settings(scene.probe.frequency_mhz, scene.depth_mm);
  const int lines = scene.probe.lines;
  std::vector<Configuration> sizes = {{lines, defaults.samples, defaults.image_width, defaults.image_height}};
  for (const glm::ivec2 pixels :
       {glm::ivec2(320, 240), glm::ivec2(480, 360), glm::ivec2(640, 480), glm::ivec2(960, 720)})
    for (const double ratio : {0.25, 0.375, 0.5, 0.75, 1.0, 1.5, 2.0, 4.0})
      if (ratio != 1 || pixels != glm::ivec2(defaults.image_width, defaults.image_height))
        sizes.push_back({lines, int(std::lround(ratio * defaults.samples)), pixels.x, pixels.y});

  std::vector<Setting> tried;
  for (const Configuration& c : configurations(request, sizes)) {
    Settings settings = defaults;
    settings.samples = c.samples;
    settings.image_width = c.width;
    settings.image_height = c.height;
    tried.push_back({size_name(settings), c.lines, settings});
  }
  const auto changed = [&](const char* what, bool whole, auto change) {
    Setting setting = tried.front();
    change(setting.settings);
    setting.name = what;
    setting.whole = whole;
    tried.push_back(setting);
  };
  const auto other = [&](const char* what, auto change) { changed(what, false, change); };
  changed("nothing skipped", true, [](Settings& s) { s.skipping = false; });
  changed("exact filtering", true, [](Settings& s) { s.exact_filter = true; });
  other("no speckle", [](Settings& s) { s.speckle = false; });
  other("one plane", [](Settings& s) { s.slice_planes = 1; });
  other("no edge shadow", [](Settings& s) { s.edge_shadow = false; });
  other("ring-down", [](Settings& s) { s.ring_down = kUsualRingDown; });
  other("no reverberation", [](Settings& s) { s.reverberation = false, s.face_reflection = 0; });
  other("a beam of three lines", [](Settings& s) { s.focused_beam = false, s.beam_lines = 3; });
  other("amplitudes instead of waves", [](Settings& s) { s.waves = false; });
  other("half the scatterers", [](Settings& s) { s.speckle_cell_mm *= std::cbrt(2); });
  other("twice the scatterers", [](Settings& s) { s.speckle_cell_mm /= std::cbrt(2); });
  return tried;
}

void print(const Scene& scene, const Panel& panel, const std::vector<Cost>& costs,
           const std::vector<DisplayError>& errors) {
  std::printf("\n%s, view %s: run time of a frame against error\n", scene.name.c_str(), scene.view.c_str());
  std::printf("  ms       (quartiles)        error, dB   grey levels   volume, MiB\n");
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return costs[a].time.median < costs[b].time.median; });
  for (const std::size_t i : order) {
    const Spread& ms = costs[i].time;
    std::printf("%8.2f  (%.2f to %.2f)  %8.3f   %8.2f   %8.1f   %-6s %s%s\n", ms.median, ms.first_quartile,
                ms.third_quartile, errors[i].db, errors[i].grey, costs[i].memory,
                panel.points[i].on_front ? "front" : "", panel.points[i].name.c_str(),
                panel.points[i].quality.empty() ? "" : (" (" + panel.points[i].quality + ")").c_str());
  }
  for (const std::size_t i : order)
    if (i != 0 && !panel.points[i].quality.empty())
      std::printf("%s %s on the front.\n", panel.points[i].quality.c_str(),
                  panel.points[i].on_front ? "lies" : "does not lie");
  const Spread& usual = costs.front().time;
  std::vector<std::size_t> better;
  std::copy_if(order.begin(), order.end(), std::back_inserter(better), [&](std::size_t i) {
    return i != 0 && !panel.points[i].leaves_out && costs[i].time.median <= usual.median &&
           costs[i].error <= costs[0].error;
  });
  std::printf("balanced, the default, %s.%s\n",
              panel.points.front().on_front ? "lies on the front" : "does not lie on the front",
              better.empty() ? "" : " No slower by the median and no less exact:");
  for (const std::size_t i : better)
    std::printf("  %s: %+.1f %% of time, %s the spread, %+.1f %% of error, %.1f times the memory\n",
                panel.points[i].name.c_str(), 100 * (costs[i].time.median / usual.median - 1),
                costs[i].time.third_quartile < usual.first_quartile ? "beyond" : "within",
                100 * (costs[i].error / costs[0].error - 1), costs[i].memory / costs[0].memory);
}

}  // namespace

Table measure_front(const Request& request, const std::string& svg) {
  Table table{{"device", "case", "view", "setting", "lines", "samples", "width", "height", "frames", "q1_ms",
               "median_ms", "q3_ms", "error_db", "error_grey", "volume_mib", "evaluated", "possible", "on_front"},
              {}};
  std::vector<Panel> panels;
  const gl::HeadlessContext context;
  tell_device();
  for_each_scene(request, [&](const Scene& scene) {
    gl::Simulator simulator;
    gl::upload_ct(scene.file, scene.volume.grid, [&] { simulator.set_volume(scene.volume, scene.table); });
    const std::vector<Setting> tried = settings_to_try(request, scene);
    const double range = tried.front().settings.dynamic_range_db;

    Settings exact = tried.front().settings;
    exact.samples = std::min(kFiner * exact.samples, 8192);
    Probe probe = scene.probe;
    probe.lines = tried.front().lines;
    const Stages<double> reference =
        simulate_reference(trilinear_field(scene.volume), scene.table, probe, scene.depth_mm, exact, scene.pose);
    const Display converged = displayed(reference, scene.probe, scene.depth_mm, exact);

    const auto set = [&](const Setting& setting) {
      probe.lines = setting.lines;
      simulator.set_probe(probe, scene.depth_mm);
      simulator.set_settings(setting.settings);
    };
    std::vector<std::vector<double>> frames_ms(tried.size());
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t i = 0; i < tried.size(); ++i) {
        set(tried[i]);
        const auto frame = [&](const Pose& pose) {
          simulator.set_pose(pose);
          simulator.image();
        };
        const int first = request.frames * round / kRounds, count = request.frames * (round + 1) / kRounds - first;
        const auto measured = alternating_times(scene.pose, count, {frame}, first).front();
        frames_ms[i].insert(frames_ms[i].end(), measured.begin(), measured.end());
      }

    std::vector<DisplayError> errors;
    std::vector<Cost> costs, costs_of_whole;
    for (std::size_t i = 0; i < tried.size(); ++i) {
      const Setting& setting = tried[i];
      set(setting);
      simulator.set_pose(scene.pose);
      const Stages<float> stages = simulator.read_stages();
      errors.push_back(error_of(displayed(stages, scene.probe, scene.depth_mm, setting.settings), converged, range));
      costs.push_back({spread_of(frames_ms[i]), errors.back().db, double(simulator.volume_bytes()) / kMiB});
      if (setting.whole) costs_of_whole.push_back(costs.back());
      const Spread& ms = costs.back().time;
      table.rows.push_back({gl::device_description(), scene.name, scene.view, setting.name,
                            std::to_string(setting.lines), std::to_string(setting.settings.samples),
                            std::to_string(setting.settings.image_width), std::to_string(setting.settings.image_height),
                            std::to_string(request.frames), cell_of(ms.first_quartile, 4), cell_of(ms.median, 4),
                            cell_of(ms.third_quartile, 4), cell_of(errors.back().db, 5), cell_of(errors.back().grey, 4),
                            cell_of(costs.back().memory, 3),
                            std::to_string(simulator.count(gl::Stage::traverse).evaluated),
                            std::to_string(simulator.count(gl::Stage::traverse).possible)});
    }
    const std::vector<bool> front = on_front(costs_of_whole);
    Panel panel{scene.name + ", view " + scene.view, {}};
    for (std::size_t i = 0, whole = 0; i < tried.size(); ++i) {
      const bool on_it = tried[i].whole && front[whole++];
      table.rows[table.rows.size() - tried.size() + i].push_back(on_it ? "1" : "0");
      panel.points.push_back({tried[i].name, costs[i].time.median, errors[i].db, on_it,
                              quality_of(tried[i], tried.front()), !tried[i].whole});
    }
    print(scene, panel, costs, errors);
    panels.push_back(std::move(panel));
  });
  if (!svg.empty()) write_file(svg, front_svg(gl::device_description(), panels));
  return table;
}

}  // namespace insonate::bench
