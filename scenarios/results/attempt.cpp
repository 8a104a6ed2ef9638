#include "scenarios/results/attempt.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <utility>

#include "scenarios/result_json.h"
#include "scenarios/results/trace_json.h"

namespace insonate {

Attempt attempt_of(const Runner& runner, const ExamResult& result, std::string log) {
  Attempt attempt;
  attempt.scenario_text = runner.scenario().text;
  attempt.scenario_file = std::filesystem::absolute(runner.scenario().file).string();
  attempt.log = std::move(log);
  attempt.score_json = to_json(result);
  attempt.trace_json = to_json(runner.trace());
  return attempt;
}

std::int64_t now_since_1970_ms() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since_1970).count();
}

std::string utc_time(std::int64_t since_1970_ms) {
  const std::time_t seconds = std::time_t(since_1970_ms / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char date[32], text[48];
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(text, sizeof text, "%s.%03dZ", date, int(since_1970_ms % 1000));
  return text;
}

std::string file_time(std::int64_t since_1970_ms) {
  std::string time = utc_time(since_1970_ms).substr(0, 19) + "Z";
  std::replace(time.begin(), time.end(), ':', '-');
  return time;
}

}  // namespace insonate
