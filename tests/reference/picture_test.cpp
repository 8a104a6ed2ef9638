// What the reference makes of echoes at the pixels: U, smoothing, noise, clutter, gain and grey, against what can be
// worked out by hand. Tolerances are rounding's unless said otherwise.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <vector>

#include "sim/reference/display_reference.h"
#include "sim/reference/reference.h"
#include "tests/accuracy/media.h"
#include "tests/model/amplitudes.h"

using namespace insonate;
using namespace insonate::test;

TEST_CASE("a frame without any echo is black, and nothing undefined is computed on the way") {
  Probe probe = *find_probe("linear");
  probe.lines = 8;
  Settings settings = paper_settings(20, 16);
  settings.image_width = settings.image_height = 12;
  settings.blend = 0;
  std::feclearexcept(FE_ALL_EXCEPT);
  const auto stages = simulate_reference(
      [](const glm::dvec3&) {
        return Medium{200, 0};
      },
      plain_table(), probe, 20, settings, {});
  CHECK_FALSE(std::fetestexcept(FE_INVALID | FE_DIVBYZERO));  // a NaN may well round to black
  for (std::uint8_t grey : stages.grey.pixels) CHECK(grey == 0);
}

TEST_CASE("electronic noise comes before time gain: fluid is black where gain is low and grey where it is high") {
  Probe probe = *find_probe("linear");
  probe.lines = 64;
  Settings settings = trainer_settings(5, 40);
  settings.image_width = settings.image_height = 100;
  settings.tgc_db = {0, 10, 20, 30, 40, 50, 60, 70};
  settings.noise_db = -90;
  const auto mean_grey = [&](double from, double to) {
    const auto stages = simulate_reference(
        [](const glm::dvec3&) {
          return Medium{0, kMinEchogenicity_db};
        },
        plain_table(), probe, 40, settings, {});
    double sum = 0, count = 0;
    for (int y = int(from * 100); y < int(to * 100); ++y)
      for (int x = 0; x < 100; ++x)
        if (stages.inside.at(x, y)) sum += stages.grey.at(x, y), count += 1;
    return sum / count;
  };
  // At the face 90 dB below white, 30 dB below black; at the bottom 20 dB below white, of 60.
  CHECK(mean_grey(0.05, 0.3) < 1);
  // An exponential number's mean in decibels is 2.5 dB below its mean (Abramowitz, Stegun, 6.1.3: Euler's constant).
  CHECK(mean_grey(0.9, 0.95) == Approx(255 * (1 - (24.7 + 2.5) / 60)).margin(6));
  settings.electronic_noise = false;
  CHECK(mean_grey(0.9, 0.95) == 0);
}

TEST_CASE("U is (R + b T) S, at the depth where each sample lies") {
  Probe probe = *find_probe("linear");
  probe.lines = 8;
  Settings settings = without_absorption(1);
  settings.samples = 100;
  settings.image_width = settings.image_height = 100;
  settings.reflection_sigma_mm = 0;
  settings.blend = 0.001;
  settings.two_way = GENERATE(true, false);
  // Z = 2 e^(0.07 r) reflects the same share everywhere.
  const double l = settings.reflection_length_mm, dr = 0.2, alpha = std::pow(std::tanh(0.07 * l / 2), 2);
  const auto stages = simulate_reference(
      [](const glm::dvec3& p) {
        return Medium{100 * (2 * std::exp(0.07 * p.y) - 1), -3};
      },
      plain_table(), probe, 20, settings, {});
  const double s = std::pow(10, -0.3) - std::pow(10, kSilent_db / 10);
  const ImageGeometry geometry = image_geometry(probe, 20, 100, 100);
  int seen = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const double r = geometry.plane_mm(x, y).y;
      if (!stages.inside.at(x, y) || r < dr / 2 || r > 20 - dr / 2) continue;
      const double i = std::pow(1 - alpha, (r - dr / 2) / l), t = settings.two_way ? i * i : i;
      CHECK(stages.fused.at(x, y) == Approx((alpha * i * i + 0.001 * t) * s).epsilon(1e-6));
      ++seen;
    }
  CHECK(seen > 3000);
}

namespace {

/// The sum, mean and variance of values that lie `step` from each other.
struct Moments {
  double sum = 0, mean = 0, variance = 0;
  Moments(const std::vector<double>& values, double step) {
    double first = 0, second = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = double(i) * step;
      sum += values[i];
      first += values[i] * x;
      second += values[i] * x * x;
    }
    mean = first / sum;
    variance = second / sum - mean * mean;
  }
};

}  // namespace

TEST_CASE("R and T are smoothed by Gaussians of their own widths, which the fan's edge does not darken") {
  Probe probe = *find_probe("linear");
  probe.lines = 200;
  Settings settings = without_absorption(0.4);
  settings.samples = settings.image_width = settings.image_height = 200;
  const ImageGeometry geometry = image_geometry(probe, 40, 200, 200);
  const double side = geometry.mm_per_pixel, of_gaussian = 0.9733;  // the variance that three sigma leave
  const auto fused = [&](double reflection_mm, double transmission_mm, double blend, const MediumField& field) {
    settings.reflection_sigma_mm = reflection_mm;
    settings.transmission_sigma_mm = transmission_mm;
    settings.blend = blend;
    return simulate_reference(field, plain_table(), probe, 40, settings, {}).fused;
  };
  // An echo in a column, and a shadow's edge in a row below it.
  const MediumField interface = interface_at(20.03, 100, 300);
  const MediumField shadow = [](const glm::dvec3& p) {
    return Medium{p.x > 0.03 && p.y > 9 && p.y < 11 ? 900. : 100, 0};
  };
  const auto column = [&](double reflection_mm, double transmission_mm) {
    const Image<double> image = fused(reflection_mm, transmission_mm, 0, interface);
    std::vector<double> values;
    for (int y = 0; y < 200; ++y) values.push_back(image.at(100, y));
    return Moments(values, side);
  };
  const auto row = [&](double reflection_mm, double transmission_mm) {
    const Image<double> image = fused(reflection_mm, transmission_mm, 1, shadow);
    std::vector<double> falls;
    for (int x = 20; x < 180; ++x) falls.push_back(image.at(x - 1, 150) - image.at(x, 150));
    return Moments(falls, side);
  };
  for (const double sigma : {1.0, 1.7}) {
    const Moments sharp = column(0, sigma), smooth = column(sigma, 0);
    CHECK(smooth.sum == Approx(sharp.sum).epsilon(1e-9));
    CHECK(smooth.mean == Approx(sharp.mean).epsilon(1e-9));
    CHECK(smooth.variance - sharp.variance == Approx(of_gaussian * sigma * sigma).epsilon(0.01));
    const Moments edge = row(sigma, 0), soft_edge = row(0, sigma);
    CHECK(soft_edge.sum == Approx(edge.sum).epsilon(1e-6));
    CHECK(soft_edge.mean == Approx(edge.mean).margin(0.01));
    CHECK(soft_edge.variance - edge.variance == Approx(of_gaussian * sigma * sigma).epsilon(0.02));
  }
  const Image<double> even = fused(2, 2, 1, [](const glm::dvec3&) { return Medium{100, 0}; });
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      CHECK(even.at(x, y) == Approx(line_position(probe, 40, geometry.plane_mm(x, y)) ? 1 : 0).margin(1e-5));
}

TEST_CASE("time gain is linear in dB between its depths, and white is a fixed level or the frame's brightest pixel") {
  Probe probe = *find_probe("linear");
  probe.lines = 4;
  Settings settings = without_absorption(1);
  settings.samples = 64;
  settings.image_width = settings.image_height = 100;
  settings.blend = 0.001;
  settings.tgc_db = {0, 1, 4, 9, 16, 25, 36, 49};
  settings.gain_db = -3;
  settings.dynamic_range_db = 70;
  CHECK(time_gain(settings, 0) == Approx(std::pow(10, -0.3)));
  CHECK(time_gain(settings, 1.5 / 7) == Approx(std::pow(10, -0.05)));
  CHECK(time_gain(settings, 5.25 / 7) == Approx(std::pow(10, (27.75 - 3) / 10)));
  CHECK(time_gain(settings, 1.01) == Approx(std::pow(10, 4.6)));

  settings.fixed_level = 0.001 * std::pow(10, 4.9);  // U without gain is 49 dB below
  for (const ReferenceLevel level : {ReferenceLevel::fixed, ReferenceLevel::frame_maximum}) {
    settings.reference_level = level;
    const auto stages = simulate_reference(
        [](const glm::dvec3&) {
          return Medium{200, 0};
        },
        plain_table(), probe, 40, settings, {});
    const ImageGeometry geometry = image_geometry(probe, 40, 100, 100);
    const auto gain_db = [&](int y) {
      const double at = geometry.plane_mm(0, y).y / 40 * 7;
      const double low = std::floor(at);
      return low * low + (2 * low + 1) * (at - low) - 3;  // between squares
    };
    double most_db = -HUGE_VAL;
    for (int y = 0; y < 100; ++y)
      if (stages.inside.at(50, y)) most_db = std::max(most_db, gain_db(y));
    const double white_db = level == ReferenceLevel::fixed ? 49 : most_db;
    int brightest = 0;
    for (int y = 0; y < 100; ++y) {
      if (!stages.inside.at(50, y)) continue;
      CHECK(stages.grey.at(50, y) == Approx(255 * (1 + (gain_db(y) - white_db) / 70)).margin(0.501));
      brightest = std::max<int>(brightest, stages.grey.at(50, y));
    }
    CHECK((brightest == 255) == (level == ReferenceLevel::frame_maximum));
  }
}

TEST_CASE("grey maps keep black and white, and each bends the greys between as it says") {
  Probe probe = *find_probe("linear");
  probe.lines = 4;
  Settings settings = paper_settings(20, 64);
  settings.image_width = settings.image_height = 12;
  settings.speckle = false;
  settings.reference_level = ReferenceLevel::fixed;
  const auto grey_at = [&](GreyMap map, double share) {
    settings.grey_map = map;
    settings.fixed_level = settings.blend * std::pow(10.0, (1 - share) * settings.dynamic_range_db / 10);
    const auto stages = simulate_reference(
        [](const glm::dvec3&) {
          return Medium{200, 0};
        },
        plain_table(), probe, 20, settings, {});
    REQUIRE(stages.inside.at(6, 6));
    return int(stages.grey.at(6, 6));
  };
  for (GreyMap map : {GreyMap::linear, GreyMap::soft, GreyMap::contrast, GreyMap::s_curve}) {
    CHECK(grey_at(map, -0.1) == 0);
    CHECK(grey_at(map, 1.1) == 255);
  }
  CHECK(grey_at(GreyMap::linear, 0.25) == 64);
  CHECK(grey_at(GreyMap::soft, 0.25) == 90);      // 0.25^0.75 = 0.3536
  CHECK(grey_at(GreyMap::contrast, 0.25) == 32);  // 0.25^1.5 = 0.125
  CHECK(grey_at(GreyMap::s_curve, 0.25) == 40);   // 0.0625 x 2.5 = 0.15625

  // The same echo, 20 dB below white.
  const auto grey_20_db_down = [&](double dynamic_range_db, double gain_db) {
    settings.dynamic_range_db = dynamic_range_db;
    settings.gain_db = gain_db;
    return grey_at(GreyMap::linear, 1 - 20 / dynamic_range_db);
  };
  CHECK(grey_20_db_down(30, 0) == 85);
  CHECK(grey_20_db_down(80, 0) == 191);
  CHECK(grey_20_db_down(80, -22) == 121);
  CHECK(grey_20_db_down(80, 25) == 255);
}

TEST_CASE("clutter fills a cyst from the tissue at its depth, by as many decibels less as asked for") {
  Probe probe = *find_probe("linear");
  probe.lines = 64;
  Settings settings = test::trainer_with_amplitudes(5, 40);
  settings.image_width = settings.image_height = 100;
  settings.speckle = settings.absorption = settings.electronic_noise = false;
  settings.clutter_db = -20;
  const auto mean_in_cyst = [&](double depth_mm) {
    const auto stages = simulate_reference(
        [](const glm::dvec3& p) {
          const bool cyst = std::abs(p.x) < 10 && p.y > 10 && p.y < 30;
          return Medium{0, cyst || p.y > 25 ? -200.0 : 0.0};  // below 25 mm no tissue either side echoes
        },
        plain_table(), probe, 40, settings, {});
    const ImageGeometry geometry = image_geometry(probe, 40, 100, 100);
    double sum = 0, count = 0;
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 100; ++x)
        if (const glm::dvec2 p = geometry.plane_mm(x, y); std::abs(p.x) < 7 && std::abs(p.y - depth_mm) < 3)
          sum += stages.fused.at(x, y), count += 1;
    return sum / count / settings.blend;
  };
  // Tissue of U = b fills all lines down to 10 mm, half of them down to 25 mm, and what is late fades with 5 mm: here
  // its means over the 6 mm looked at. A few hundred Rayleigh numbers, smoothed: known to some per cent.
  const auto fading = [](double from, double to) {
    return 5 / (to - from) * (std::exp(-from / 5) - std::exp(-to / 5));
  };
  CHECK(mean_in_cyst(18) == Approx(0.01 * (0.5 + 0.5 * fading(5, 11))).epsilon(0.08));
  CHECK(mean_in_cyst(34) == Approx(0.01 * (0.5 + 0.5 * std::exp(-3.0)) * fading(6, 12)).epsilon(0.08));
  settings.clutter = false;
  CHECK(mean_in_cyst(18) < 1e-9);
}
