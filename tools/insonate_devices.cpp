// insonate-devices: which trackers there are, whether a recorded log is whole, and what a tracker says.

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "devices/hid/hid_devices.h"
#include "devices/known_trackers.h"
#include "devices/log_report.h"
#include "devices/registry.h"
#include "devices/sequence/probe_samples.h"
#include "devices/usb/usb_devices.h"
#include "tools/program.h"

using namespace insonate;

namespace {

/// Prints the known trackers of a bus, or with `all` every device of it; returns how many known ones there are.
int list_bus(Bus bus, const char* bus_name, const AttachedDevices& attached, bool all) {
  int known_ones = 0;
  if (!attached.problem.empty()) std::printf("  %s cannot be asked: %s\n", bus_name, attached.problem.c_str());
  for (const AttachedDevice& device : attached.devices) {
    const KnownTracker* known = known_tracker(bus, device.vendor, device.product);
    if (!known && !all) continue;
    known_ones += known != nullptr;
    const std::string name = known ? std::string(known->name) : device.name.empty() ? "a device" : device.name;
    std::printf("  %-32s %s %04x:%04x  %s", name.c_str(), bus_name, device.vendor, device.product, device.path.c_str());
    if (!device.serial.empty()) std::printf("  serial %s", device.serial.c_str());
    if (known && !known->note.empty()) std::printf("  (%s)", std::string(known->note).c_str());
    std::printf("\n");
  }
  return known_ones;
}

int list(bool all) {
  std::printf("Trackers that this version can use, as --tracker takes them:\n");
  for (const TrackerKind& kind : tracker_kinds())
    std::printf("  %-62s %s\n", std::string(kind.form).c_str(), std::string(kind.summary).c_str());
  std::printf("\nPlugged in:\n");
  const int known = list_bus(Bus::hid, "HID", hid_devices(), all) + list_bus(Bus::usb, "USB", usb_devices(), all);
  if (known == 0) std::printf("  no tracker that is known here%s\n", all ? "" : " (--all lists every device)");
  return 0;
}

nlohmann::ordered_json to_json(const std::string& log, const LogReport& report) {
  nlohmann::ordered_json json = {{"log", log},
                                 {"frames", report.frames},
                                 {"usable_frames", report.usable},
                                 {"begin_s", report.begin_s},
                                 {"duration_s", report.duration_s},
                                 {"rate_hz", report.rate_hz()},
                                 {"jitter_ms", report.jitter_s * 1e3},
                                 {"path_mm", report.path_mm}};
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
  std::printf("  frames    %zu, %zu of them usable (%.1f %%)\n", report.frames, report.usable,
              100.0 * double(report.usable) / double(report.frames));
  std::printf("  duration  %.3f s from %.6f s on\n", report.duration_s, report.begin_s);
  std::printf("  rate      %.2f Hz, jitter %.2f ms RMS\n", report.rate_hz(), report.jitter_s * 1e3);
  std::printf("  path      %.0f mm\n", report.path_mm);
  for (const auto& [status, dropout] : report.dropouts)
    std::printf("  dropouts  %zu frames %s in %zu spells, the longest %.0f ms\n", dropout.frames,
                std::string(to_string(status)).c_str(), dropout.spells, dropout.longest_s * 1e3);
  std::printf("  gaps      %zu\n", report.gaps.size());
  for (std::size_t i = 0; i < std::min(report.gaps.size(), kShown); ++i)
    std::printf("            %.0f ms before frame %zu, room for %zu samples\n", report.gaps[i].length_s * 1e3,
                report.gaps[i].frame, report.gaps[i].missing);
  std::printf("  jumps     %zu\n", report.jumps.size());
  for (std::size_t i = 0; i < std::min(report.jumps.size(), kShown); ++i)
    std::printf("            %.0f mm and %.0f degrees at frame %zu\n", report.jumps[i].mm, report.jumps[i].deg,
                report.jumps[i].frame);
  if (std::max(report.gaps.size(), report.jumps.size()) > kShown)
    std::printf("  of gaps and jumps the first %zu are shown; --json has all\n", kShown);
}

int check(const std::string& log, const std::string& transform, bool json) {
  const LogReport report = check_log(read_recorded_scan(log, transform).samples);
  if (json)
    std::printf("%s\n", to_json(log, report).dump(2).c_str());
  else
    print(log, report);
  return 0;
}

void print(const PoseSample& sample) {
  std::printf("%.6f %-13s", sample.time_s, std::string(to_string(sample.status)).c_str());
  if (sample.status == PoseStatus::ok) {
    const glm::dvec3& p = sample.patient_from_probe.translation;
    const glm::dquat q = glm::quat_cast(sample.patient_from_probe.rotation);
    std::printf(" %9.3f %9.3f %9.3f mm  %8.5f %8.5f %8.5f %8.5f", p.x, p.y, p.z, q.w, q.x, q.y, q.z);
  }
  if (sample.buttons) std::printf("  buttons %x", unsigned(sample.buttons));
  std::printf("\n");
}

int watch(const std::string& uri, double seconds) {
  const auto tracker = open_tracker(uri);
  const auto start = std::chrono::steady_clock::now();
  std::vector<PoseSample> samples;
  std::printf("time_s status x y z (probe's face in the patient, LPS) qw qx qy qz\n");
  for (double now_s = 0;;) {
    samples.clear();
    tracker->poll(now_s, samples);
    for (const PoseSample& sample : samples) print(sample);
    std::fflush(stdout);
    if (now_s >= seconds || tracker->state().condition == TrackerCondition::finished) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    now_s = std::min(seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  const TrackerState state = tracker->state();
  std::fprintf(stderr, "%s: %s, %llu samples, %llu usable, %.1f Hz\n", state.name.c_str(),
               std::string(to_string(state.condition)).c_str(), static_cast<unsigned long long>(state.delivered),
               static_cast<unsigned long long>(state.usable), state.rate_hz);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Trackers: which there are, what they say, and whether a recorded log is whole.",
                     "insonate-devices");
  arguments.require_subcommand(1);
  arguments.footer(
      "Examples:\n"
      "  insonate-devices list\n"
      "  insonate-devices check scan.igs.mha --json\n"
      "  insonate-devices watch 'replay:scan.igs.mha?speed=4'");

  bool all = false;
  CLI::App* list_command = arguments.add_subcommand("list", "The kinds of tracker, and those that are plugged in");
  list_command->add_flag("--all", all, "Every HID and USB device, known or not");

  std::string log, transform;
  bool json = false;
  CLI::App* check_command = arguments.add_subcommand("check", "Rate, gaps, dropouts and jumps of a recorded log");
  check_command->add_option("LOG", log, "A sequence file (.igs.mha or .seq.mha)")->required();
  check_command->add_option("--transform", transform, "The probe's transform, as ProbeToTracker; else the usual ones");
  check_command->add_flag("--json", json, "As JSON");

  std::string uri;
  double seconds = 1e9;
  CLI::App* watch_command = arguments.add_subcommand("watch", "Print a tracker's samples as they come");
  watch_command->add_option("URI", uri, "The tracker, as 'list' shows them")->required();
  watch_command->add_option("--seconds", seconds, "Stop after so long")->check(CLI::PositiveNumber);

  return run_program(arguments, argc, argv, [&] {
    if (list_command->parsed()) return list(all);
    if (check_command->parsed()) return check(log, transform, json);
    return watch(uri, seconds);
  });
}
