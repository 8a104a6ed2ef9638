#include "scenarios/metrics/motion_meter.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "sim/core/hash.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

MotionValues measured(const std::vector<ProbeSample>& samples) {
  MotionMeter meter;
  for (const ProbeSample& sample : samples) meter.feed(sample, true);
  return meter.values();
}

Pose at_mm(double x) {
  return {glm::dmat3(1.0), {x, 0, 0}};
}

/// 0 to 1 from `begin_s` on, in `duration_s`, as a hand goes: slow, fast, slow.
double reach(double t, double begin_s, double duration_s) {
  const double u = std::min(1.0, std::max(0.0, (t - begin_s) / duration_s));
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

}  // namespace

TEST_CASE("a slow straight way has its length and no movements") {
  const MotionValues values = measured(samples_of(10, 50, [](double t) { return at_mm(10 * t); }));
  CHECK(values.time_s == Approx(10));
  CHECK(values.path_length_mm == Approx(100));
  CHECK(values.angular_path_deg == Approx(0).margin(1e-6));
  CHECK(values.translational_movements == 0);
  CHECK(*values.of(Metric::skin_contact_percent) == Approx(100));
  CHECK(*values.of(Metric::dropout_percent) == 0);
}

TEST_CASE("turning on the spot far from the origin is turning and no way") {
  const glm::dvec3 spot(500, -800, 1200);
  const MotionValues values = measured(samples_of(3, 60, [&](double t) {
    return turned(80 * reach(t, 1, 1), {0.2, 1, -0.4}, spot);
  }));
  CHECK(values.path_length_mm == Approx(0).margin(1e-9));
  CHECK(values.angular_path_deg == Approx(80));
  CHECK(values.rotational_movements == 1);
  CHECK(values.translational_movements == 0);
}

TEST_CASE("movements are counted, and a short rest does not split one") {
  // 60 mm in half a second each: 225 mm/s at the fastest. Faster than 50 mm/s from 0.06 s to 0.44 s of each.
  const auto moves = [](double pause_s) {
    return measured(
               samples_of(4, 100,
                          [&](double t) { return at_mm(60 * (reach(t, 0.5, 0.5) + reach(t, 1.0 + pause_s, 0.5))); }))
        .translational_movements;
  };
  CHECK(moves(0.0) == 1);
  CHECK(moves(0.5) == 2);
}

TEST_CASE("a rest of just the time that ends a movement ends it at any moment of a scan") {
  // Two steps of the grid at 100 mm/s, then a rest; over and over, so that the rests' ends round both ways.
  const auto moves = [](int rest_steps, int first_step) {
    const double period_s = (2 + rest_steps) / MotionMeter::kRate_hz, begin_s = first_step / MotionMeter::kRate_hz;
    return measured(samples_of(begin_s + 12 * period_s, MotionMeter::kRate_hz,
                               [&](double t) {
                                 double x = 0;
                                 for (int i = 0; i < 12; ++i)
                                   x += 10 * std::clamp((t - begin_s - i * period_s) / 0.1, 0.0, 1.0);
                                 return at_mm(x);
                               }))
        .translational_movements;
  };
  for (int first = 0; first < 7; ++first) {
    CAPTURE(first);
    CHECK(moves(4, first) == 12);
    CHECK(moves(3, first) == 1);
  }
}

TEST_CASE("path and movements hardly depend on the sampling rate") {
  const auto pose = [](double t) {
    const double sweep = 40 * std::sin(1.7 * t);
    return turned(25 * std::sin(1.1 * t), {1, 0.3, 0}, {sweep, 5 * std::cos(2.3 * t), 30 * reach(t, 3, 0.8)});
  };
  const MotionValues fine = measured(samples_of(8, 1000, pose));
  for (const double rate : {30.0, 60.0, 250.0}) {
    const MotionValues values = measured(samples_of(8, rate, pose));
    INFO(rate);
    // Chords between samples at 30 Hz are shorter than the arcs by less than 1 in 500 at these curvatures.
    CHECK(values.path_length_mm == Approx(fine.path_length_mm).epsilon(0.003));
    CHECK(values.angular_path_deg == Approx(fine.angular_path_deg).epsilon(0.003));
    CHECK(values.translational_movements == fine.translational_movements);
    CHECK(values.rotational_movements == fine.rotational_movements);
  }
}

TEST_CASE("a tracker's noise does not add up with its rate") {
  // 0.1 mm of noise; taken from sample to sample, 250 Hz would make 28 mm of way a second out of it.
  std::uint32_t state = 1;
  const auto noise = [&] {
    state = state * 1664525u + 1013904223u;
    return 0.2 * (state / 4294967296.0 - 0.5);
  };
  const auto still = [&](double rate) {
    return measured(samples_of(10, rate, [&](double) { return at_mm(noise()); })).path_length_mm;
  };
  CHECK(still(250) < 1.2 * still(40));
}

TEST_CASE("the origin of time does not matter") {
  // Losses of 0.25 s, of which nobody may say now that they are bridged and now that they are not.
  auto samples = samples_of(5, 60, [](double t) { return at_mm(50 * std::sin(t)); });
  for (long i = 19; i + 14 < long(samples.size()); i += 20)
    samples.erase(samples.begin() + i, samples.begin() + i + 14);
  const MotionValues before = measured(samples);
  REQUIRE(before.tracked_s == Approx(5));
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    const double begin_s = 1.7e9 + hash(trial, 1) / 4294967296.0;
    std::vector<ProbeSample> later = samples;
    for (ProbeSample& sample : later) sample.time_s += begin_s;
    const MotionValues after = measured(later);
    CAPTURE(begin_s);
    // A double holds seconds since 1970 to 0.24 microseconds, at 50 mm/s a way of 12 nm a sample.
    CHECK(after.path_length_mm == Approx(before.path_length_mm).margin(1e-4));
    CHECK(after.time_s == Approx(before.time_s).margin(1e-6));
    CHECK(after.tracked_s == Approx(before.tracked_s).margin(1e-4));
    CHECK(after.dropouts == before.dropouts);
    CHECK(after.translational_movements == before.translational_movements);
  }
}

TEST_CASE("invalid poses never count, and lost time is named") {
  auto samples = samples_of(10, 50, [](double t) { return at_mm(10 * t); });
  // A short loss from 2.0 to 2.1 s, a long one from 5 to 6 s; what the poses then say is nonsense.
  for (ProbeSample& sample : samples)
    if ((sample.time_s > 1.999 && sample.time_s < 2.101) || (sample.time_s > 4.999 && sample.time_s < 6.001)) {
      sample.status = PoseStatus::out_of_view;
      sample.patient_from_probe = at_mm(1e5);
    }
  const MotionValues values = measured(samples);
  CHECK(values.dropouts == 2);
  // Six and 51 samples are missing: 0.14 s between the valid ones around the first, 1.04 s around the second.
  CHECK(values.untracked_s == Approx(0.14 - 0.02 + 1.04 - 0.02).margin(0.041));
  CHECK(values.tracked_s + values.untracked_s == Approx(values.time_s));
  // The way over the short loss is interpolated, that over the long one is unknown: 10 mm less, and up to two steps of
  // the grid of 0.5 mm each at its ends.
  CHECK(values.path_length_mm == Approx(100 - 10.4).margin(1.0));
}

TEST_CASE("a tracker that falls silent is lost, too") {
  MotionMeter meter;
  meter.feed(sample_at(0, at_mm(0)), true);
  meter.feed(sample_at(0.1, at_mm(1)), true);
  meter.feed(sample_at(2.1, at_mm(500)), true);
  meter.feed(sample_at(2.2, at_mm(501)), false);
  CHECK(meter.values().dropouts == 1);
  CHECK(meter.values().untracked_s == Approx(2));
  CHECK(meter.values().path_length_mm == Approx(2));
  CHECK(*meter.values().of(Metric::skin_contact_percent) == Approx(75));
  meter.end(3.2);
  CHECK(meter.values().time_s == Approx(3.2));
  CHECK(meter.values().untracked_s == Approx(3));
}
