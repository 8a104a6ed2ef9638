#include "test_samples.h"
#include <catch2/catch.hpp>

#include <algorithm>

#include "devices/replay/replay_tracker.h"
#include "devices/synthetic/synthetic_tracker.h"

using namespace insonate;

namespace {

/// Half a minute of a hand at 60 Hz with its dropouts, its clock begun in 1970 as PLUS's is.
std::vector<ProbeSample> recorded() {
  SyntheticTracker hand(11, 60, {});
  std::vector<ProbeSample> samples = poll_until(hand, 30, 60);
  for (ProbeSample& sample : samples) sample.time_s += 1.7e9;
  return samples;
}

double duration(const std::vector<ProbeSample>& log) {
  return log.back().time_s - log.front().time_s;
}

}  // namespace

TEST_CASE("a replay gives the log's own samples to the bit, at any speed and however often it is polled") {
  const std::vector<ProbeSample> log = recorded();
  REQUIRE(std::any_of(log.begin(), log.end(), [](const ProbeSample& s) { return s.status != PoseStatus::ok; }));
  for (const double speed : {0.25, 0.5, 1.0, 2.0, 3.7, 64.0})
    for (const double polls_per_s : {0.3, 7.0, 59.94, 144.0, 1000.0}) {
      CAPTURE(speed, polls_per_s);
      ReplayTracker replay("log", log, {speed, false});
      // A poll's time is rounded, so the last sample may be due a hair after its time.
      const auto samples = poll_until(replay, duration(log) / speed + 1e-6, polls_per_s);
      CHECK(same_bits(samples, log));
      CHECK(replay.state().condition == TrackerCondition::finished);
      CHECK(replay.state().delivered == log.size());
    }
}

TEST_CASE("a replay's speed decides when a sample comes") {
  std::vector<ProbeSample> log(3);
  for (int i = 0; i < 3; ++i) log[std::size_t(i)].time_s = 100 + i;
  for (const double speed : {0.25, 1.0, 4.0}) {
    ReplayTracker replay("log", log, {speed, false});
    std::vector<ProbeSample> samples;
    const double start = 5;  // the clock that polls need not begin at 0
    replay.poll(start, samples);
    CHECK(samples.size() == 1);
    replay.poll(start + 0.99 / speed, samples);
    CHECK(samples.size() == 1);
    replay.poll(start + 1.01 / speed, samples);
    CHECK(samples.size() == 2);
    CHECK(replay.clock_s(start + 1.01 / speed) == Approx(101.01));
  }
}

TEST_CASE("a poll with a time before the last one brings nothing and loses nothing") {
  const std::vector<ProbeSample> log = recorded();
  ReplayTracker replay("log", log, {});
  std::vector<ProbeSample> samples;
  for (const double now : {0.0, 3.0, 1.0, 3.0, 2.9, 4.0, 31.0}) replay.poll(now, samples);
  CHECK(same_bits(samples, log));
}

TEST_CASE("a looping replay goes on with the log's poses and with times that rise by even steps") {
  std::vector<ProbeSample> log = recorded();
  log.resize(101);
  ReplayTracker replay("log", log, {1.0, true});
  const double round = duration(log) * 101 / 100;
  const auto samples = poll_until(replay, 2.5 * round, 60);
  REQUIRE(samples.size() >= 250);
  CHECK(same_bits({samples.begin(), samples.begin() + 101}, log));
  for (std::size_t i = 1; i < samples.size(); ++i) {
    CHECK(samples[i].time_s > samples[i - 1].time_s);
    CHECK(samples[i].time_s - samples[i - 1].time_s == Approx(1 / 60.0).margin(1e-6));
    CHECK(samples[i].patient_from_probe.translation == log[i % 101].patient_from_probe.translation);
  }
  CHECK(replay.state().condition != TrackerCondition::finished);
}

TEST_CASE("times that cannot be distinguished once a loop has shifted them still rise") {
  std::vector<ProbeSample> log(3);
  log[1].time_s = 1e-13;
  log[2].time_s = 1e3;
  ReplayTracker replay("log", log, {1.0, true});
  const auto samples = poll_until(replay, 4e3, 0.01);
  REQUIRE(samples.size() > 6);
  for (std::size_t i = 1; i < samples.size(); ++i) CHECK(samples[i].time_s > samples[i - 1].time_s);
}

TEST_CASE("a log that cannot be replayed in order is refused") {
  std::vector<ProbeSample> log(3);
  CHECK_THROWS_AS(ReplayTracker("log", log, {}), std::invalid_argument);
  CHECK_THROWS_AS(ReplayTracker("log", {}, {}), std::invalid_argument);
}
