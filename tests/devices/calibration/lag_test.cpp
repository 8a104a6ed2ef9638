#include "devices/calibration/lag.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/devices/calibration/synthetic.h"

using namespace insonate;

namespace {

/// When the key is struck: 12 blows with uneven pauses.
std::vector<double> blows(Dice& dice) {
  std::vector<double> times;
  for (double time_s = 1.3; times.size() < 12; time_s += dice.uniform(0.6, 1.3)) times.push_back(time_s);
  return times;
}

/// The height of a probe that strikes: raised in 250 ms and let down in 120 ms, the way a hand does it, stopped by the
/// key.
double height_mm(double time_s, const std::vector<double>& times) {
  for (const double at_s : times) {
    const double before_s = at_s - time_s;
    if (before_s < 0 || before_s > 0.42) continue;
    if (before_s < 0.12) return 40 * (1 - std::pow(1 - before_s / 0.12, 2));  // fastest at the key
    const double raising = std::clamp((0.42 - before_s) / 0.25, 0.0, 1.0);
    return 40 * (3 - 2 * raising) * raising * raising;
  }
  return 0;
}

/// What a tracker shows that is late by `lag_s`.
std::vector<SensorSample> tracked(Dice& dice, const std::vector<double>& times, double lag_s, double rate_hz,
                                  double noise_mm) {
  const glm::dvec3 down = glm::normalize(dice.point(1)), rest = dice.point(300);
  std::vector<SensorSample> samples;
  for (int i = 0; i / rate_hz < times.back() + 2; ++i) {
    SensorSample sample{i / rate_hz, PoseStatus::ok, {}, 0};
    sample.tracker_from_sensor.translation =
        rest - down * height_mm(sample.time_s - lag_s, times) + dice.noise(noise_mm);
    samples.push_back(sample);
  }
  return samples;
}

Signal sine(double begin_s, double late_s, double (*shape)(double)) {
  Signal signal{begin_s, 0.005, {}};
  for (int i = 0; i < 2000; ++i) signal.values.push_back(shape(begin_s + i * 0.005 - late_s));
  return signal;
}

double uneven(double t) {
  return std::sin(3 * t) + std::sin(7.3 * t + 1) + 0.5 * std::sin(17 * t + 2);
}

}  // namespace

TEST_CASE("the lag of a tracker is found from blows on a key, at any rate and any lag") {
  Dice dice(1);
  for (const double rate_hz : {60.0, 120.0, 240.0})
    for (const double lag_s : {0.0, 0.012, 0.047, 0.25, 0.4}) {
      const std::vector<double> times = blows(dice);
      const auto found = knock_lag(tracked(dice, times, lag_s, rate_hz, 0.1), times);
      CAPTURE(rate_hz, lag_s, found.refusal());
      REQUIRE(found);
      CAPTURE(found->lag_s, found->spread_s);
      // A stop between two samples of a 60 Hz tracker is known to within 17 ms, its mean over 12 to 5.
      CHECK(std::abs(found->lag_s - lag_s) < 0.008);
      CHECK(found->spread_s < 0.02);
      CHECK(found->knocks == 12);
    }
}

TEST_CASE("samples that are not ok do not count as motion") {
  Dice dice(2);
  const std::vector<double> times = blows(dice);
  auto samples = tracked(dice, times, 0.05, 120, 0.1);
  for (std::size_t i = 0; i < samples.size(); i += 7) samples[i] = {samples[i].time_s, PoseStatus::missing, {}, 0};
  const auto found = knock_lag(samples, times);
  REQUIRE(found);
  CHECK(std::abs(found->lag_s - 0.05) < 0.008);
}

TEST_CASE("one signal against another: the lag between them, wherever each begins") {
  for (const double lag_s : {-0.08, 0.0, 0.0132, 0.3}) {
    const auto found = lag_between(sine(5.0, lag_s, uneven), sine(4.7031, 0, uneven));
    REQUIRE(found);
    CHECK(std::abs(found->lag_s - lag_s) < 0.001);  // a fifth of a step
    CHECK(found->correlation > 0.9);
  }
}

TEST_CASE("motions that do not determine the lag are refused") {
  using Catch::Contains;
  Dice dice(3);
  const std::vector<double> times = blows(dice);
  const auto samples = tracked(dice, times, 0.05, 120, 0.1);
  CHECK_THAT(knock_lag(samples, std::span(times).first(7)).refusal(), Contains("7 blows"));
  CHECK_THAT(knock_lag({}, times).refusal(), Contains("not seen"));
  // A probe that lies still while the key is pressed by hand.
  CHECK_FALSE(knock_lag(tracked(dice, {-9, 40}, 0.05, 120, 0.1), times));
  // A beat of 0.3 s is itself again 0.3 s later.
  CHECK_THAT(lag_between(sine(0, 0.05, [](double t) { return std::sin(2 * 3.14159265 * t / 0.3); }),
                         sine(0, 0, [](double t) { return std::sin(2 * 3.14159265 * t / 0.3); }))
                 .refusal(),
             Contains("too steady"));
  CHECK_THAT(lag_between(sine(0, 0, [](double) { return 1.0; }), sine(0, 0, uneven)).refusal(),
             Contains("do not show in the tracker's motion"));
  CHECK_FALSE(lag_between({}, sine(0, 0, uneven)));
  Signal coarse = sine(0, 0, uneven);
  coarse.step_s = 0.01;
  CHECK_THROWS_AS(lag_between(coarse, sine(0, 0, uneven)), std::invalid_argument);
}
