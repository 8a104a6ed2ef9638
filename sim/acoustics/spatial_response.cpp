#include "sim/acoustics/spatial_response.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonate {
namespace {

// Times shorter than this share of a step are lengthened to it. That changes no sample, and keeps the differences of
// cubes in sum_of() exact.
constexpr double kShortest = 0.01;
// Steps into which exact responses are divided, so that a hat can be laid over their closed form.
constexpr int kFineSteps = 16;

double cubed_above_0(double x) {
  const double positive = std::max(x, 0.0);
  return positive * positive * positive;
}

std::int64_t step_at(double time_us, const Sampling& sampling) {
  return std::int64_t(std::floor(time_us * sampling.per_us));
}

SampledResponse silent(double begin_us, double end_us, const Sampling& sampling) {
  SampledResponse response;
  response.first = step_at(begin_us, sampling) - 1;
  response.samples.assign(std::size_t(step_at(end_us, sampling) + 3 - response.first), 0.0);
  return response;
}

// A point as seen from a rectangle: the distance from its plane, and where the foot of that distance lies among its
// edges.
struct Foot {
  double height;       // from the plane, mm
  double left, right;  // edges along the width, from the foot, mm
  double bottom, top;  // edges along the height
};

Foot foot_of(const Rectangle& rectangle, const glm::dvec3& point) {
  const glm::dvec3 to_point = point - rectangle.centre;
  const double x = glm::dot(to_point, rectangle.lateral), z = glm::dot(to_point, rectangle.elevation);
  return {std::abs(glm::dot(to_point, glm::cross(rectangle.lateral, rectangle.elevation))), -rectangle.width_mm / 2 - x,
          rectangle.width_mm / 2 - x, -rectangle.height_mm / 2 - z, rectangle.height_mm / 2 - z};
}

// Returns the integral of acos(side / rho) over the radius R of the sphere, from where it first meets the line at that
// distance from the foot; rho^2 = R^2 - height^2 is the radius of its circle in the plane. By parts, with
// s = sqrt(R^2 - q^2), q^2 = height^2 + side^2:
//     R atan(s / side) - height atan(height s / (side R)) - side asinh(s / q)
// Differences are written as products here, because far away R, q and height hardly differ.
double beyond_line(double height, double side, double radius) {
  const double q = std::hypot(height, side);
  if (radius <= q) return 0;
  const double s = std::sqrt((radius - q) * (radius + q)), rise = radius - height;
  return rise * std::atan2(s, side) + height * std::atan2(s * side * rise, side * side * radius + s * s * height) -
         side * std::asinh(s / q);
}

// Returns the integral over R, up to `radius`, of the angle of the arc within the corner [0, width] x [0, depth] of the
// plane, the foot at its origin.
double in_corner(double height, double width, double depth, double radius) {
  if (width <= 0 || depth <= 0) return 0;
  const double last = std::sqrt(height * height + width * width + depth * depth);
  const double r = std::clamp(radius, height, last);
  return glm::half_pi<double>() * (r - height) - beyond_line(height, width, r) - beyond_line(height, depth, r);
}

// Returns the integral of h from its beginning to the time at which the sphere has `radius`, mm.
double exact_integral(const Foot& foot, double radius) {
  const auto signed_corner = [&](double x, double z) {
    const double sign = (x < 0) == (z < 0) ? 1 : -1;
    return sign * in_corner(foot.height, std::abs(x), std::abs(z), radius);
  };
  return (signed_corner(foot.right, foot.top) - signed_corner(foot.left, foot.top) -
          signed_corner(foot.right, foot.bottom) + signed_corner(foot.left, foot.bottom)) /
         glm::two_pi<double>();
}

struct Span {
  double begin_us, end_us;
};

Span exact_span(const Rectangle& rectangle, const Foot& foot, double speed) {
  const auto nearest = [](double low, double high) { return low > 0 ? low : high < 0 ? -high : 0.0; };
  const auto farthest = [](double low, double high) { return std::max(std::abs(low), std::abs(high)); };
  const double near = std::hypot(foot.height, nearest(foot.left, foot.right), nearest(foot.bottom, foot.top));
  const double far = std::hypot(foot.height, farthest(foot.left, foot.right), farthest(foot.bottom, foot.top));
  return {rectangle.delay_us + near / speed, rectangle.delay_us + far / speed};
}

void add_exact(SampledResponse& response, const Rectangle& rectangle, const Foot& foot, const Span& span,
               const Sampling& sampling) {
  const double step = sampling.step_us(), fine = step / kFineSteps;
  const std::int64_t from = step_at(span.begin_us, sampling), to = step_at(span.end_us, sampling) + 1;
  double before = 0;
  for (std::int64_t k = from; k < to; ++k)
    for (int i = 0; i < kFineSteps; ++i) {
      const double end_us = double(k) * step + (i + 1) * fine;
      const double integral = exact_integral(foot, sampling.speed_mm_us * (end_us - rectangle.delay_us));
      const double part = rectangle.weight * (integral - before) * sampling.per_us, across = (i + 0.5) / kFineSteps;
      response.samples[std::size_t(k - response.first)] += part * (1 - across);
      response.samples[std::size_t(k - response.first) + 1] += part * across;
      before = integral;
    }
}

SampledResponse exact_response(const Aperture& aperture, const glm::dvec3& point, const Sampling& sampling) {
  std::vector<Foot> feet;
  std::vector<Span> spans;
  double begin = std::numeric_limits<double>::max(), end = std::numeric_limits<double>::lowest();
  for (const Rectangle& rectangle : aperture) {
    feet.push_back(foot_of(rectangle, point));
    spans.push_back(exact_span(rectangle, feet.back(), sampling.speed_mm_us));
    begin = std::min(begin, spans.back().begin_us);
    end = std::max(end, spans.back().end_us);
  }
  SampledResponse response = silent(begin, end, sampling);
  for (std::size_t i = 0; i < aperture.size(); ++i) add_exact(response, aperture[i], feet[i], spans[i], sampling);
  return response;
}

}  // namespace

double hat_spectrum(double frequency_mhz, const Sampling& sampling) {
  const double x = glm::pi<double>() * frequency_mhz * sampling.step_us();
  const double sinc = std::abs(x) < 1e-8 ? 1 : std::sin(x) / x;
  return sinc * sinc;
}

Trapezoid trapezoid_of(const Rectangle& rectangle, const glm::dvec3& point_mm, double speed_mm_us) {
  const glm::dvec3 to_point = point_mm - rectangle.centre;
  const double r = glm::length(to_point);
  const double lateral = glm::dot(to_point, rectangle.lateral) / r;
  const double elevation = glm::dot(to_point, rectangle.elevation) / r;
  const double across_width = rectangle.width_mm * std::abs(lateral) / speed_mm_us;
  const double across_height = rectangle.height_mm * std::abs(rectangle.slope - elevation / speed_mm_us);
  // The mean distance is longer than that of the middle: by the mean of the second derivative's term.
  const double longer = (rectangle.width_mm * rectangle.width_mm * (1 - lateral * lateral) +
                         rectangle.height_mm * rectangle.height_mm * (1 - elevation * elevation)) /
                        (24 * r);
  return {rectangle.delay_us + (r + longer) / speed_mm_us, std::max(across_width, across_height),
          std::min(across_width, across_height),
          rectangle.weight * rectangle.width_mm * rectangle.height_mm / (glm::two_pi<double>() * r)};
}

SampledResponse sum_of(const std::vector<Trapezoid>& trapezoids, const Sampling& sampling) {
  double begin = std::numeric_limits<double>::max(), end = std::numeric_limits<double>::lowest();
  for (const Trapezoid& one : trapezoids) {
    begin = std::min(begin, one.begin_us());
    end = std::max(end, one.end_us());
  }
  if (trapezoids.empty()) return {};
  SampledResponse response = silent(begin, end, sampling);
  const double step = sampling.step_us();
  for (const Trapezoid& one : trapezoids) {
    const double wide = std::max(one.wide_us, kShortest * step), narrow = std::max(one.narrow_us, kShortest * step);
    const double outer = (wide + narrow) / 2, inner = (wide - narrow) / 2;
    const double scale = one.area_mm / (6 * wide * narrow * step * step);
    // The integral of the integral of a trapezoid of area 1 is a sum of four cubes. Its second difference over the
    // steps is the mean weighted by the hat.
    const auto twice_integrated = [&](double t) {
      return cubed_above_0(t + outer) - cubed_above_0(t + inner) - cubed_above_0(t - inner) + cubed_above_0(t - outer);
    };
    const std::int64_t from = step_at(one.time_us - outer, sampling), to = step_at(one.time_us + outer, sampling) + 2;
    double before = 0, here = twice_integrated(double(from) * step - one.time_us);
    for (std::int64_t k = from; k < to; ++k) {
      const double after = twice_integrated(double(k + 1) * step - one.time_us);
      response.samples[std::size_t(k - response.first)] += scale * (after - 2 * here + before);
      before = here;
      here = after;
    }
  }
  return response;
}

SampledResponse spatial_response(const Aperture& aperture, const glm::dvec3& point_mm, const Sampling& sampling,
                                 RectangleMethod method) {
  if (aperture.empty()) return {};
  if (method == RectangleMethod::exact) return exact_response(aperture, point_mm, sampling);
  std::vector<Trapezoid> trapezoids;
  trapezoids.reserve(aperture.size());
  for (const Rectangle& rectangle : aperture)
    trapezoids.push_back(trapezoid_of(rectangle, point_mm, sampling.speed_mm_us));
  return sum_of(trapezoids, sampling);
}

SampledResponse convolved(const SampledResponse& a, const SampledResponse& b, const Sampling& sampling) {
  if (a.samples.empty() || b.samples.empty()) return {};
  SampledResponse both;
  both.first = a.first + b.first;
  both.samples.assign(a.samples.size() + b.samples.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    const double weight = a.samples[i] * sampling.step_us();
    if (weight == 0) continue;
    double* to = &both.samples[i];
    for (std::size_t k = 0; k < b.samples.size(); ++k) to[k] += weight * b.samples[k];
  }
  return both;
}

}  // namespace insonate
