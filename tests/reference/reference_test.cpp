// What the reference makes of gas, bone, gel and the display, against what can be worked out by hand. How exactly it
// follows the model is tested in tests/accuracy. Tolerances are rounding's unless said otherwise.

#include "sim/reference/reference.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "sim/model/beam.h"
#include "sim/model/noise.h"
#include "sim/reference/reverberation_reference.h"
#include "tests/accuracy/media.h"
#include "tests/model/amplitudes.h"

using namespace insonate;
using namespace insonate::test;

TEST_CASE("gas and bone cast the shadows that their impedances ask for") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Settings settings = without_absorption(0.6);
  const ScanLines lines = one_line(60, 600);
  const auto behind = [&](double hu) {
    const MediumField slab = [=](const glm::dvec3& p) { return Medium{p.y > 20.03 && p.y < 30.03 ? hu : 60, 0}; };
    return traverse_reference(slab, table, lines, settings, {}).intensity.at(0, lines.samples - 1);
  };
  CHECK(behind(60) == 1);
  CHECK(behind(1000) == Approx(std::pow(1 - std::pow((7.8 - 1.65) / (7.8 + 1.65), 2), 2)).epsilon(1e-9));
  CHECK(behind(-990) < 1.1e-6);  // (4 x 0.0004 x 1.65 / 1.65^2)^2
}

TEST_CASE("coupling gel takes the place of air in front of the skin, and of nothing else") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Settings settings = without_absorption(0.6);
  const ScanLines lines = one_line(60, 600);
  const auto at_depth = [&](double gap_mm, double gel_mm) {
    settings.gel_mm = gel_mm;
    const MediumField skin = [=](const glm::dvec3& p) { return Medium{p.y > gap_mm + 0.03 ? 60.0 : -1000.0, 0}; };
    return traverse_reference(skin, table, lines, settings, {}).intensity.at(0, lines.samples - 1);
  };
  CHECK(at_depth(4, 0) < 1e-5);
  CHECK(at_depth(4, 6) > 0.99);
  CHECK(at_depth(10, 6) < 1e-5);
}

TEST_CASE("air against the face lets pass what an interface of water and air does, however many samples meet it") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const double water = table.at(0).impedance_mrayl, air = table.at(-1000).impedance_mrayl;
  const ScanLines lines = one_line(60, 600);
  const int samples_a_length = GENERATE(1, 2, 3, 8);
  CAPTURE(samples_a_length);
  Settings settings = without_absorption(samples_a_length * lines.dr_mm());
  settings.gel_mm = 0;
  const MediumField nothing = [](const glm::dvec3&) { return Medium{-1000, -60}; };
  const double behind = traverse_reference(nothing, table, lines, settings, {}).intensity.at(0, 20);
  CHECK(behind == Approx(4 * water * air / std::pow(water + air, 2)).epsilon(1e-9));
}

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

TEST_CASE("electronic noise has the envelope of a complex normal signal, whatever the number of samples") {
  Settings settings;
  settings.electronic_noise = true;
  settings.reflection_length_mm = 0.5;
  ScanLines lines;
  lines.lines.resize(500);
  lines.r_max_mm = 200;
  lines.samples = 400;
  const Image<double> noise = electronic_noise(lines, settings);
  double mean = 0, square = 0, beside = 0;
  for (double e : noise.pixels) {
    mean += e / double(noise.pixels.size());
    square += e * e / double(noise.pixels.size());
  }
  for (int line = 1; line < noise.width; ++line)
    for (int k = 0; k < noise.height; ++k)
      beside += (noise.at(line, k) - mean) * (noise.at(line - 1, k) - mean) / double(noise.pixels.size());
  // 200,000 envelopes, independent where a sample is a reflection length: means are known to 0.0012, ratios to 0.005.
  CHECK(mean == Approx(1).margin(0.005));
  CHECK(mean / std::sqrt(square - mean * mean) == Approx(1.913).margin(0.02));
  CHECK(std::abs(beside) < 0.01 * (square - mean * mean));

  ScanLines finer = lines;
  finer.samples = 5 * lines.samples;  // whose sample 5 k + 2 lies where k did
  const Image<double> same = electronic_noise(finer, settings);
  for (int k = 0; k < noise.height; ++k) CHECK(same.at(7, 5 * k + 2) == Approx(noise.at(7, k)).epsilon(1e-9));
}

TEST_CASE("the noise of waves has power 1 at every pixel, on either side of a line, and is shifted by the pose alone") {
  const Probe& probe = *find_probe("curvilinear");
  const Settings settings = trainer_settings(3.5, 160);
  const ScanLines lines = scan_lines(probe, 160, settings.samples);
  const Image<std::complex<double>> noise = noise_wave(lines, settings);
  const ImageGeometry picture = image_geometry(probe, 160, 400, 300);
  double power = 0, corner = 0, n = 0, corners = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double here = std::norm(noise_of_pixel(noise, picture, lines, x, y));
      const bool inside = line_position(probe, 160, picture.plane_mm(x, y)).has_value();
      (inside ? power : corner) += here;
      ++(inside ? n : corners);
    }
  // Between samples of one line, which are not independent, a mean has a little less power.
  CHECK(power / n == Approx(1).epsilon(0.15));
  CHECK(corner / corners == Approx(1).epsilon(0.25));

  Pose here;
  here.translation = {12, -3, 55};
  Pose beside = here;
  beside.translation.x += 1e-4;
  CHECK(noise_shift(here) == noise_shift(here));
  CHECK(noise_shift(here) != noise_shift(beside));
  CHECK(noise_shift(here).x >= 0);
}

TEST_CASE("a volume's planes have the noise of all their lines, and neighbours have it in other places") {
  for (int lines = 30; lines <= 300; ++lines) {
    CAPTURE(lines);
    std::vector<int> at_line_0;  // whose noise, plane by plane
    for (int plane = 0; plane < lines; ++plane) at_line_0.push_back(noise_line(0, plane, lines));
    for (const std::size_t plane : {1, 2, 3, 4})
      CHECK(std::min(at_line_0[plane], lines - at_line_0[plane]) >= lines / 18);
    std::ranges::sort(at_line_0);
    CHECK(std::ranges::adjacent_find(at_line_0) == at_line_0.end());
    for (int line = 0; line < lines; ++line) {
      if (noise_line(line, 0, lines) != line) FAIL("the first plane's are a picture's");
      if (noise_line(line, 1, lines) != (line + noise_step(lines)) % lines) FAIL("all lines are shifted alike");
    }
  }
  CHECK(noise_line(0, 7, 1) == 0);
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
          return Medium{0, -200};
        },
        plain_table(), probe, 40, settings, {});
    double sum = 0, count = 0;
    for (int y = int(from * 100); y < int(to * 100); ++y)
      for (int x = 0; x < 100; ++x)
        if (stages.inside.at(x, y)) sum += stages.grey.at(x, y), count += 1;
    return sum / count;
  };
  // At the face 90 dB below white, 35 dB below black; at the bottom 20 dB below white, of 55.
  CHECK(mean_grey(0.05, 0.3) < 1);
  // An exponential number's mean in decibels is 2.5 dB below its mean (Abramowitz, Stegun, 6.1.3: Euler's constant).
  CHECK(mean_grey(0.9, 0.95) == Approx(255 * (1 - (24.7 + 2.5) / 55)).margin(6));
  settings.electronic_noise = false;
  CHECK(mean_grey(0.9, 0.95) == 0);
}

TEST_CASE("what is almost air turns into gel by degrees") {
  const auto coupled = [](double hu, double r_mm) { return with_gel({hu, -10}, r_mm, 2); };
  for (const auto& [hu, share] : {std::pair{60.0, 0.0}, {-150.0, 0.0}, {-225.5, 0.5}, {-301.0, 1.0}, {-1000.0, 1.0}}) {
    CHECK(coupled(hu, 1.99).hu == Approx((1 - share) * hu));
    CHECK(coupled(hu, 1.99).echogenicity_db == Approx(-10 - 50 * share));
    CHECK(coupled(hu, 2).hu == hu);
    CHECK(coupled(hu, 2).echogenicity_db == -10);
  }
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
  const double s = std::pow(10, -0.3) - std::pow(10, kSilentDb / 10);
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

TEST_CASE("the beam's windows are a box, a triangle and Hann's, and let through as much") {
  Settings settings;
  settings.beam_lines = 5;
  const auto weights = [&](BeamWindow window) {
    settings.beam_window = window;
    return beam_weights(settings);
  };
  const auto expected = [](std::vector<double> window, double sum) {
    for (double& weight : window) weight /= sum;
    return window;
  };
  const auto off_by = [](const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
  };
  CHECK(off_by(weights(BeamWindow::box), expected({1, 1, 1, 1, 1}, 5)) < 1e-15);
  CHECK(off_by(weights(BeamWindow::triangle), expected({1, 2, 3, 2, 1}, 9)) < 1e-15);
  CHECK(off_by(weights(BeamWindow::hann), expected({1, 3, 4, 3, 1}, 12)) < 1e-15);  // cosines of 60 and 120 degrees
}

// Full width at half maximum, mm, of what an evenly weighted aperture hears at its focus of a point that it sends to:
// the waves of its parts, summed at places beside the focus.
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
    CHECK(width_mm(depth) == Approx(focused_beam_fwhm_mm(settings, depth)).epsilon(0.05));
  CHECK(width_mm(20) < width_mm(5));
  CHECK(width_mm(40) > 2 * width_mm(20));
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
          return Medium{0, std::abs(p.z) < gap_mm / 2 ? -200.0 : 0.0};
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

TEST_CASE("sound that grazes the limb of a cyst is lost, sound that meets an interface plainly is not") {
  const TissueTable table{{{-1000, 1.0, 0, 0}, {1000, 1.0, 0, 0}}, {}};  // nothing reflects
  Settings settings = without_absorption(0.6);
  settings.edge_shadow = true;
  const auto left_behind = [&](const MediumField& field, double x) {
    ScanLines lines = one_line(80, 1600);
    lines.lines.front().start.x = x;
    return traverse_reference(field, table, lines, settings, {}).intensity.at(0, lines.samples - 1);
  };
  // A plane turns the sound by ln(1595 / 1450) tan(tilt); q is that in units of 0.1 rad to the power of four, and the
  // loss the root of 1 + q/2 where the interface is thin beside 5 mm; at 60 degrees it takes up 0.3 mm.
  settings.reflection_length_mm = 0.1;
  for (double tilt : {0.0, 30.0, 45.0, 60.0}) {
    const double turn = std::log(1595.0 / 1450) * std::tan(glm::radians(tilt));
    const double lost = std::log(1 + std::pow(turn / 0.1, 4) / 2) / 2;
    INFO(tilt << " degrees");
    CHECK(-std::log(left_behind(interface_at(30, -100, 60, tilt, 0.05), 0)) == Approx(lost).epsilon(0.15).margin(1e-9));
  }
  settings.reflection_length_mm = 0.6;
  // A cyst of water in liver, radius 15 mm, as blurred as a CT is.
  const MediumField cyst = [](const glm::dvec3& p) {
    const double inside = 15 - std::hypot(p.x, p.y - 40);
    return Medium{60 - 60 * std::clamp(inside / 1.2 + 0.5, 0.0, 1.0), 0};
  };
  CHECK(left_behind(cyst, 0) > 0.9999);
  CHECK(left_behind(cyst, 7.5) > 0.995);
  CHECK(left_behind(cyst, 17) > 0.9999);
  CHECK(left_behind(cyst, 15) < 0.7);
  CHECK(left_behind(cyst, -15) == Approx(left_behind(cyst, 15)));
  settings.edge_shadow = false;
  CHECK(left_behind(cyst, 15) == 1);
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

TEST_CASE("a thin layer draws a tail behind it, an echo each time that sound has crossed it twice more") {
  const TissueTable table{{{0, 1.0, 0, 0}, {1000, 11.0, 0, 0}}, {}};
  const ScanLines lines = one_line(60, 600);
  Settings settings = without_absorption(0.2);
  settings.reverberation = true;
  // Plates of 3 and 5 MRayl in 1 MRayl, at depths that samples meet in their middles; a strong one behind them.
  const auto echoes = [&](double first_mm, double thick_mm, double hu, double absorption) {
    TissueTable lossy = table;
    for (TissueKnot& knot : lossy.knots) knot.absorption_db_cm_mhz = absorption;
    settings.absorption = absorption > 0;
    const ReferenceScan scan = traverse_reference(
        [=](const glm::dvec3& p) {
          return Medium{p.y > first_mm && p.y < first_mm + thick_mm ? hu : 0.0, 0};
        },
        lossy, lines, settings, {});
    return std::pair(scan, reverberation_reference(scan.intensity, scan.reflection, lines, settings));
  };
  const auto area = [](const Image<double>& image, double depth_mm) {  // of what lies within 0.3 mm
    double sum = 0;
    for (int k = int((depth_mm - 0.3) / 0.1); k < int((depth_mm + 0.3) / 0.1); ++k) sum += image.at(0, k);
    return sum;
  };
  const double alpha = plain_alpha(0, 400);  // there and back within the plate: alpha^2 a round
  const auto [scan, tail] = echoes(20, 2, 400, 0);
  const double first = area(scan.reflection, 22);
  for (int n = 1; n <= 4; ++n)
    // What is left out counts 8 (kLeastRound/alpha^2)^2 a round, 2e-4.
    CHECK(area(tail, 22 + 2 * n) == Approx(first * std::pow(alpha * alpha, n)).epsilon(1e-3));
  CHECK(area(tail, 23) == 0);
  CHECK(area(tail, 22) == 0);

  // Sound that crosses a lossy plate: 1 dB/(cm MHz) at 3.5 MHz over 4 mm more in each round; but for the width of both
  // echoes, l in all.
  const auto [lossy_scan, lossy_tail] = echoes(20, 2, 400, 1);
  const double loss = std::pow(10.0, -3.5 * 0.4 / 10);
  CHECK(area(lossy_tail, 24) == Approx(area(lossy_scan.reflection, 22) * alpha * alpha * loss).epsilon(0.1));

  // Weak plates ring, but nobody hears them; and the samples that show one interface do not ring with each other.
  CHECK(area(echoes(20, 2, 20, 0).second, 24) == 0);
  for (double echo : echoes(20, 100, 400, 0).second.pixels) CHECK(echo == 0);
  settings.reverberation = false;
  CHECK(area(echoes(20, 2, 400, 0).second, 24) == 0);
}

TEST_CASE("a repeat leaves the picture at the lines' end without a step") {
  Settings settings = without_absorption(1);
  settings.face_reflection = 1;
  Image<double> intensity(1, 40), reflection(1, 40);
  std::fill(intensity.pixels.begin(), intensity.pixels.end(), 1.0);
  reflection.at(0, 19) = 0.5;
  // The face, nearer or further, brings the repeat of sample 19 to either side of the end, behind sample 39.
  const auto last = [&](double position) {
    ScanLines lines = one_line(40, 40);
    lines.r_min_mm = position - 19 - 19.5;
    lines.r_max_mm = lines.r_min_mm + 40;
    return reverberation_reference(intensity, reflection, lines, settings).at(0, 39);
  };
  CHECK(last(39) > 0.1);
  for (const double end : {40.0, 41.0}) CHECK(last(end - 1e-6) == Approx(last(end + 1e-6)).margin(1e-5));
  CHECK(last(40) > 0.02);
  CHECK(last(41) == 0);
}

TEST_CASE("a surface that a slice's planes meet at different depths holds no sound between them") {
  Probe probe = *find_probe("linear");
  probe.lines = 8;
  Settings settings = test::trainer_with_amplitudes(5, 40);
  settings.image_width = settings.image_height = 16;
  settings.face_reflection = 0;
  settings.slice_thickness_mm = 5;
  REQUIRE((settings.reverberation && settings.slice_planes > 1));
  const auto stages = simulate_reference(
      [](const glm::dvec3& p) {
        return Medium{p.y + p.z > 20 ? 900.0 : 0.0, 0};
      },
      plain_table(), probe, 40, settings, {});
  CHECK(*std::max_element(stages.reflection.pixels.begin(), stages.reflection.pixels.end()) > 0.01);
  CHECK(*std::max_element(stages.repeated.pixels.begin(), stages.repeated.pixels.end()) == 0);
}

TEST_CASE("gas repeats at multiples of its depth, each time weaker by its echo and the face's reflection") {
  Probe probe = *find_probe("linear");
  probe.lines = 16;
  Settings settings = test::trainer_with_amplitudes(5, 40);
  settings.samples = 400;
  settings.reflection_length_mm = 0.2;
  settings.image_width = settings.image_height = 400;
  settings.blend = settings.reflection_sigma_mm = 0;
  settings.speckle = settings.absorption = settings.electronic_noise = settings.clutter = false;
  const auto echo_near = [&](double depth_mm, double hu_behind) {
    const auto stages = simulate_reference(
        [=](const glm::dvec3& p) {
          return Medium{p.y > 10.05 ? hu_behind : 0.0, 0};
        },
        plain_table(), probe, 40, settings, {});
    const ImageGeometry geometry = image_geometry(probe, 40, 400, 400);
    double sum = 0;
    for (int y = 0; y < 400; ++y)
      if (std::abs(geometry.plane_mm(200, y).y - depth_mm) < 1) sum += stages.fused.at(200, y);
    return sum;
  };
  const double alpha = std::pow(4.0 / 6.0, 2);  // of 1 against 5 MRayl
  settings.face_reflection = 0.1;
  const double first = echo_near(10.05, 400);
  CHECK(echo_near(20.1, 400) == Approx(0.1 * alpha * first).epsilon(0.01));
  CHECK(echo_near(30.15, 400) == Approx(0.01 * alpha * alpha * first).epsilon(0.01));
  CHECK(echo_near(25, 400) == 0);
  CHECK(echo_near(20.1, 1) < 1e-9);  // tissue's are not to be seen
  settings.face_reflection = 0;
  CHECK(echo_near(20.1, 400) == 0);
}
