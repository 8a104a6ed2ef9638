// insonate-devices check: checks whether a recorded log is complete.

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include "devices/log_report.h"
#include "devices/replay/read_log.h"
#include "tools/devices/commands.h"

namespace insonate::devices {
namespace {

nlohmann::ordered_json to_json(const std::string& log, const LogReport& report) {
  nlohmann::ordered_json json = {{"log", log},
                                 {"transform", report.transform},
                                 {"has_times", report.has_times},
                                 {"frames", report.frames},
                                 {"usable_frames", report.usable},
                                 {"begin_s", report.begin_s},
                                 {"duration_s", report.duration_s},
                                 {"rate_hz", report.rate_hz()},
                                 {"jitter_ms", report.jitter_s * 1e3},
                                 {"longest_step_ms", report.longest_step_s * 1e3},
                                 {"path_mm", report.path_mm},
                                 {"rounded_rotations", report.repairs.rounded_rotations},
                                 {"worst_rotation_error", report.repairs.worst_rotation_error},
                                 {"frames_out_of_order", report.repairs.frames_out_of_order},
                                 {"worst_disorder_ms", report.repairs.worst_disorder_s * 1e3},
                                 {"findings", report.findings()}};
  json["marks_s"] = report.marks_s;
  json["gaps"] = nlohmann::ordered_json::array();
  for (const LogReport::Gap& gap : report.gaps)
    json["gaps"].push_back({{"frame", gap.frame},
                            {"time_s", gap.time_s},
                            {"length_ms", gap.length_s * 1e3},
                            {"missing_samples", gap.missing}});
  json["dropouts"] = nlohmann::ordered_json::object();
  for (const auto& [status, dropout] : report.dropouts)
    json["dropouts"][std::string(to_string(status))] = {
        {"frames", dropout.frames}, {"spells", dropout.spells}, {"longest_ms", dropout.longest_s * 1e3}};
  json["jumps"] = nlohmann::ordered_json::array();
  for (const LogReport::Jump& jump : report.jumps)
    json["jumps"].push_back({{"frame", jump.frame}, {"time_s", jump.time_s}, {"mm", jump.mm}, {"deg", jump.deg}});
  return json;
}

void print(const std::string& log, const LogReport& report) {
  constexpr std::size_t kShown = 10;
  std::printf("%s\n", log.c_str());
  std::printf("  probe     %s\n", report.transform.c_str());
  std::printf("  frames    %zu, %zu of them usable (%.1f %%)\n", report.frames, report.usable,
              100.0 * double(report.usable) / double(report.frames));
  if (report.has_times) {
    std::printf("  duration  %.3f s from %.6f s on\n", report.duration_s, report.begin_s);
    std::printf("  rate      %.2f Hz, jitter %.2f ms RMS\n", report.rate_hz(), report.jitter_s * 1e3);
  }
  std::printf("  path      %.0f mm\n", report.path_mm);
  if (report.repairs.rounded_rotations > 0)
    std::printf("  rounded   %zu rotations, off by up to %.1e, are replaced by the nearest ones\n",
                report.repairs.rounded_rotations, report.repairs.worst_rotation_error);
  if (report.repairs.frames_out_of_order > 0)
    std::printf("  sorted    %zu frames stood up to %.1f ms behind a later one\n", report.repairs.frames_out_of_order,
                report.repairs.worst_disorder_s * 1e3);
  for (const double time_s : report.marks_s)
    std::printf("  marked    %.3f s after the first frame\n", time_s - report.begin_s);
  for (const auto& [status, dropout] : report.dropouts)
    std::printf("  dropouts  %zu frames %s in %zu spells, the longest %.0f ms\n", dropout.frames,
                std::string(to_string(status)).c_str(), dropout.spells, dropout.longest_s * 1e3);
  if (report.has_times) std::printf("  gaps      %zu\n", report.gaps.size());
  for (std::size_t i = 0; i < std::min(report.gaps.size(), kShown); ++i)
    std::printf("            %.0f ms before frame %zu, room for %zu samples\n", report.gaps[i].length_s * 1e3,
                report.gaps[i].frame, report.gaps[i].missing);
  if (report.has_times) std::printf("  jumps     %zu\n", report.jumps.size());
  for (std::size_t i = 0; i < std::min(report.jumps.size(), kShown); ++i)
    std::printf("            %.0f mm and %.0f degrees at frame %zu\n", report.jumps[i].mm, report.jumps[i].deg,
                report.jumps[i].frame);
  if (std::max(report.gaps.size(), report.jumps.size()) > kShown)
    std::printf("  of gaps and jumps the first %zu are shown; --json has all\n", kShown);
  for (const std::string& finding : report.findings()) std::printf("  look at   %s\n", finding.c_str());
  if (report.findings().empty()) std::printf("  whole: nothing to look at\n");
}

/// Exit code for a readable log with findings that a person should review.
constexpr int kSomethingFound = 1;

struct CheckRequest {
  std::string log, transform;
  bool json = false;
};

int check(const CheckRequest& request) {
  RecordingOptions options;
  options.transform = request.transform;
  options.without_times = true;
  const LogReport report = check_log(read_log(request.log, options));
  if (request.json)
    std::printf("%s\n", to_json(request.log, report).dump(2).c_str());
  else
    print(request.log, report);
  return report.findings().empty() ? 0 : kSomethingFound;
}

}  // namespace

Command check_command(CLI::App& program) {
  const auto request = std::make_shared<CheckRequest>();
  CLI::App* parser = program.add_subcommand("check", "Check the rate, gaps, dropouts and jumps of a recorded log");
  parser
      ->add_option("LOG", request->log,
                   "Check this sequence file (.igs.mha, .seq.mha or .seq.nrrd), or file that --record-raw has written")
      ->type_name("FILE")
      ->required();
  parser
      ->add_option("--transform", request->transform,
                   "Take the probe's poses from this transform, such as ProbeToTracker")
      ->type_name("NAME")
      ->default_str("the one from Probe to Patient, Reference or Tracker");
  parser->add_flag("--json", request->json, "Print the report as JSON");
  parser->footer(
      "Exit codes: 0 whole, 1 something to look at (samples missing, jumps, dropouts over 250 ms), 2 not a log.");
  return {parser, [request] { return check(*request); }};
}

}  // namespace insonate::devices
