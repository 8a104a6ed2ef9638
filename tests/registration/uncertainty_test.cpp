// Tests the uncertainty of a registration against values that follow by hand.

#include "sim/registration/uncertainty.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "sim/core/hash.h"

using namespace insonate;

TEST_CASE("the uncertainty of a paraboloid is that of its curvature") {
  // s = 0.6 - 0.001 (x0^2 + 4 x1^2 + x0 x1) - 0.002 (the rest): -log L = n/2 ln(1 - s), whose Hessian at the top is
  // n / (2 (1 - 0.6)) times that of -s.
  const double n = 1000, scale = n / (2 * 0.4);
  const EvaluateAll evaluate = [](std::span<const Parameters> all) {
    std::vector<double> values;
    for (const Parameters& x : all) {
      double s = 0.6 - 0.001 * (x[0] * x[0] + 4 * x[1] * x[1] + x[0] * x[1]);
      for (std::size_t i = 2; i < 6; ++i) s -= 0.002 * x[i] * x[i];
      values.push_back(s);
    }
    return values;
  };
  Motion motion;
  motion.radius_mm = 50;
  // At the centre, only translations move a point.
  const Uncertainty found = uncertainty_at(Parameters(6, 0.0), motion, evaluate, n, {glm::dvec3(0.0)});
  REQUIRE(found.is_maximum);
  const double a = 0.002 * scale, b = 0.008 * scale, c = 0.001 * scale, determinant = a * b - c * c;
  CHECK(found.deviation[0] == Approx(std::sqrt(b / determinant)));
  CHECK(found.deviation[1] == Approx(std::sqrt(a / determinant)));
  const double z = 1 / (0.004 * scale);
  CHECK(found.deviation[2] == Approx(std::sqrt(z)));
  CHECK(found.expected_error_mm == Approx(std::sqrt((a + b) / determinant + z)).epsilon(1e-4));
}

TEST_CASE("a saddle is not a maximum") {
  const EvaluateAll evaluate = [](std::span<const Parameters> all) {
    std::vector<double> values;
    for (const Parameters& x : all) {
      double s = 0.5 + 0.001 * x[5] * x[5];
      for (std::size_t i = 0; i < 5; ++i) s -= 0.002 * x[i] * x[i];
      values.push_back(s);
    }
    return values;
  };
  CHECK_FALSE(uncertainty_at(Parameters(6, 0.0), Motion{}, evaluate, 1000, {glm::dvec3(0.0)}).is_maximum);
}

TEST_CASE("white noise counts every pixel, and doubled pixels count less") {
  TrackedSweep white{Probe(*find_probe("linear")), 40, {}}, doubled = white;
  white.images.push_back({Pose{}, Image<float>(96, 96)});
  doubled.images.push_back({Pose{}, Image<float>(96, 96)});
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) {
      white.images[0].grey.at(x, y) = unit_float(hash(std::uint32_t(x), std::uint32_t(y)));
      doubled.images[0].grey.at(x, y) = unit_float(hash(std::uint32_t(x / 2), std::uint32_t(y)));
    }
  const double all = 95 * 95;
  CHECK(independent_pixels(white) / all > 0.9);
  // Every second pair of neighbours is equal, so r is about 1/2 and the share about (1 - r) / (1 + r) = 1/3.
  CHECK(independent_pixels(doubled) / all == Approx(1 / 3.0).margin(0.06));
}
