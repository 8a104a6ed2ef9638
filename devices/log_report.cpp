#include "devices/log_report.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include "devices/live/probe_buttons.h"
#include "devices/pose_history.h"
#include "sim/core/button_presses.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

// Above every meaningful count, and below the largest integer.
constexpr double kMaxMissing = 1e15;

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void count_gaps(const std::vector<ProbeSample>& samples, LogReport& report) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) steps.push_back(samples[i].time_s - samples[i - 1].time_s);
  if (steps.empty()) return;
  report.interval_s = median(steps);
  report.longest_step_s = *std::max_element(steps.begin(), steps.end());
  double squares = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double intervals = steps[i] / report.interval_s;
    if (intervals > kGapIntervals)
      report.gaps.push_back(
          {i + 1, samples[i + 1].time_s, steps[i], std::size_t(std::round(std::min(intervals, kMaxMissing))) - 1});
    else
      squares += (steps[i] - report.interval_s) * (steps[i] - report.interval_s);
  }
  if (const std::size_t regular = steps.size() - report.gaps.size(); regular > 0)
    report.jitter_s = std::sqrt(squares / double(regular));
}

void count_dropouts(const std::vector<ProbeSample>& samples, LogReport& report) {
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i + 1;
    while (end < samples.size() && samples[end].status == samples[i].status) ++end;
    if (samples[i].status == PoseStatus::ok) {
      report.usable += end - i;
    } else {
      LogReport::Dropout& dropout = report.dropouts[samples[i].status];
      dropout.frames += end - i;
      ++dropout.spells;
      const double until_s = samples[std::min(end, samples.size() - 1)].time_s;
      if (report.has_times) dropout.longest_s = std::max(dropout.longest_s, until_s - samples[i].time_s);
    }
    i = end;
  }
}

void follow_path(const std::vector<ProbeSample>& samples, LogReport& report) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const ProbeSample &a = samples[i - 1], &b = samples[i];
    if (a.status != PoseStatus::ok || b.status != PoseStatus::ok) continue;
    const double mm = glm::distance(a.patient_from_probe.translation, b.patient_from_probe.translation);
    const double deg = angle_between_deg(a.patient_from_probe, b.patient_from_probe);
    const double s = b.time_s - a.time_s;
    report.path_mm += mm;
    if (!report.has_times) continue;
    if ((mm > kJumpMin_mm && mm / s > kJumpMmPerS) || (deg > kJumpMin_deg && deg / s > kJumpDegPerS))
      report.jumps.push_back({i, b.time_s, mm, deg});
  }
}

std::string milliseconds(double seconds) {
  return std::to_string(std::llround(std::min(seconds, 1e9) * 1e3)) + " ms";
}

}  // namespace

std::vector<std::string> LogReport::findings() const {
  std::vector<std::string> found;
  const auto unknown = dropouts.find(PoseStatus::unknown);
  if (usable == 0 && unknown != dropouts.end() && unknown->second.frames == frames)
    found.push_back("No frame is usable: none has the status OK for " + transform + ".");
  else if (usable == 0)
    found.emplace_back("No frame is usable.");
  if (!has_times)
    found.emplace_back("The frames have no Timestamp: it replays with ?rate=HZ, but an exam cannot be scored from it.");
  if (!gaps.empty())
    found.push_back(count_of(gaps.size(), "gap") + " in the samples, the longest step " + milliseconds(longest_step_s) +
                    ".");
  if (!jumps.empty()) found.push_back(count_of(jumps.size(), "jump") + " that no hand makes.");
  for (const auto& [status, dropout] : dropouts)
    if (dropout.longest_s > PoseHistory::kStale_s)
      found.push_back("A dropout (" + std::string(to_string(status)) + ") of " + milliseconds(dropout.longest_s) +
                      ", in which the picture stands still.");
  return found;
}

LogReport check_log(const std::vector<ProbeSample>& samples, bool has_times) {
  LogReport report;
  report.frames = samples.size();
  report.has_times = has_times;
  if (samples.empty()) return report;
  if (has_times) {
    report.begin_s = samples.front().time_s;
    report.duration_s = samples.back().time_s - samples.front().time_s;
    count_gaps(samples, report);
  }
  count_dropouts(samples, report);
  follow_path(samples, report);
  ButtonPresses presses;
  if (!has_times) return report;
  for (const ProbeSample& sample : samples)
    if (presses.see(sample) & kEventMarkerButton) report.marks_s.push_back(sample.time_s);
  return report;
}

LogReport check_log(const RecordedScan& scan) {
  LogReport report = check_log(scan.samples, !scan.recording.assumed_rate_hz);
  report.transform = scan.recording.transform;
  report.repairs = scan.recording.repairs;
  return report;
}

}  // namespace insonate
