#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "sim/core/hash.h"
#include "sim/core/image.h"
#include "sim/gl/filter_error.h"
#include "sim/reference/reference.h"

/// Compares single precision on the graphics card with the reference: the allowed error, and where it is largest.
namespace insonate::test {

// Returns whether the device's own filter is too coarse for the tolerances here.
inline bool own_filter_is_coarse() {
  static const bool coarse = gl::measure_filter().is_coarse();
  return coarse;
}

// Returns settings that can be compared with the reference on any device: with exact filtering where it is needed.
template <typename AnySettings>
AnySettings exact_as_needed(AnySettings settings) {
  settings.exact_filter = settings.exact_filter || own_filter_is_coarse();
  return settings;
}

struct Worst {
  double error = 0;
  int x = 0, y = 0;
  double expected = 0, got = 0;
};

// Returns the worst disagreement, as a multiple of the tolerance at that place.
inline Worst worst(const Image<double>& expected, const Image<float>& got, const Image<double>& tolerated) {
  REQUIRE(expected.pixels.size() == got.pixels.size());
  Worst found;
  for (int y = 0; y < expected.height; ++y)
    for (int x = 0; x < expected.width; ++x) {
      REQUIRE(std::isfinite(got.at(x, y)));
      const double error = std::abs(expected.at(x, y) - double(got.at(x, y))) / tolerated.at(x, y);
      if (error > found.error) found = {error, x, y, expected.at(x, y), got.at(x, y)};
    }
  return found;
}

inline std::string described(const char* what, const Worst& w) {
  char text[200];
  std::snprintf(text, sizeof text, "%s: worst %.3g of the tolerance at (%d, %d): reference %.9g, GLSL %.9g", what,
                w.error, w.x, w.y, w.expected, w.got);
  return text;
}

// Where the tissue table is steep, as at the foot of gas's ramp, rounding alone decides a sample's impedance. No more
// accuracy can be asked there than single precision has. From a line's start to the filter's weights a coordinate in
// [0, 1] is rounded six times, each by up to 3e-8 of the body's 160 mm: 3e-5 mm in all. Filtering adds eight products
// of values around 1000 HU, each rounded by 6e-8: 2e-4 HU. References over fields with random errors of that size show
// the effect.
inline MediumField as_single_precision_knows_it(const MediumField& field, std::uint32_t seed, double position_mm = 3e-5,
                                                double hu = 2e-4) {
  return [&field, seed, position_mm, hu, count = std::uint32_t(0)](const glm::dvec3& p) mutable {
    const auto random = [&] { return 2.0 * unit_float(hash(seed, count++)) - 1.0; };
    const glm::dvec3 jitter(random(), random(), random());
    Medium medium = field(p + position_mm * jitter);
    medium.hu += hu * random();
    return medium;
  };
}

/// Returns the tolerance of a stage at each place: `basic` of the reference's value, plus the difference to references
/// over fields known in single precision.
template <typename Data, typename Basic>
Image<double> tolerated(const Data& expected, const std::array<Data, 4>& uncertain, Image<double> Data::*stage,
                        Basic&& basic) {
  Image<double> result = expected.*stage;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const double value = (expected.*stage).pixels[i];
    result.pixels[i] = basic(value);
    for (const Data& other : uncertain) result.pixels[i] += std::abs((other.*stage).pixels[i] - value);
  }
  return result;
}

/// Compares U in dB, down to where the dynamic range ends below the loudest. Grey levels are coarser, and gain and grey
/// map come after U.
/// @param of_amplitude  with waves: an error that is allowed, as a share of the largest amplitude within ten pixels of
///                      the row. The shader's sums of scatterers are whole numbers of 16 bits, and grains end in 0.
inline void check_fused(const Image<double>& expected, const std::array<Image<double>, 4>& uncertain,
                        const Image<float>& got, double dynamic_range_db, double of_amplitude = 0) {
  constexpr double kFused_db = 0.01;  // a twentieth of a grey level at 60 dB
  const double loudest = *std::max_element(expected.pixels.begin(), expected.pixels.end());
  const double faintest = loudest * std::pow(10, -dynamic_range_db / 10);
  const auto in_db = [&](const auto& fused, auto decibels) {
    for (std::size_t i = 0; i < fused.pixels.size(); ++i)
      decibels.pixels[i] = 10 * std::log10(std::max<double>(fused.pixels[i], faintest) / loudest);
    return decibels;
  };
  const Image<double> expected_db = in_db(expected, expected);
  Image<double> tolerated_db(expected.width, expected.height, kFused_db);
  for (const Image<double>& other : uncertain) {
    const Image<double> other_db = in_db(other, other);
    for (std::size_t i = 0; i < other_db.pixels.size(); ++i)
      tolerated_db.pixels[i] += std::abs(other_db.pixels[i] - expected_db.pixels[i]);
  }
  constexpr int kAround = 10;
  for (int i = 0; of_amplitude > 0 && i < int(expected.pixels.size()); ++i) {
    double around = 0;
    for (int j = std::max(i - kAround, 0); j <= std::min(i + kAround, int(expected.pixels.size()) - 1); ++j)
      around = std::max(around, expected.pixels[std::size_t(j)]);
    const double here = std::max(expected.pixels[std::size_t(i)], faintest);
    tolerated_db.pixels[std::size_t(i)] += 20 * std::log10(1 + of_amplitude * std::sqrt(around / here));
  }
  const Worst fused = worst(expected_db, in_db(got, got), tolerated_db);
  INFO(described("U in dB", fused));
  CHECK(fused.error < 1);
}

/// Compares grey levels inside the fan: at most 1 off on 99.9 %, at most 2 anywhere.
inline void check_grey(const std::vector<int>& expected, const std::vector<int>& got) {
  REQUIRE(expected.size() == got.size());
  std::size_t off_by_more_than_1 = 0;
  int worst_grey = 0;
  double mean = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const int error = std::abs(expected[i] - got[i]);
    worst_grey = std::max(worst_grey, error);
    off_by_more_than_1 += error > 1;
    mean += expected[i] / double(expected.size());
  }
  INFO("grey: " << off_by_more_than_1 << " of " << expected.size() << " off by more than 1, worst " << worst_grey);
  CHECK(double(off_by_more_than_1) <= 0.001 * double(expected.size()));
  CHECK(worst_grey <= 2);
  CHECK(mean > 10);  // a black picture would agree as well
}

/// Checks grey levels of waves: at most 1 off on 99.9 %, and anywhere by no more than an error of 2e-3 of the loudest
/// amplitude within ten pixels explains in the dark between grains, where a range of 60 dB shows it.
/// @param gain_db  by how much amplitudes may exceed what white shows
inline void check_grey_of_waves(const std::vector<int>& expected, const std::vector<int>& got, double gain_db = 0) {
  constexpr double kOfAmplitude = 2e-3, kGreysPerDb = 255 / 60.0;
  constexpr std::ptrdiff_t kAround = 10;
  std::size_t off_by_more_than_1 = 0;
  double worst = 0;
  int worst_error = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const int error = std::abs(expected[i] - got[i]);
    off_by_more_than_1 += error > 1;
    const auto from = expected.begin() + std::max(std::ptrdiff_t(i) - kAround, std::ptrdiff_t(0));
    const auto to = expected.begin() + std::min(std::ptrdiff_t(i) + kAround + 1, std::ptrdiff_t(expected.size()));
    double brighter_db = (*std::max_element(from, to) - expected[i]) / kGreysPerDb;
    if (*std::max_element(from, to) == 255) brighter_db += gain_db;
    const double explained = 20 * kGreysPerDb * std::log10(1 + kOfAmplitude * std::pow(10, brighter_db / 20));
    if (error / (1 + explained) <= worst) continue;
    worst = error / (1 + explained);
    worst_error = error;
  }
  INFO("grey: " << off_by_more_than_1 << " of " << expected.size() << " off by more than 1, worst " << worst_error
                << ", which is " << worst << " of what is explained");
  CHECK(double(off_by_more_than_1) <= 0.001 * double(expected.size()));
  CHECK(worst <= 1);
}

}  // namespace insonate::test
