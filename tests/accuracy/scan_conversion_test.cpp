// Tests scan conversion. A pattern given by a formula in the patient appears at its place, however the probe is rotated
// and shifted, to the accuracy of linear interpolation between lines and samples. Calipers measure it correctly.

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstdio>

#include "sim/wein/wein_reference.h"
#include "tests/accuracy/media.h"

using namespace insonate;
using namespace insonate::test;

namespace {

constexpr double kDepth = 100;

Pose turned_and_shifted() {
  Pose pose;
  pose.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), 2.1, glm::dvec3(0.3, -0.8, 0.5)));
  pose.translation = {37, -112, 64};
  return pose;
}

Probe with_lines(const char* name, int lines) {
  Probe probe = *find_probe(name);
  probe.lines = lines;
  return probe;
}

/// Returns settings with model W's echogenicity only: 0 at 0 HU, 1 at 200 HU.
WeinSettings echogenicity_alone(int samples, int width, int height) {
  WeinSettings settings;
  settings.samples = samples;
  settings.contact_mm = 0;
  settings.dark_hu = 0;
  settings.bright_hu = 200;
  settings.shadows = false;
  settings.reflection_share = 0;
  settings.image_width = width;
  settings.image_height = height;
  return settings;
}

/// Calls `visit(x, y, place in the probe's plane, line, sample)` for pixels that have lines and samples on either side.
template <typename Visit>
void for_each_pixel_between(const Probe& probe, int samples, int width, int height, Visit&& visit) {
  const ImageGeometry geometry = image_geometry(probe, kDepth, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 at = geometry.plane_mm(x, y);
      const auto place = line_position(probe, kDepth, at);
      if (!place || place->line < 0 || place->line > probe.lines - 1) continue;
      const double sample = place->r_mm * samples / kDepth - 0.5;
      if (sample < 0 || sample > samples - 1) continue;
      visit(x, y, at, place->r_mm);
    }
}

}  // namespace

TEST_CASE("model W: a pattern shows where it is, to bilinear accuracy, however the probe is turned and shifted") {
  constexpr int kLines = 96, kSamples = 160, kWidth = 150, kHeight = 110;
  // E = 1/2 + 0.4 sin(k . p) with a wavelength of 14 mm, and its first and second derivatives.
  const glm::dvec3 k = 2 * glm::pi<double>() / 14 * glm::normalize(glm::dvec3(1, 0.7, -0.5));
  const double slope = 0.4 * glm::length(k), curvature = 0.4 * glm::dot(k, k), dr = kDepth / kSamples;
  const WeinField field = [&](const glm::dvec3& p) {
    return WeinMedium{100 + 80 * std::sin(glm::dot(k, p)), glm::dvec3(0)};
  };
  for (const char* name : {"linear", "curvilinear", "phased"}) {
    const Probe probe = with_lines(name, kLines);
    const Pose pose = turned_and_shifted();
    const Image<double> image =
        wein_reference(field, probe, kDepth, echogenicity_alone(kSamples, kWidth, kHeight), pose).echogenicity;
    const bool fan = probe.kind != ProbeKind::linear;
    const double apart = fan ? glm::radians(probe.field_of_view_deg) / kLines : probe.width_mm / kLines;  // rad or mm
    double worst = 0, largest = 0;
    for_each_pixel_between(probe, kSamples, kWidth, kHeight, [&](int x, int y, const glm::dvec2& at, double r) {
      const double exact = 0.5 + 0.4 * std::sin(glm::dot(k, pose.point({at.x, at.y, 0})));
      // The error of linear interpolation over a step h is at most h^2/8 of the second derivative. Along an arc of
      // radius a that is a^2 of the curvature plus a of the slope.
      const double arm = fan ? r + apex_behind_mm(probe) : 0;
      const double across = fan ? arm * arm * curvature + arm * slope : curvature;
      const double bound = (dr * dr * curvature + apart * apart * across) / 8;
      const double error = std::abs(image.at(x, y) - exact);
      worst = std::max(worst, error / bound);
      largest = std::max(largest, error);
    });
    std::printf("pattern of 14 mm, %s: off by %.2g at most, %.2f of the bound\n", name, largest, worst);
    CHECK(worst <= 1);
    CHECK(worst > 0.1);  // shows that the bound could be broken
  }
}

TEST_CASE("model S: a pattern of absorption shows where it is, to bilinear accuracy") {
  constexpr int kLines = 64, kSamples = 200, kWidth = 120, kHeight = 120;
  // One impedance, so that nothing reflects. The absorption is 0.5 + 0.4 sin(k x) dB/(cm MHz) across the lines.
  const TissueTable table{{{0, 1.5, 0, 0}, {1000, 1.5, 1, 0}}, {}};
  const Probe probe = with_lines("linear", kLines);
  const Pose pose = turned_and_shifted();
  const double k = 2 * glm::pi<double>() / 9, dr = kDepth / kSamples, apart = probe.width_mm / kLines;
  Settings settings = without_absorption(dr);
  settings.absorption = true;
  settings.two_way = false;
  settings.blend = 1;  // then U is T, as there are neither echoes nor speckle
  settings.beam_lines = 1;
  settings.samples = kSamples;
  settings.image_width = kWidth;
  settings.image_height = kHeight;
  const MediumField field = [&](const glm::dvec3& p) {
    const double x = glm::dot(pose.rotation[0], p - pose.translation);
    return Medium{500 + 400 * std::sin(k * x), 0};
  };
  const Image<double> image = simulate_reference(field, table, probe, kDepth, settings, pose).fused;
  const double per_absorption = std::log(10) * settings.frequency_mhz / 100;
  double worst = 0, largest = 0;
  for_each_pixel_between(probe, kSamples, kWidth, kHeight, [&](int x, int y, const glm::dvec2& at, double r) {
    const double exact = std::exp(-per_absorption * (0.5 + 0.4 * std::sin(k * at.x)) * r);
    // For exp(-q(x) r) the bound is at most q^2 along r and (q' r)^2 + |q''| r across, where q is largest. A tenth is
    // added because the curvature varies within a step.
    const double q = 0.9 * per_absorption, q1 = 0.4 * k * per_absorption, q2 = 0.4 * k * k * per_absorption;
    const double least_lost = std::exp(-0.1 * per_absorption * r);
    const double bound = 1.1 * (dr * dr * q * q + apart * apart * (q1 * q1 * r * r + q2 * r)) * least_lost / 8;
    const double error = std::abs(image.at(x, y) - exact);
    worst = std::max(worst, error / bound);
    largest = std::max(largest, error);
  });
  std::printf("absorption in stripes of 9 mm: off by %.2g at most, %.2f of the bound\n", largest, worst);
  CHECK(worst <= 1);
  CHECK(worst > 0.1);
}

TEST_CASE("calipers on a picture measure an area to 1 %") {
  constexpr int kWidth = 640, kHeight = 480;
  constexpr double kRadius = 14;
  for (const char* name : {"linear", "curvilinear", "phased"}) {
    const Probe probe = with_lines(name, 256);
    const Pose pose = turned_and_shifted();
    const glm::dvec3 centre = pose.point({2, 55, 0});
    const WeinField ball = [&](const glm::dvec3& p) {
      return WeinMedium{glm::length(p - centre) < kRadius ? 200.0 : 0.0, glm::dvec3(0)};
    };
    const Image<std::uint8_t> grey =
        wein_reference(ball, probe, kDepth, echogenicity_alone(512, kWidth, kHeight), pose).grey;
    long counted = 0;
    for (const std::uint8_t value : grey.pixels) counted += value > 127;
    const double side = image_geometry(probe, kDepth, kWidth, kHeight).mm_per_pixel;
    const double area = double(counted) * side * side, exact = glm::pi<double>() * kRadius * kRadius;
    std::printf("a disc of %.0f mm radius, %s: area off by %.2f %%\n", kRadius, name, 100 * (area / exact - 1));
    CHECK(area == Approx(exact).epsilon(0.01));
  }
}
