#include "scenarios/metrics/smoothness.h"

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <functional>

#include "scenarios/metrics/motion_meter.h"
#include "sim/core/hash.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

constexpr double kRate_hz = 20;

Smoothness moved(double duration_s, const std::function<glm::dvec3(double)>& at) {
  Smoothness smoothness(kRate_hz);
  for (int i = 0; i <= int(std::lround(duration_s * kRate_hz)); ++i) smoothness.feed(at(i / kRate_hz), i > 0);
  return smoothness;
}

/// A reach of minimum jerk over a way in x.
glm::dvec3 reach(double t, double duration_s, double way_mm) {
  const double s = std::clamp(t / duration_s, 0.0, 1.0);
  return {way_mm * s * s * s * (10 - 15 * s + 6 * s * s), 0, 0};
}

/// Three reaches with a stop after each.
glm::dvec3 in_steps(double t) {
  return reach(t, 1.2, 40) + reach(t - 1.4, 1.2, 40) + reach(t - 2.8, 1.2, 40);
}

}  // namespace

TEST_CASE("a minimum-jerk reach is as smooth as its formula says") {
  // With speed v = 30 s^2 (1 - s)^2 of a reach of length and time 1: peak 15/8, integral of v''^2 720, so that the
  // dimensionless jerk is 720 / (15/8)^2 = 204.8. A rest of a second before and after makes the time 7.8 s instead of
  // 6, of which the jerk has the third power. The smoothing rounds the jerk's steps at both ends, where it is largest.
  CHECK(*moved(8, [](double t) { return reach(t - 1, 6, 100); }).log_dimensionless_jerk() ==
        Approx(-std::log(204.8 * std::pow(7.8 / 6, 3))).margin(0.15));
  // The spectral arc length of such a reach is -1.41 with the paper's settings; rests before and after change nothing
  // but where its spectrum is sampled.
  CHECK(*moved(4, [](double t) { return reach(t - 1, 2, 100); }).spectral_arc_length() == Approx(-1.41).margin(0.08));
}

TEST_CASE("the spectral arc length of a jump is that of the smoothing's spectrum") {
  // The speeds of a jump are the smoothing's weights, of magnitude cos^4(w/2) at w radians per sample. The transform of
  // 55 speeds has 256 samples, and up to sample 87 the magnitude is above 5 %.
  const auto magnitude = [](double share) { return std::pow(std::cos(glm::pi<double>() * 87 / 256 * share), 4); };
  REQUIRE(magnitude(1) > 0.05);
  REQUIRE(magnitude(88.0 / 87) < 0.05);
  double length = 0;
  constexpr int kPieces = 100000;
  for (int i = 0; i < kPieces; ++i)
    length += std::hypot(1.0 / kPieces, magnitude((i + 1.0) / kPieces) - magnitude(double(i) / kPieces));
  const Smoothness jump = moved(59 / kRate_hz, [](double t) { return glm::dvec3(t < 1.51 ? 0 : 30, 0, 0); });
  CHECK(*jump.spectral_arc_length() == Approx(-length).margin(1e-4));
}

TEST_CASE("smoothness does not depend on how far, how fast or where to the hand moves") {
  const Smoothness reference = moved(8, [](double t) { return reach(t - 1, 6, 100); });
  const auto check = [&](const Smoothness& other, double margin) {
    CHECK(*other.log_dimensionless_jerk() == Approx(*reference.log_dimensionless_jerk()).margin(margin));
    CHECK(*other.spectral_arc_length() == Approx(*reference.spectral_arc_length()).margin(margin));
  };
  check(moved(8, [](double t) { return reach(t - 1, 6, 37); }), 1e-9);
  const Pose away = turned(77, {1, 2, 3}, {500, -900, 1300});
  check(moved(8, [&](double t) { return away.point(reach(t - 1, 6, 100)); }), 1e-6);  // third differences of rounding
  // Half as many samples describe the same reach; the smoothing takes a little more of it.
  check(moved(4, [](double t) { return reach(t - 0.5, 3, 100); }), 0.3);
}

TEST_CASE("stops and tremor make a movement less smooth") {
  const Smoothness one = moved(4, [](double t) { return reach(t, 4, 120); });
  const Smoothness three = moved(4, in_steps);
  const Smoothness shaking =
      moved(4, [](double t) { return reach(t, 4, 120) + glm::dvec3(0, 8 * std::sin(12 * t), 0); });
  for (const Smoothness& worse : {three, shaking}) {
    CHECK(*worse.log_dimensionless_jerk() < *one.log_dimensionless_jerk() - 1);
    CHECK(*worse.spectral_arc_length() < *one.spectral_arc_length() - 0.2);
  }
  CHECK_FALSE(moved(4, [](double) { return glm::dvec3(1, 2, 3); }).spectral_arc_length());
  CHECK_FALSE(moved(0.05, [](double t) { return reach(t, 4, 120); }).log_dimensionless_jerk());
}

TEST_CASE("smoothness does not depend on the tracker's rate or on where time begins") {
  const auto values = [](double rate_hz, double begin_s) {
    MotionMeter meter;
    for (int i = 0; i <= int(4 * rate_hz); ++i)
      meter.feed(sample_at(begin_s + i / rate_hz, {glm::dmat3(1.0), in_steps(i / rate_hz)}), true);
    return meter.values();
  };
  const MotionValues fine = values(400, 0);
  for (const double rate_hz : {40.0, 60.0, 125.0}) {
    CAPTURE(rate_hz);
    // Between samples 1/40 s apart the way is a chord of a curve that bends by up to 160 mm/s2: off by 0.013 mm.
    CHECK(*values(rate_hz, 0).log_dimensionless_jerk == Approx(*fine.log_dimensionless_jerk).margin(0.05));
    CHECK(*values(rate_hz, 0).spectral_arc_length == Approx(*fine.spectral_arc_length).margin(0.05));
    CHECK(*values(rate_hz, 1.7e9 + 0.37).log_dimensionless_jerk == Approx(*fine.log_dimensionless_jerk).margin(0.05));
  }
}
