// The width of the beam and the thickness of the slice, as the reference's pictures show them.

#include "sim/model/beam.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <complex>
#include <numbers>

#include "sim/reference/reference.h"
#include "tests/accuracy/media.h"
#include "tests/model/amplitudes.h"

using namespace insonate;
using namespace insonate::test;

namespace {

/// Full width at half maximum, mm, of what an evenly weighted aperture hears at its focus of a point that it sends to:
/// the waves of its parts, summed at places beside the focus.
double width_at_focus_mm(double focus_mm, double f_number, double frequency_mhz) {
  const double aperture_mm = focus_mm / f_number, k = 2 * std::numbers::pi * frequency_mhz / 1.54;
  const auto heard = [&](double x_mm) {
    constexpr int kParts = 2000;
    std::complex<double> pressure = 0;
    for (int i = 0; i < kParts; ++i) {
      const double u = ((i + 0.5) / kParts - 0.5) * aperture_mm;
      const double further_mm = std::hypot(x_mm - u, focus_mm) - std::hypot(u, focus_mm);  // the focusing's delay
      pressure += std::polar(1.0 / kParts, k * further_mm);
    }
    return std::norm(pressure) * std::norm(pressure);  // there and back
  };
  double inside = 0, outside = 1.54 / frequency_mhz * f_number;  // the first zero
  while (outside - inside > 1e-6) {
    const double middle = (inside + outside) / 2;
    (heard(middle) > 0.5 * heard(0) ? inside : outside) = middle;
  }
  return 2 * inside;
}

}  // namespace

TEST_CASE("a focused beam draws a point as wide as its aperture's theory says, narrowest at the focus") {
  Probe probe = *find_probe("linear");
  probe.lines = 128;
  Settings settings = test::trainer_with_amplitudes(5, 60);
  settings.speckle = settings.electronic_noise = settings.absorption = false;
  settings.samples = 120;
  settings.reflection_length_mm = 1;
  settings.image_width = settings.image_height = 8;
  settings.focused_beam = true;
  settings.focus_mm = 20;
  settings.f_number = 4;
  const double spacing = probe.width_mm / probe.lines, on_a_line = spacing / 2;
  // From the profile's second moment; a Gaussian that ends at three sigma has lost 2.7 % of it.
  const auto width_mm = [&](double depth_mm) {
    const auto stages = simulate_reference(
        [=](const glm::dvec3& p) {
          const bool inside = std::abs(p.x - on_a_line) < spacing / 4 && std::abs(p.y - depth_mm) < 0.6;
          return Medium{inside ? 250.0 : 200.0, 0};
        },
        plain_table(), probe, 60, settings, {});
    double sum = 0, moment = 0;
    for (int line = 0; line < probe.lines; ++line) {
      const double echo = stages.reflection_beam.at(line, int(depth_mm / 0.5)), x = (line - 64) * spacing;
      sum += echo;
      moment += echo * x * x;
    }
    REQUIRE(sum > 0);
    return std::sqrt(8 * std::log(2.0) * moment / sum);
  };
  CHECK(width_mm(20) == Approx(width_at_focus_mm(20, 4, 5)).epsilon(0.1));
  for (double depth : {5.0, 20.0, 40.0})
    CHECK(width_mm(depth) == Approx(focused_beam_fwhm_mm(settings, probe.aperture_mm, depth)).epsilon(0.05));
  CHECK(width_mm(20) < width_mm(5));
  // Reception at this f-number stays narrow as far as the aperture of 40 mm allows, transmission alone widens.
  CHECK(width_mm(40) > 1.3 * width_mm(20));
  settings.focused_beam = false;
  CHECK(width_mm(40) == Approx(width_mm(20)));
}

TEST_CASE("speckle is as bright at every depth of a focused beam") {
  Settings settings = test::trainer_with_amplitudes(3.5, 160);
  settings.image_width = settings.image_height = 8;
  settings.focused_beam = true;
  const auto stages = simulate_reference(
      [](const glm::dvec3&) {
        return Medium{60, 0};
      },
      plain_table(), *find_probe("curvilinear"), 160, settings, {});
  const int samples = stages.speckle.height;
  for (int part = 0; part < 4; ++part) {
    double mean = 0;
    for (int k = part * samples / 4; k < (part + 1) * samples / 4; ++k)
      for (int line = 20; line < 172; ++line) mean += stages.speckle.at(line, k) / (152.0 * (samples / 4));
    CHECK(mean == Approx(1).margin(0.05));  // over some thousand cells, each of deviation 0.52
  }
}

TEST_CASE("a slice of some thickness sees what lies beside a thin gap, and is as bright where nothing does") {
  Probe probe = *find_probe("linear");
  probe.lines = 16;
  Settings settings = test::trainer_with_amplitudes(5, 40);
  settings.image_width = settings.image_height = 16;
  settings.speckle = settings.absorption = settings.electronic_noise = settings.clutter = false;
  settings.slice_planes = 1;
  const auto echo_in_gap = [&](double gap_mm) {
    const auto stages = simulate_reference(
        [=](const glm::dvec3& p) {
          return Medium{0, std::abs(p.z) < gap_mm / 2 ? kMinEchogenicity_db : 0.0};
        },
        plain_table(), probe, 40, settings, {});
    return stages.fused.at(8, 8) / settings.blend;
  };
  CHECK(echo_in_gap(2) < 1e-9);
  settings.slice_planes = 31;
  settings.slice_thickness_mm = 3;
  // A Gaussian of deviation 3/2.355 between one and two deviations, of all within two; a plane at either edge is 0.04.
  const double within_1mm = std::erf(1 / 1.274 / std::sqrt(2.0)), within_all = std::erf(2 / std::sqrt(2.0));
  CHECK(echo_in_gap(2) == Approx(1 - within_1mm / within_all).margin(0.04));
  CHECK(echo_in_gap(0) == Approx(1));
}

TEST_CASE("a surface that is steep in the plane is a band, not a dash for each line") {
  Probe probe = *find_probe("linear");
  Settings settings = trainer_settings(probe.frequency_mhz, 40);
  settings.image_width = settings.image_height = 600;
  settings.speckle = settings.absorption = settings.electronic_noise = settings.clutter = false;
  settings.edge_shadow = settings.two_way = false;
  settings.reverberation = false;
  probe.lines = 48;  // 1 mm apart for the dashes to show, as 0.35 degrees are at a depth of 16 cm
  const double slope = 1.2;
  const Stages<double> stages = simulate_reference(
      [=](const glm::dvec3& p) {
        return Medium{p.y < 20 + slope * p.x ? 0.0 : 60.0, kMinEchogenicity_db};
      },
      read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"), probe, 40, settings, {});
  const ImageGeometry geometry = image_geometry(probe, 40, 600, 600);
  std::vector<double> amplitudes;
  double mean = 0;
  for (double x = -8; x < 8; x += 0.05) {
    const glm::dvec2 pixel = geometry.pixel(glm::dvec2(x, 20 + slope * x));
    double brightest = 0;
    for (int y = -2; y <= 2; ++y)
      brightest = std::max(brightest, stages.fused.at(int(std::lround(pixel.x)), int(std::lround(pixel.y)) + y));
    amplitudes.push_back(std::sqrt(brightest));
  }
  for (const double each : amplitudes) mean += each / double(amplitudes.size());
  double variance = 0;
  for (const double each : amplitudes) variance += (each - mean) * (each - mean) / double(amplitudes.size());
  // Planes between lines weigh a little less than those on lines. One dash for each line would deviate by 0.67.
  CHECK(std::sqrt(variance) < 0.35 * mean);
}

TEST_CASE("a slice is thinnest at its focus and widens to both sides as a Gaussian beam does") {
  Probe probe = *find_probe("linear");
  probe.lines = 8;
  Settings settings = test::trainer_with_amplitudes(3.5, 100);
  settings.image_width = settings.image_height = 16;
  settings.samples = 100;
  settings.reflection_length_mm = 1;
  settings.speckle = settings.absorption = settings.electronic_noise = settings.clutter = false;
  settings.slice_planes = 31;
  settings.slice_thickness_mm = 2;
  settings.elevation_focus_mm = 50;
  // 0.44 mm long waves spread by ln 2 0.44/(2 pi) = 0.0485 a mm: 40 mm off, the slice is 2.8 mm thick.
  CHECK(slice_thickness_at_mm(settings, 50) == 2);
  CHECK(slice_thickness_at_mm(settings, 90) == Approx(std::hypot(2, 40 * 0.04854)).epsilon(1e-4));
  CHECK(slice_thickness_at_mm(settings, 10) == slice_thickness_at_mm(settings, 90));
  // What echoes lies further than 1 mm beside the plane: the Gaussian's share beyond, of all within two deviations.
  const auto stages = simulate_reference(
      [](const glm::dvec3& p) {
        return Medium{0, std::abs(p.z) < 1 ? -200.0 : 0.0};
      },
      plain_table(), probe, 100, settings, {});
  for (double r : {10.5, 30.5, 50.5, 90.5}) {
    const double deviations = 2.3548 / slice_thickness_at_mm(settings, r);
    const double within = std::erf(deviations / std::sqrt(2.0)) / std::erf(std::sqrt(2.0));
    INFO(r << " mm");
    CHECK(stages.speckle.at(4, int(r)) == Approx(1 - within).margin(0.04));  // a plane at either edge is 0.04
  }
  CHECK(stages.speckle.at(4, 10) > 1.3 * stages.speckle.at(4, 50));
}

TEST_CASE("speckle keeps its mean through a slice of several planes") {
  Settings settings = test::trainer_with_amplitudes(3.5, 160);
  settings.image_width = settings.image_height = 8;
  settings.samples = 300;
  settings.slice_planes = 5;
  settings.slice_thickness_mm = 2;
  settings.elevation_focus_mm = GENERATE(0, 60);
  const auto stages = simulate_reference(
      [](const glm::dvec3&) {
        return Medium{60, 0};
      },
      plain_table(), *find_probe("curvilinear"), 160, settings, {});
  double mean = 0;
  for (double s : stages.speckle.pixels) mean += s / double(stages.speckle.pixels.size());
  CHECK(mean == Approx(1).margin(0.05));  // the correlation of planes turned against the lattice is known no better
}
