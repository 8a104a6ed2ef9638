// The reference against what can be worked out by hand, so that it may stand as the measure of everything else. The
// media are given by formulas; tolerances are rounding's unless said otherwise.

#include "sim/reference/reference.h"

#include <catch2/catch.hpp>
#include <glm/trigonometric.hpp>

#include <cfenv>
#include <cmath>

#include "sim/model/noise.h"

using namespace insonate;

namespace {

// 1.0 MRayl a 100 HU, absorption 0.5 throughout: plain numbers instead of tissue.
TissueTable plain_table() {
  return {{{0, 1.0, 0.5, 0}, {1000, 11.0, 0.5, 0}}, {}};
}
double impedance(double hu) {
  return 1 + hu / 100;
}

ScanLines one_line(double r_max_mm, int samples) {
  ScanLines lines;
  lines.lines = {ScanLine{}};
  lines.samples = samples;
  lines.r_max_mm = r_max_mm;
  return lines;
}

Settings without_absorption(double reflection_length_mm) {
  Settings settings;
  settings.absorption = false;
  settings.gel_mm = 0;
  settings.speckle = false;
  settings.reflection_length_mm = reflection_length_mm;
  return settings;
}

/// Two media that meet in the plane y = depth, which is turned about z by `tilt`; blurred over `ramp_mm`.
MediumField interface_at(double depth, double hu_before, double hu_behind, double tilt_deg = 0, double ramp_mm = 0) {
  const double c = std::cos(glm::radians(tilt_deg)), s = std::sin(glm::radians(tilt_deg));
  return [=](const glm::dvec3& p) {
    const double behind = c * (p.y - depth) + s * p.x;
    const double share = ramp_mm > 0 ? std::clamp(behind / ramp_mm + 0.5, 0.0, 1.0) : (behind > 0 ? 1.0 : 0.0);
    return Medium{hu_before + share * (hu_behind - hu_before), 0};
  };
}

double echo_integral(const ReferenceScan& scan, double dr) {
  double sum = 0;
  for (double r : scan.reflection.pixels) sum += r * dr;
  return sum;
}

double alpha_of(double hu1, double hu2) {
  const double z1 = impedance(hu1), z2 = impedance(hu2);
  return std::pow((z2 - z1) / (z2 + z1), 2);
}

}  // namespace

TEST_CASE("a homogeneous medium reflects nothing and absorbs by the decibel") {
  Settings settings = without_absorption(0.5);
  settings.absorption = true;
  settings.frequency_mhz = 3.5;
  const ScanLines lines = one_line(160, 500);
  const auto scan = traverse_reference(
      [](const glm::dvec3&) {
        return Medium{200, 0};
      },
      plain_table(), lines, settings, {});
  for (int k = 0; k < lines.samples; ++k) {
    const double r = (k + 0.5) * lines.dr_mm();
    CHECK(scan.reflection.at(0, k) == 0);
    CHECK(scan.intensity.at(0, k) == Approx(std::pow(10, -0.5 * 3.5 * r / 100)).epsilon(1e-12));
  }
}

TEST_CASE("a sharp interface transmits 1 - alpha however finely it is sampled") {
  const double alpha = alpha_of(100, 500);
  for (int m : {1, 2, 3, 8}) {
    const double l = 0.8;
    const ScanLines lines = one_line(80, 100 * m);  // dr = l / m
    // Off the grid of samples and their half lengths, where a step has no value.
    const double depth = 40.0 + lines.dr_mm() * 0.137;
    const auto scan =
        traverse_reference(interface_at(depth, 100, 500), plain_table(), lines, without_absorption(l), {});
    CHECK(scan.intensity.at(0, lines.samples - 1) == Approx(1 - alpha).epsilon(1e-12));

    double weighted = 0, sum = 0;
    for (int k = 0; k < lines.samples; ++k) {
      const double r = (k + 0.5) * lines.dr_mm();
      weighted += r * scan.reflection.at(0, k);
      sum += scan.reflection.at(0, k);
    }
    // The front of the echo is stronger than its end, which pulls its centre forward by less than half a sample.
    CHECK(std::abs(weighted / sum - depth) <= lines.dr_mm() / 2 + 0.05 * l);
  }
}

TEST_CASE("the echo of a sharp interface has the area that the continuous model gives") {
  const double alpha = alpha_of(100, 500), l = 0.8;
  const double expected = alpha * l * (std::pow(1 - alpha, 2) - 1) / (2 * std::log(1 - alpha));
  double previous = 1;
  for (int m : {8, 16, 32, 64}) {
    const ScanLines lines = one_line(8, 10 * m);
    const double depth = 4 + lines.dr_mm() * 0.137;
    const auto scan =
        traverse_reference(interface_at(depth, 100, 500), plain_table(), lines, without_absorption(l), {});
    const double error = std::abs(echo_integral(scan, lines.dr_mm()) / expected - 1);
    CHECK(error < 0.6 * previous);  // at least linear: halving dr halves it, 0.6 leaves room for the interface's phase
    previous = error;
  }
  CHECK(previous < 0.01);
}

TEST_CASE("layers transmit the product of what each transmits") {
  const MediumField layers = [](const glm::dvec3& p) {
    const double hu[] = {100, 300, 50, 700, 200};
    return Medium{hu[std::clamp(int(p.y / 10.013), 0, 4)], 0};
  };
  const ScanLines lines = one_line(60, 600);
  const auto scan = traverse_reference(layers, plain_table(), lines, without_absorption(0.4), {});
  const double expected =
      (1 - alpha_of(100, 300)) * (1 - alpha_of(300, 50)) * (1 - alpha_of(50, 700)) * (1 - alpha_of(700, 200));
  CHECK(scan.intensity.at(0, lines.samples - 1) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("a tilted interface echoes with the cosine of its tilt") {
  // Blurred over several reflection lengths, as CT blurs every interface. The tilted ramp is crossed on a longer way,
  // by 1/cos, over which alpha falls with cos^2: the area of the echo falls by cos, and once more by |d . n|.
  const ScanLines lines = one_line(40, 4000);
  const auto area = [&](double tilt) {
    return echo_integral(
        traverse_reference(interface_at(20, 300, 310, tilt, 4), plain_table(), lines, without_absorption(0.1), {}),
        lines.dr_mm());
  };
  const double upright = area(0);
  for (double tilt : {15.0, 30.0, 45.0, 60.0}) {
    INFO("tilt " << tilt);
    const double cosine = std::cos(glm::radians(tilt));
    CHECK(area(tilt) / upright == Approx(cosine * cosine).epsilon(0.01));
  }
}

TEST_CASE("halving the sample distance changes less and less") {
  const MediumField wavy = [](const glm::dvec3& p) {
    return Medium{400 + 300 * std::sin(p.y / 3) * std::sin(p.y / 7), 0};
  };
  const auto last_intensity = [&](int samples) {
    const ScanLines lines = one_line(60, samples);
    const auto scan = traverse_reference(wavy, plain_table(), lines, without_absorption(0.6), {});
    // Carried from the last sample to the line's end, so that all sample counts speak of the same place.
    return scan.intensity.at(0, samples - 1);
  };
  const double limit = last_intensity(25600);
  double previous = std::abs(last_intensity(200) - limit);
  for (int samples : {400, 800, 1600}) {
    const double error = std::abs(last_intensity(samples) - limit);
    CHECK(error < 0.6 * previous);
    previous = error;
  }
}

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
  CHECK(at_depth(4, 0) < 1e-2);
  CHECK(at_depth(4, 6) > 0.99);
  CHECK(at_depth(10, 6) < 1e-2);
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
  CHECK(mean_grey(0.9, 0.95) == Approx(255 * (1 - 24.7 / 55)).margin(12));  // a Rayleigh number's mean is 1.1 dB lower
  settings.electronic_noise = false;
  CHECK(mean_grey(0.9, 0.95) == 0);
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
}
