#include "sim/acoustics/spatial_response.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include "tests/acoustics/helpers.h"

using namespace insonate;
using test::piston;
using test::spectrum_of;
using Complex = std::complex<double>;

namespace {

const Sampling kSampling;

double wavenumber(double frequency_mhz) {
  return glm::two_pi<double>() * frequency_mhz / kSampling.speed_mm_us;
}

// The Rayleigh integral of a piston by the midpoint rule, with the frequency's phase: what the spectrum of its response
// must be. Its own error is below 1e-5 with these many points.
Complex rayleigh_integral(const Rectangle& rectangle, const glm::dvec3& point, double frequency_mhz, int points = 600) {
  const double k = wavenumber(frequency_mhz);
  const double width = rectangle.width_mm / points, height = rectangle.height_mm / points;
  Complex sum = 0;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      const glm::dvec3 part = rectangle.centre + ((i + 0.5) * width - rectangle.width_mm / 2) * rectangle.lateral +
                              ((j + 0.5) * height - rectangle.height_mm / 2) * rectangle.elevation;
      const double r = glm::distance(part, point);
      sum += std::polar(width * height / (glm::two_pi<double>() * r), -k * r);
    }
  return sum;
}

double integral(const SampledResponse& response) {
  return std::accumulate(response.samples.begin(), response.samples.end(), 0.0) * kSampling.step_us();
}

// The response at a time, between samples.
double value_at(const SampledResponse& response, double time_us) {
  const double place = time_us * kSampling.per_us - double(response.first);
  const auto before = std::size_t(place);
  REQUIRE(before + 1 < response.samples.size());
  const double share = place - double(before);
  return (1 - share) * response.samples[before] + share * response.samples[before + 1];
}

SampledResponse exact(const Aperture& aperture, const glm::dvec3& point) {
  return spatial_response(aperture, point, kSampling, RectangleMethod::exact);
}

}  // namespace

TEST_CASE("the exact response of a rectangle is its Rayleigh integral") {
  // Echoes of 5 MHz and less meet at most 0.5 % of what folds back from 95 MHz (sinc^2 of 0.95 and 0.05), and a
  // rectangle's response has less there.
  constexpr double kFoldedBack = 0.005;
  Rectangle rectangle = piston(2.1, 5.3);
  rectangle.centre = {0.3, -0.2, 0.1};
  for (const glm::dvec3& point :
       {glm::dvec3(0.1, 4.7, -0.2), glm::dvec3(0.9, 12, 2.4), glm::dvec3(1.35, 3, 2.75), glm::dvec3(4, 6, 0),
        glm::dvec3(-3, 8, 5), glm::dvec3(0.2, 0.8, 7), glm::dvec3(0, 60, 0)})
    for (const double frequency : {0.0, 1.0, 2.5, 5.0}) {
      CAPTURE(point.x, point.y, point.z, frequency);
      const Complex expected = rayleigh_integral(rectangle, point, frequency);
      const Complex got = spectrum_of(exact({rectangle}, point), frequency, kSampling);
      CHECK(std::abs(got - expected) <= kFoldedBack * std::abs(rayleigh_integral(rectangle, point, 0, 60)));
    }
}

TEST_CASE("on the axis of a rectangle, the exact response is c times the arc's share of the circle") {
  const double half_width = 1.2, half_height = 3, depth = 9;
  const SampledResponse response = exact({piston(2 * half_width, 2 * half_height)}, {0, depth, 0});
  for (const double radius : {0.7, 1.0, 1.5, 2.5, 2.9, 3.1, 3.2}) {
    // Count points of the circle inside the rectangle.
    constexpr int kPoints = 100000;
    int inside = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double angle = glm::two_pi<double>() * (i + 0.5) / kPoints;
      if (std::abs(radius * std::cos(angle)) < half_width && std::abs(radius * std::sin(angle)) < half_height) ++inside;
    }
    const double time = std::hypot(depth, radius) / kSampling.speed_mm_us;
    CAPTURE(radius);
    // The hat averages over 10 ns, in which the share changes by up to 1 % of a circle.
    CHECK(value_at(response, time) / kSampling.speed_mm_us == Approx(double(inside) / kPoints).margin(0.01));
  }
}

TEST_CASE("on the axis of a disc, the pressure is the closed form of a circular piston") {
  // |p| = 2 rho c v |sin(k/2 (sqrt(z^2 + a^2) - z))| (Kinsler et al., Fundamentals of Acoustics, 7.4); here w |h|.
  constexpr double kRadius = 4;
  const Aperture aperture = test::disc(kRadius, 160);
  for (const double depth : {5.0, 9.0, 14.0, 20.0, 33.0, 52.0, 80.0, 160.0}) {
    const SampledResponse response = exact(aperture, {0, depth, 0});
    for (const double frequency : {1.0, 2.5, 3.5}) {
      const double phase = wavenumber(frequency) / 2 * (std::hypot(depth, kRadius) - depth);
      const double pressure = glm::two_pi<double>() * frequency * std::abs(spectrum_of(response, frequency, kSampling));
      CAPTURE(depth, frequency);
      // Strips leave teeth of a 40th of a millimetre at the edge: below 1 % of the maximum, 2 c.
      CHECK(pressure / (2 * kSampling.speed_mm_us) == Approx(std::abs(std::sin(phase))).margin(0.01));
    }
  }
}

TEST_CASE("far away, a rectangle has the directivity of two sincs") {
  const Rectangle rectangle = piston(1.1, 2.3);
  constexpr double kFar = 4000, kFrequency = 3;  // mm: 2.3^2 / (4 lambda) is 3 mm
  for (const auto method : {RectangleMethod::exact, RectangleMethod::far_field})
    for (const double degrees : {0.0, 5.0, 11.0, 23.0, 40.0}) {
      const double angle = glm::radians(degrees);
      const glm::dvec3 direction = glm::normalize(glm::dvec3(std::sin(angle), std::cos(angle), 0.4 * std::sin(angle)));
      const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(x) / x; };
      const double k = wavenumber(kFrequency);
      const double expected = rectangle.width_mm * rectangle.height_mm / (glm::two_pi<double>() * kFar) *
                              sinc(k * rectangle.width_mm / 2 * direction.x) *
                              sinc(k * rectangle.height_mm / 2 * direction.z);
      const SampledResponse response = spatial_response({rectangle}, kFar * direction, kSampling, method);
      const double on_axis = rectangle.width_mm * rectangle.height_mm / (glm::two_pi<double>() * kFar);
      CAPTURE(int(method), degrees);
      // The exact response on the axis is shorter than a step, and its fine steps of 0.6 ns move it by up to half one.
      CHECK(std::abs(spectrum_of(response, kFrequency, kSampling)) / on_axis ==
            Approx(std::abs(expected) / on_axis).margin(0.002));
    }
}

TEST_CASE("trapezoids of smaller and smaller rectangles approach the exact response") {
  const Rectangle whole = piston(3, 6);
  const glm::dvec3 point(1, 7, 2);
  constexpr double kFrequency = 4;
  const Complex expected = rayleigh_integral(whole, point, kFrequency);
  std::vector<double> errors;
  for (const int parts : {4, 8, 16, 32}) {
    Aperture aperture;
    for (int i = 0; i < parts; ++i)
      for (int j = 0; j < parts; ++j) {
        Rectangle part = piston(3.0 / parts, 6.0 / parts);
        part.centre = {(i + 0.5) * 3.0 / parts - 1.5, 0, (j + 0.5) * 6.0 / parts - 3};
        aperture.push_back(part);
      }
    const SampledResponse response = spatial_response(aperture, point, kSampling, RectangleMethod::far_field);
    errors.push_back(std::abs(spectrum_of(response, kFrequency, kSampling) - expected) / std::abs(expected));
  }
  // A linear front about the mean distance leaves out the fourth order of a side: halving it divides the error by 16,
  // once the phase across a rectangle is small. What folds back in sampling remains.
  CAPTURE(errors);
  CHECK(errors[1] < errors[0] / 3);
  CHECK(errors[2] < errors[1] / 12);
  CHECK(errors[3] < 5e-4);
}

TEST_CASE("the integral of a trapezoid is its rectangle's area over 2 pi r") {
  for (const glm::dvec3& point : {glm::dvec3(0, 20, 0), glm::dvec3(7, 12, -3)}) {
    const double expected = 0.3 * 0.7 / (glm::two_pi<double>() * glm::length(point));
    CHECK(integral(spatial_response({piston(0.3, 0.7)}, point, kSampling, RectangleMethod::far_field)) ==
          Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("delay, weight and the lens act on the response") {
  const glm::dvec3 point(0.4, 15, 0.2);
  for (const auto method : {RectangleMethod::exact, RectangleMethod::far_field}) {
    Rectangle rectangle = piston(0.5, 0.5);
    const Complex plain = spectrum_of(spatial_response({rectangle}, point, kSampling, method), 4, kSampling);
    rectangle.delay_us = 1.237;
    rectangle.weight = -0.25;
    const Complex changed = spectrum_of(spatial_response({rectangle}, point, kSampling, method), 4, kSampling);
    // At 4 MHz, what folds back from 96 MHz is up to 0.2 %, of a phase that depends on the delay.
    CHECK(std::abs(changed / plain + 0.25 * std::polar(1.0, -glm::two_pi<double>() * 4 * 1.237)) < 0.25 * 0.004);
  }
  // A lens that tilts a rectangle's front towards a point lets all of it arrive at once there.
  Rectangle rectangle = piston(1e-3, 4);
  const glm::dvec3 aside = 300.0 * glm::normalize(glm::dvec3(0, 1, 0.3));
  rectangle.slope = aside.z / 300 / kSampling.speed_mm_us;
  CHECK(trapezoid_of(rectangle, aside, kSampling.speed_mm_us).wide_us < 1e-3);
  rectangle.slope = 0;
  CHECK(trapezoid_of(rectangle, aside, kSampling.speed_mm_us).wide_us ==
        Approx(4 * aside.z / 300 / kSampling.speed_mm_us));
}

TEST_CASE("two pistons hear each other alike") {
  // The mean of a's response over b's face, times b's area, is the mean of b's over a's face, times a's area.
  const Rectangle a = piston(1, 2.4);
  Rectangle b = piston(2, 0.7);
  b.centre = {3, 11, 1};
  constexpr int kPoints = 24;
  const auto heard = [&](const Rectangle& sender, const Rectangle& receiver) {
    Complex sum = 0;
    for (int i = 0; i < kPoints; ++i)
      for (int j = 0; j < kPoints; ++j) {
        const glm::dvec3 at = receiver.centre + glm::dvec3(((i + 0.5) / kPoints - 0.5) * receiver.width_mm, 0,
                                                           ((j + 0.5) / kPoints - 0.5) * receiver.height_mm);
        sum += spectrum_of(exact({sender}, at), 2, kSampling);
      }
    return sum * (receiver.width_mm * receiver.height_mm / (kPoints * kPoints));
  };
  const Complex there = heard(a, b), back = heard(b, a);
  CHECK(std::abs(there - back) < 2e-3 * std::abs(there));  // folding back and the midpoint rule
}

TEST_CASE("a disc radiates the power that its radiation resistance takes") {
  // Power over a far hemisphere, with |p| = rho w |h| for a unit velocity:  integral of |p|^2 / (2 rho c)  equals
  // half of rho c S (1 - J1(2ka) / (ka)) (Kinsler et al., Fundamentals of Acoustics, 7.5).
  constexpr double kRadius = 0.5, kFar = 500;
  const Aperture aperture = test::disc(kRadius, 48);
  for (const double frequency : {0.5, 1.0, 2.0}) {
    const double k = wavenumber(frequency), ka = k * kRadius;
    constexpr int kAngles = 48;
    double power = 0;
    for (int i = 0; i < kAngles; ++i) {
      const double angle = glm::half_pi<double>() * (i + 0.5) / kAngles;
      const double ring = glm::two_pi<double>() * kFar * kFar * std::sin(angle) * glm::half_pi<double>() / kAngles;
      const glm::dvec3 point = kFar * glm::dvec3(std::sin(angle), std::cos(angle), 0);
      const double w = glm::two_pi<double>() * frequency;
      power +=
          ring * std::norm(w * spectrum_of(exact(aperture, point), frequency, kSampling)) / (2 * kSampling.speed_mm_us);
    }
    const double face = glm::pi<double>() * kRadius * kRadius;
    const double resistance = kSampling.speed_mm_us * face * (1 - std::cyl_bessel_j(1, 2 * ka) / ka);
    CAPTURE(frequency);
    CHECK(power == Approx(resistance / 2).epsilon(0.01));  // rings and strips
  }
}

TEST_CASE("the convolution of two responses multiplies their spectra") {
  const SampledResponse a = spatial_response({piston(0.5, 3)}, {3, 12, 1}, kSampling, RectangleMethod::far_field);
  const SampledResponse b = spatial_response({piston(1, 2)}, {-2, 9, 2}, kSampling, RectangleMethod::far_field);
  const SampledResponse both = convolved(a, b, kSampling);
  const double hat = hat_spectrum(3, kSampling);
  CHECK(std::abs(spectrum_of(both, 3, kSampling) * hat -
                 spectrum_of(a, 3, kSampling) * spectrum_of(b, 3, kSampling) * hat * hat) < 1e-12);
  CHECK(convolved({}, b, kSampling).samples.empty());
}

TEST_CASE("an aperture without rectangles is silent") {
  CHECK(spatial_response({}, {0, 1, 0}, kSampling, RectangleMethod::exact).samples.empty());
  CHECK(spatial_response({}, {0, 1, 0}, kSampling, RectangleMethod::far_field).samples.empty());
}
