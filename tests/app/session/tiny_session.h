#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/session/session.h"
#include "devices/replay/replay_tracker.h"
#include "scenarios/result_json.h"
#include "tests/scenarios/tiny_case.h"

/// Sessions with the tiny case, and scans of it.
namespace insonate {

inline std::shared_ptr<const LoadedCase> tiny_loaded_case(bool with_exam = true) {
  auto loaded_case = std::make_shared<LoadedCase>();
  loaded_case->subject = tiny_case();
  loaded_case->patient = "Tiny";
  loaded_case->tissues = tiny_tissues();
  if (with_exam) loaded_case->scenario = parse_scenario(kTinyScenario, "exam.toml");
  loaded_case->surroundings.start.translation = {0, 0, -40};
  return loaded_case;
}

/// A scan that finds the ball after some searching, with losses of tracking on the way.
inline std::vector<ProbeSample> searching_scan() {
  auto samples = samples_of(9, 60, [](double t) {
    const double off = 25 * std::exp(-t / 2) * std::sin(2 * t) + 3;
    return turned(10 * std::sin(t) * std::exp(-t / 3), {1, 0.4, 0}, {4 * std::sin(0.7 * t), 0.5, off});
  });
  for (ProbeSample& sample : samples)
    if (std::fmod(sample.time_s + 1, 3.1) < 0.2) sample.status = PoseStatus::missing;
  return samples;
}

inline Session::OpenTracker replay_of(std::vector<ProbeSample> samples) {
  return [samples = std::move(samples)] {
    return std::make_unique<ReplayTracker>("a log", samples, ReplayTracker::Options{});
  };
}

/// Returns a runner's score as that of a session without a file.
inline std::string score_of(const Runner& runner) {
  ExamResult result = runner.result();
  result.provenance.mode = AttemptMode::practice;
  return to_json(result);
}

/// Advances with `steps_per_s` steps per second. Returns the time of the last step, s.
inline double run_until(Session& session, double from_s, double to_s, double steps_per_s = 60) {
  for (long i = 1; from_s + i / steps_per_s <= to_s + 1e-9; ++i) session.advance(from_s + i / steps_per_s);
  return to_s;
}

/// A live tracker without a thread: returns what the test puts into `coming`, which must outlive it.
class HandFed : public Tracker {
public:
  explicit HandFed(std::vector<ProbeSample>& coming, bool relative = false)
      : Tracker("a device"), coming_(coming), relative_(relative) {}
  bool live() const override { return true; }
  bool relative() const override { return relative_; }
  double clock_s(double now_s) const override { return now_s; }

protected:
  void collect(double, std::vector<ProbeSample>& samples) override {
    samples.insert(samples.end(), coming_.begin(), coming_.end());
    coming_.clear();
  }

private:
  std::vector<ProbeSample>& coming_;
  bool relative_;
};

}  // namespace insonate
