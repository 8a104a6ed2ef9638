#include "tools/bench/tables/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace insonate::bench {
namespace {

constexpr std::array<const char*, 3> kTimes = {"q1_ms", "median_ms", "q3_ms"};
// Columns that are measured or informative, besides all times. Every other column is part of the setting.
constexpr std::array<const char*, 14> kMeasured = {
    "device",   "frames",   "runs_still",        "error_db",           "error_grey", "error_r_db", "evaluated",
    "possible", "on_front", "images_per_second", "mpixels_per_second", "faintest",   "denormal",   "volume_mib"};

constexpr std::array<const char*, 4> kBetterSmall = {"runs_still", "error_db", "error_grey", "error_r_db"};
// Factor for the rounding of another device: a volume of half floats changes the errors of the same frames by 3e-4.
constexpr double kRounding = 1.005;

bool has(const Table& table, const char* column) {
  return std::find(table.columns.begin(), table.columns.end(), column) != table.columns.end();
}

bool names_setting(const std::string& column) {
  const auto is = [&](const char* name) { return column == name; };
  return std::none_of(kMeasured.begin(), kMeasured.end(), is) && !column.ends_with("_ms");
}

std::string setting_of(const Table& table, std::size_t row) {
  std::string text;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (names_setting(table.columns[c]))
      text += (text.empty() ? "" : ", ") + table.columns[c] + "=" + table.rows[row][c];
  return text;
}

double time_of(const std::string& file, const Table& table, std::size_t row, const char* name) {
  const double ms = table.number(file, row, name);
  if (!(ms > 0) || std::isinf(ms))
    throw InputError(file, "line " + std::to_string(row + 2) + ", column '" + name + "'",
                     "'" + table.cell(row, name) + "' is not a positive time", "measure again");
  return ms;
}

void check(const std::string& file, const Table& table) {
  for (const char* name : kTimes)
    if (!has(table, name))
      throw InputError(file, "", std::string("there is no column '") + name + "'",
                       "give a file that insonate-bench --csv wrote");
}

}  // namespace

Comparison compare(const std::string& old_file, const Table& before, const std::string& new_file, const Table& after) {
  check(old_file, before);
  check(new_file, after);
  std::map<std::string, std::size_t> row_of;
  for (std::size_t i = 0; i < after.rows.size(); ++i) row_of[setting_of(after, i)] = i;

  Comparison found;
  for (std::size_t i = 0; i < before.rows.size(); ++i) {
    const std::string setting = setting_of(before, i);
    const auto match = row_of.find(setting);
    if (match == row_of.end()) {
      found.gone.push_back(setting);
      continue;
    }
    const auto was = [&](const char* name) { return time_of(old_file, before, i, name); };
    const auto is = [&](const char* name) { return time_of(new_file, after, match->second, name); };
    Change change{setting,
                  was("median_ms"),
                  is("median_ms"),
                  is("median_ms") / was("median_ms"),
                  is("q1_ms") / was("q3_ms"),
                  is("q3_ms") / was("q1_ms"),
                  {}};
    for (const char* column : kBetterSmall) {
      if (!has(before, column)) continue;
      if (!has(after, column))
        change.worse.push_back(std::string(column) + " " + before.cell(i, column) + " -> missing");
      else if (!(after.number(new_file, match->second, column) <= kRounding * before.number(old_file, i, column)))
        change.worse.push_back(std::string(column) + " " + before.cell(i, column) + " -> " +
                               after.cell(match->second, column));
    }
    found.changes.push_back(std::move(change));
    row_of.erase(match);
  }
  for (std::size_t i = 0; i < after.rows.size(); ++i)
    if (row_of.contains(setting_of(after, i))) found.arrived.push_back(setting_of(after, i));
  if (found.changes.empty())
    throw InputError(new_file, "", "none of its settings is in " + old_file, "compare two runs of the same command");
  return found;
}

void compare_runs(const std::string& old_file, const std::string& new_file) {
  const Table before = Table::parse(old_file, read_file(old_file)), after = Table::parse(new_file, read_file(new_file));
  const Comparison compared = compare(old_file, before, new_file, after);
  std::vector<double> ratios;
  int slower = 0, faster = 0, worse = 0;
  std::printf("  old ms    new ms   ratio  (by the quartiles)\n");
  for (const Change& change : compared.changes) {
    std::printf("%8.2f  %8.2f  %6.3f  (%.3f to %.3f)  %-6s  %s\n", change.old_ms, change.new_ms, change.ratio,
                change.least_ratio, change.most_ratio,
                change.slower()   ? "SLOWER"
                : change.faster() ? "faster"
                                  : "",
                change.setting.c_str());
    for (const std::string& what : change.worse) std::printf("%28s  WORSE   %s\n", "", what.c_str());
    ratios.push_back(change.ratio);
    slower += change.slower();
    faster += change.faster();
    worse += !change.worse.empty();
  }
  for (const std::string& setting : compared.gone) std::printf("only in the earlier run: %s\n", setting.c_str());
  for (const std::string& setting : compared.arrived) std::printf("only in the later run: %s\n", setting.c_str());
  std::printf("%zu settings, median ratio %.3f; beyond the spread: %d slower, %d faster; worse otherwise: %d\n",
              ratios.size(), spread_of(ratios).median, slower, faster, worse);
}

}  // namespace insonate::bench
