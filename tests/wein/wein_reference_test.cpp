// Compares model W's reference and LC2 with values computed by hand. Tolerances are those of rounding unless stated
// otherwise.

#include "sim/wein/wein_reference.h"

#include <catch2/catch.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <vector>

#include "sim/core/hash.h"

using namespace insonate;

namespace {

Probe one_line() {
  Probe probe = *find_probe("linear");
  probe.lines = 1;
  return probe;
}

WeinSettings settings_of(int samples, double contact_mm = 0) {
  WeinSettings settings;
  settings.samples = samples;
  settings.contact_mm = contact_mm;
  settings.image_width = settings.image_height = 8;
  return settings;
}

/// Returns a density that rises along y and x by the given amounts per reflection length.
WeinField slope(double hu_at_0, double along_y, double along_x, double length_mm) {
  return [=](const glm::dvec3& p) {
    return WeinMedium{hu_at_0 + (along_y * p.y + along_x * p.x) / length_mm, {along_x, along_y, 0}};
  };
}

Image<double> noise(std::uint32_t seed) {
  Image<double> image(20, 15);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = unit_float(hash(seed, std::uint32_t(i)));
  return image;
}

Image<double> mix(double a, const Image<double>& first, double b, const Image<double>& second, double c) {
  Image<double> image = first;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = a * first.pixels[i] + b * second.pixels[i] + c;
  return image;
}

const Image<std::uint8_t> kEverywhere(20, 15, 1);

}  // namespace

TEST_CASE("model W: nothing reflects or is lost in a homogeneous medium, whose echo is affine in its density") {
  for (const double hu : {-50.0, 0.0, 100.0, 150.0}) {
    const auto stages = wein_reference(slope(hu, 0, 0, 2), one_line(), 50, settings_of(30), {});
    for (int k = 0; k < 30; ++k) {
      CHECK(stages.intensity.at(0, k) == 1);
      CHECK(stages.scan_reflection.at(0, k) == 0);
      CHECK(stages.scan_echogenicity.at(0, k) == Approx((hu + 50) / 200).margin(1e-12));
    }
  }
}

TEST_CASE("model W: a gradient reflects and passes what its formula says, less by the beam's tilt to it") {
  WeinSettings settings = settings_of(1);
  settings.shadows = false;
  const double mu = 1000 + 100 * 25 / 2.0;  // half way down 50 mm
  const auto reflected = [&](double along_y, double along_x) {
    const auto stages = wein_reference(slope(0, along_y, along_x, 2), one_line(), 50, settings, {});
    return std::expm1(stages.scan_reflection.at(0, 0) * std::log(1001.0)) / 1000;
  };
  const double straight = std::pow(100 / (2 * mu), 2);
  CHECK(reflected(100, 0) == Approx(straight));
  // d . g| |g|: with an equal slope across the line, |g| grows by the square root of 2.
  CHECK(reflected(100, 100) == Approx(straight * std::sqrt(2.0)));
  CHECK(reflected(0, 100) == Approx(0).margin(1e-12));
  // Falling density echoes like rising density.
  const double falling_mu = 1000 - 10 * 25 / 2.0;
  CHECK(reflected(-10, 0) == Approx(std::pow(10 / (2 * falling_mu), 2)));
}

TEST_CASE("model W: what passes does not depend on the distance between samples") {
  // I solves I' = I ln(1 - (g / 2 mu)^2) / l; the sum over samples is its midpoint rule from sample to sample.
  const double l = 2, g = 400, depth = 40;
  const auto exact = [&](double r0, double r1) {
    const int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double r = r0 + (i + 0.5) * (r1 - r0) / steps;
      sum += std::log1p(-std::pow(g / (2 * (1000 + g * r / l)), 2)) * (r1 - r0) / steps;
    }
    return std::exp(sum / l);
  };
  double coarse_error = 0;
  for (const int samples : {50, 100, 200}) {
    WeinSettings settings = settings_of(samples);
    settings.reflection_length_mm = l;
    const auto stages = wein_reference(slope(0, g, 0, l), one_line(), depth, settings, {});
    // The first sample has lost nothing. The last has lost what all before it take: from its own middle to the first's.
    const double dr = depth / samples, expected = exact(dr / 2, depth - dr / 2);
    const double error = std::abs(stages.intensity.at(0, samples - 1) - expected);
    CHECK(error < 0.02 * expected * 50 / samples);
    if (coarse_error > 0) CHECK(error < 0.6 * coarse_error);  // at least linear
    coarse_error = error;
  }
}

TEST_CASE("model W: gas lets nothing pass, and behind it no echo is left") {
  const WeinField field = [](const glm::dvec3& p) {
    return p.y < 20   ? WeinMedium{50, {0, 0, 0}}
           : p.y < 22 ? WeinMedium{-990, {0, -1000, 0}}
                      : WeinMedium{50, {0, 0, 0}};
  };
  const auto stages = wein_reference(field, one_line(), 50, settings_of(50), {});
  CHECK(stages.intensity.at(0, 20) == 1);
  CHECK(stages.scan_reflection.at(0, 20) == Approx(1));
  for (int k = 21; k < 50; ++k) {
    CHECK(stages.intensity.at(0, k) == 0);
    CHECK(stages.scan_echogenicity.at(0, k) == 0);
  }
  WeinSettings paper = settings_of(50);
  paper.shadows = false;
  CHECK(wein_reference(field, one_line(), 50, paper, {}).scan_echogenicity.at(0, 40) == Approx(0.5));
}

TEST_CASE("model W: the picture mixes R and E by their shares") {
  const auto grey = [](const WeinMedium& medium, double share) {
    WeinSettings settings = settings_of(1);
    settings.reflection_share = share;
    const auto stages = wein_reference([=](const glm::dvec3&) { return medium; }, one_line(), 50, settings, {});
    return int(stages.grey.at(4, 4));
  };
  CHECK(grey({50, {0, 0, 0}}, 0.25) == 96);       // R = 0, E = 1/2
  CHECK(grey({-990, {0, 1000, 0}}, 0.25) == 64);  // R = 1, E = 0
  CHECK(grey({250, {0, 1e9, 0}}, 0.25) == 255);   // R = 1, E = 1
  CHECK(grey({50, {0, 1e9, 0}}, 0.25) == 159);    // R = 1, E = 1/2
}

TEST_CASE("model W: near the face air counts as water and nothing reflects") {
  const WeinField air = [](const glm::dvec3&) { return WeinMedium{-1000, {0, 500, 0}}; };
  const auto stages = wein_reference(air, one_line(), 50, settings_of(50, 10), {});
  CHECK(stages.scan_echogenicity.at(0, 9) == Approx(0.25));  // water: a quarter of the way from -50 to 150
  CHECK(stages.scan_reflection.at(0, 9) == 0);
  CHECK(stages.scan_reflection.at(0, 10) == Approx(1));
}

TEST_CASE("model W: a CT's gradient is that of its axes, over the reflection length, whatever its grid") {
  AcousticVolume volume;
  volume.grid.size = {12, 10, 14};
  volume.grid.spacing = {1.5, 0.8, 2.2};
  const double c = std::cos(0.4), s = std::sin(0.4);
  volume.grid.direction = glm::dmat3(-c, -s, 0, -s, c, 0, 0, 0, 1);  // rotated and reflected
  volume.voxels.resize(volume.grid.count());
  // Whole HU per voxel along each axis, which makes the field linear to the bit.
  for (int k = 0; k < 14; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 12; ++i)
        volume.voxels[volume.grid.offset({i, j, k})].hu = std::int16_t(3 * i - 2 * j + 4 * k);
  const double l = 1.9;
  const WeinMedium medium = wein_field(volume, l)(volume.grid.patient_from_index({5.3, 4.6, 6.1}));
  const glm::dvec3 expected = volume.grid.direction * (l * glm::dvec3(3 / 1.5, -2 / 0.8, 4 / 2.2));
  CHECK(medium.hu == Approx(3 * 5.3 - 2 * 4.6 + 4 * 6.1));
  for (int axis = 0; axis < 3; ++axis) CHECK(medium.gradient_hu[axis] == Approx(expected[axis]));

  const WeinMedium outside = wein_field(volume, l)({1e9, -1e9, 3});
  CHECK(outside.hu == Approx(-1000));
  CHECK(outside.gradient_hu == glm::dvec3(0));
}

TEST_CASE("LC2 is 1 for an affine map of its terms, and does not feel the ultrasound image's gain and offset") {
  const Image<double> e = noise(1), r = noise(2), other = noise(3);
  CHECK(lc2_reference(mix(2, e, -0.3, r, 7), kEverywhere, e, r) == Approx(1).epsilon(1e-12));
  const double partly = lc2_reference(mix(1, e, 1, other, 0), kEverywhere, e, r);
  CHECK(partly > 0.3);
  CHECK(partly < 0.7);
  CHECK(lc2_reference(mix(25, e, 25, other, -400), kEverywhere, e, r) == Approx(partly));
  CHECK(lc2_reference(other, kEverywhere, e, r) < 0.05);  // 2 of 300 degrees of freedom fit by chance
}

TEST_CASE("LC2 by patches is the mean of the patches' own, weighted by what the ultrasound image varies by in them") {
  const Image<double> e = noise(1), r = noise(2);
  Image<double> u = mix(1, e, 1, r, 0);
  const Image<double> other = noise(3);
  for (int y = 0; y < 15; ++y)
    for (int x = 10; x < 20; ++x) u.at(x, y) = 3 * other.at(x, y) + 5;  // the right half: different, and louder
  // Only 20 x 10 pixels count; patches of 10 are their halves.
  Image<std::uint8_t> both(20, 15), left = both, right = both;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) both.at(x, y) = (x < 10 ? left : right).at(x, y) = 1;
  const auto variance = [&](const Image<std::uint8_t>& mask) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < 300; ++i)
      if (mask.pixels[i]) sum += u.pixels[i], squares += u.pixels[i] * u.pixels[i];
    return squares - sum * sum / 100;
  };
  const double in_left = lc2_reference(u, left, e, r), in_right = lc2_reference(u, right, e, r);
  CHECK(in_left == Approx(1));
  CHECK(in_right < 0.1);
  CHECK(lc2_reference(u, both, e, r, 10) ==
        Approx((variance(left) * in_left + variance(right) * in_right) / (variance(left) + variance(right))));
  CHECK(lc2_reference(u, kEverywhere, e, r, 20) == Approx(lc2_reference(u, kEverywhere, e, r)));
}

TEST_CASE("LC2 of one term alone is the square of Pearson's correlation") {
  const Image<double> e = noise(1), u = mix(1, e, 0.8, noise(3), 0);
  double me = 0, mu = 0, ee = 0, uu = 0, eu = 0;
  for (std::size_t i = 0; i < 300; ++i) me += e.pixels[i] / 300, mu += u.pixels[i] / 300;
  for (std::size_t i = 0; i < 300; ++i) {
    const double a = e.pixels[i] - me, b = u.pixels[i] - mu;
    ee += a * a, uu += b * b, eu += a * b;
  }
  const Image<double> flat(20, 15, 0.3);
  CHECK(lc2_reference(u, kEverywhere, e, flat) == Approx(eu * eu / (ee * uu)));
  CHECK(lc2_reference(u, kEverywhere, flat, e) == Approx(eu * eu / (ee * uu)));
  CHECK(lc2_reference(u, kEverywhere, e, mix(0.5, e, 0, e, 0.1)) == Approx(eu * eu / (ee * uu)));  // the same twice
}

TEST_CASE("LC2 counts what the mask counts, and is 0 where there is nothing to explain") {
  const Image<double> e = noise(1), r = noise(2);
  Image<double> u = mix(1, e, 1, r, 0);
  Image<std::uint8_t> counts = kEverywhere;
  for (int y = 0; y < 15; ++y) {
    counts.at(3, y) = 0;
    u.at(3, y) = 1e6;
  }
  CHECK(lc2_reference(u, counts, e, r) == Approx(1));
  CHECK(lc2_reference(u, kEverywhere, e, r) < 0.1);
  CHECK(lc2_reference(u, Image<std::uint8_t>(20, 15), e, r) == 0);
  CHECK(lc2_reference(Image<double>(20, 15, 0.1), kEverywhere, e, r) == 0);
  const Image<double> flat(20, 15, 0.3);
  CHECK(lc2_reference(u, kEverywhere, flat, flat) == 0);
}
