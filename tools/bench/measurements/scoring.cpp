#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "devices/sequence/probe_samples.h"
#include "scenarios/runner.h"
#include "sim/files/files.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"
#include "tools/cli/subject.h"

namespace insonate::bench {
namespace {

constexpr double kFrame_s = 1 / 60.0;  // screen frame; with a fast tracker, several samples are scored per frame

}  // namespace

Table measure_scoring(const std::vector<std::string>& exams) {
  Table table{{"scenario", "log", "samples", "first_quartile_ms", "median_ms", "third_quartile_ms", "longest_ms",
               "longest_frame_ms"},
              {}};
  std::printf("%-28s %-28s %8s %10s %10s %10s %10s\n", "scenario", "log", "samples", "median ms", "quartile",
              "longest ms", "frame ms");
  for (std::size_t i = 0; i + 1 < exams.size(); i += 2) {
    const Scenario scenario = read_scenario(exams[i]);
    const RecordedScan scan = read_recorded_scan(exams[i + 1]);
    const ActionLog actions = parse_action_log(scan.recording.actions, scan.recording.file);
    const Case subject = load_case(scenario, assets_folder(), cache_folder(), show_progress);
    Runner runner(scenario, subject, read_tissue_table(assets_folder() / "tissues.toml"));
    std::vector<double> times_ms;
    double frame_ms = 0, longest_frame_ms = 0, frame_began_s = 0;
    for (const ProbeSample& sample : scan.samples) {
      if (runner.live().finished) break;
      const auto before = actions.find(sample.time_s);
      const auto start = std::chrono::steady_clock::now();
      runner.feed(sample, before == actions.end() ? std::span<const Action>() : before->second);
      times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
      if (sample.time_s - frame_began_s >= kFrame_s) {
        frame_began_s = sample.time_s;
        frame_ms = 0;
      }
      frame_ms += times_ms.back();
      longest_frame_ms = std::max(longest_frame_ms, frame_ms);
    }
    const Spread spread = spread_of(times_ms);
    const double longest = *std::max_element(times_ms.begin(), times_ms.end());
    const std::string name = scenario.file.filename().string();
    std::printf("%-28s %-28s %8zu %10.3f %10.3f %10.3f %10.3f\n", name.c_str(), scan.recording.file.c_str(),
                times_ms.size(), spread.median, spread.third_quartile, longest, longest_frame_ms);
    table.rows.push_back({name, scan.recording.file, std::to_string(times_ms.size()), cell_of(spread.first_quartile, 4),
                          cell_of(spread.median, 4), cell_of(spread.third_quartile, 4), cell_of(longest, 4),
                          cell_of(longest_frame_ms, 4)});
  }
  return table;
}

}  // namespace insonate::bench
