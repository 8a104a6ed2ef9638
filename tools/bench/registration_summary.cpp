#include "tools/bench/registration_summary.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <utility>
#include <vector>

#include "sim/core/text.h"
#include "tools/bench/tables/statistics.h"
#include "tools/bench/tables/svg.h"

namespace insonate::bench {
namespace {

constexpr double kSuccess_mm = 5;  // largest target registration error of a success
constexpr double kBand_mm = 5;     // of the capture range
constexpr double kDrawnBand_mm = 10;
constexpr double kCaptured = 0.95;  // share of a band's starts

struct Run {
  double start_mm = 0, start_deg = 0, start_error_mm = 0, error_mm = 0, expected_mm = 0, evaluations = 0, seconds = 0;
  bool converged = false;

  bool succeeded() const { return error_mm < kSuccess_mm; }
};

// By patient and measure, both in the order of the table.
using Runs = std::vector<std::pair<std::pair<std::string, std::string>, std::vector<Run>>>;

Runs runs_of(const std::string& file, const Table& table) {
  Runs runs;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto number = [&](const char* name) { return table.number(file, row, name); };
    const std::pair name(table.cell(row, "case") + ", " + table.cell(row, "view"), table.cell(row, "measure"));
    auto at = std::ranges::find(runs, name, [](const auto& each) { return each.first; });
    if (at == runs.end()) at = runs.insert(runs.end(), {name, {}});
    at->second.push_back({number("start_mm"), number("start_deg"), number("start_error_mm"), number("error_mm"),
                          number("expected_mm"), number("evaluations"), number("seconds"), number("converged") > 0});
  }
  std::ranges::stable_sort(runs, {}, [](const auto& each) { return each.first.first; });
  return runs;
}

template <typename Value>
double median_of(const std::vector<Run>& runs, Value&& value) {
  std::vector<double> values;
  for (const Run& run : runs) values.push_back(value(run));
  return values.empty() ? 0 : spread_of(values).median;
}

template <typename Taken>
std::vector<Run> only(const std::vector<Run>& runs, Taken&& taken) {
  std::vector<Run> some;
  std::ranges::copy_if(runs, std::back_inserter(some), taken);
  return some;
}

double success_of(const std::vector<Run>& runs) {
  return runs.empty() ? 0 : double(std::ranges::count_if(runs, &Run::succeeded)) / double(runs.size());
}

std::vector<Run> band(const std::vector<Run>& runs, double from, double to) {
  return only(runs, [&](const Run& run) { return run.start_error_mm >= from && run.start_error_mm < to; });
}

double capture_range(const std::vector<Run>& runs) {
  double range = 0;
  for (;; range += kBand_mm) {
    const std::vector<Run> within = band(runs, range, range + kBand_mm);
    if (within.empty() || success_of(within) < kCaptured) return range;
  }
}

}  // namespace

std::vector<RegistrationSummary> summaries_of(const std::string& file, const Table& table) {
  std::vector<RegistrationSummary> all;
  for (const auto& named : runs_of(file, table)) {
    const auto& name = named.first;
    const std::vector<Run>& runs = named.second;
    const std::vector<Run> near = only(runs, [](const Run& r) { return r.start_mm <= 20 && r.start_deg <= 15; });
    const auto error = [](const Run& run) { return run.error_mm; };
    const auto count = [&](auto&& which) { return std::size_t(std::ranges::count_if(runs, which)); };
    RegistrationSummary one;
    one.patient = name.first;
    one.measure = name.second;
    one.starts = runs.size();
    one.success = success_of(runs);
    one.near_starts = near.size();
    one.near_success = success_of(near);
    one.median_mm = median_of(runs, error);
    one.median_of_successes_mm = median_of(only(runs, &Run::succeeded), error);
    one.capture_mm = capture_range(runs);
    one.trusted_failures = count([](const Run& r) { return r.converged && !r.succeeded(); });
    one.doubted_successes = count([](const Run& r) { return !r.converged && r.succeeded(); });
    one.evaluations = median_of(runs, [](const Run& run) { return run.evaluations; });
    one.seconds = median_of(runs, [](const Run& run) { return run.seconds; });
    all.push_back(std::move(one));
  }
  return all;
}

void print_summaries(const std::vector<RegistrationSummary>& summaries) {
  std::printf(
      "\nmeasure    starts  success  within 20 mm, 15 deg  median error  of successes  capture  verdicts     "
      "evaluations  time\n");
  std::string patient;
  for (const RegistrationSummary& s : summaries) {
    if (s.patient != patient) std::printf("%s\n", s.patient.c_str());
    patient = s.patient;
    std::printf(
        "%-10s %6zu  %5.1f %%  %5.1f %% of %-9zu    %8.2f mm   %8.2f mm  %4.0f mm  %3zu and %-3zu  %11.0f  %.1f s\n",
        s.measure.c_str(), s.starts, 100 * s.success, 100 * s.near_success, s.near_starts, s.median_mm,
        s.median_of_successes_mm, s.capture_mm, s.trusted_failures, s.doubted_successes, s.evaluations, s.seconds);
  }
  std::printf("success: an error below 5 mm; verdicts: failures that count as converged, and successes that do not\n");
}

std::string registrations_svg(const std::string& file, const Table& table) {
  constexpr double kWidth = 880, kPanel = 300, kLeft = 60, kRight = 200, kTop = 40, kBottom = 46;
  constexpr std::array<const char*, 6> kColours{"#2567a8", "#1c8a5a", "#b3362b", "#c98a1b", "#6b4fa0", "#5f6c7b"};
  const Runs runs = runs_of(file, table);
  std::vector<std::string> patients;
  double most = kDrawnBand_mm;
  for (const auto& [name, all] : runs) {
    if (std::ranges::find(patients, name.first) == patients.end()) patients.push_back(name.first);
    for (const Run& run : all) most = std::max(most, run.start_error_mm);
  }
  const int bands = int(most / kDrawnBand_mm) + 1;
  std::string svg = formatted("<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f'>\n", kWidth,
                              kPanel * double(patients.size()));
  svg +=
      "<style>text{font:12px sans-serif;fill:#1d2733}.grid{stroke:#e3e8ee}polyline{fill:none;stroke-width:2}</style>"
      "<rect width='100%' height='100%' fill='#fff'/>\n";
  for (std::size_t p = 0; p < patients.size(); ++p) {
    const double top = kPanel * double(p) + kTop, bottom = kPanel * double(p + 1) - kBottom;
    const auto x = [&](double mm) { return kLeft + (kWidth - kRight - kLeft) * mm / (bands * kDrawnBand_mm); };
    const auto y = [&](double share) { return bottom - (bottom - top) * share; };
    svg +=
        formatted("<text x='%.0f' y='%.0f' font-weight='600'>", kLeft, top - 18) + escaped(patients[p]) + "</text>\n";
    for (int i = 0; i <= 4; ++i)
      svg += formatted(
          "<line class='grid' x1='%.0f' x2='%.0f' y1='%.1f' y2='%.1f'/>"
          "<text x='%.0f' y='%.1f' text-anchor='end'>%d %%</text>\n",
          kLeft, kWidth - kRight, y(i / 4.0), y(i / 4.0), kLeft - 6, y(i / 4.0) + 4, 25 * i);
    for (int i = 0; i <= bands; ++i)
      svg += formatted("<text x='%.1f' y='%.1f' text-anchor='middle'>%.0f</text>\n", x(i * kDrawnBand_mm), bottom + 16,
                       i * kDrawnBand_mm);
    svg += formatted("<text x='%.0f' y='%.1f' text-anchor='end'>target registration error of the start, mm</text>\n",
                     kWidth - kRight, bottom + 34);
    svg += formatted("<text x='%.0f' y='%.1f' text-anchor='end'>starts whose final error is below 5 mm</text>\n",
                     kWidth - kRight, top - 18);
    std::size_t line = 0;
    for (const auto& [name, all] : runs) {
      if (name.first != patients[p]) continue;
      const char* colour = kColours[line % kColours.size()];
      std::string points;
      for (int i = 0; i < bands; ++i) {
        const std::vector<Run> within = band(all, i * kDrawnBand_mm, (i + 1) * kDrawnBand_mm);
        if (within.empty()) continue;
        const double at_x = x((i + 0.5) * kDrawnBand_mm), at_y = y(success_of(within));
        points += formatted("%.1f,%.1f ", at_x, at_y);
        svg += formatted("<circle cx='%.1f' cy='%.1f' r='4' fill='%s'><title>%zu starts</title></circle>\n", at_x, at_y,
                         colour, within.size());
      }
      svg += formatted("<polyline stroke='%s' points='", colour) + points + "'/>\n";
      svg += formatted("<text x='%.0f' y='%.1f' style='fill:%s'>", kWidth - kRight + 16, top + 16.0 * double(line) + 8,
                       colour) +
             escaped(name.second) + formatted(": %zu starts</text>\n", all.size());
      ++line;
    }
  }
  return svg + "</svg>\n";
}

}  // namespace insonate::bench
