#include "sim/model/noise.h"

#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

#include "sim/core/hash.h"

namespace insonate {
namespace {

constexpr std::uint32_t kSeed = 0x6e6f6973u;

// Returns a complex normal number whose magnitude has mean 1 (Box and Muller 1958).
std::complex<double> complex_normal(std::uint32_t line, std::uint32_t place) {
  const double share = unit_float(hash(kSeed, line, place, 0)) + 0x1p-25;  // in (0, 1): adds half the numbers' spacing
  const double phase = 2 * glm::pi<double>() * unit_float(hash(kSeed, line, place, 1));
  return std::polar(std::sqrt(-4 / glm::pi<double>() * std::log(share)), phase);
}

// Returns the noise as complex numbers whose magnitude has mean 1.
Image<std::complex<double>> filtered_noise(const ScanLines& lines, const Settings& settings) {
  Image<std::complex<double>> noise(int(lines.lines.size()), lines.samples);
  const double step = lines.dr_mm() / settings.reflection_length_mm;
  tbb::parallel_for(0, noise.width, [&](int line) {
    std::uint32_t place = 0;
    std::complex<double> before = complex_normal(std::uint32_t(line), 0),
                         behind = complex_normal(std::uint32_t(line), 1);
    for (int k = 0; k < lines.samples; ++k) {
      const double position = (k + 0.5) * step;
      if (const auto now = std::uint32_t(position); now != place) {
        before = now == place + 1 ? behind : complex_normal(std::uint32_t(line), now);
        behind = complex_normal(std::uint32_t(line), now + 1);
        place = now;
      }
      const double f = position - place;
      noise.at(line, k) = ((1 - f) * before + f * behind) / std::hypot(1 - f, f);
    }
  });
  return noise;
}

}  // namespace

Image<double> electronic_noise(const ScanLines& lines, const Settings& settings) {
  const Image<std::complex<double>> waves = filtered_noise(lines, settings);
  Image<double> noise(waves.width, waves.height);
  for (std::size_t i = 0; i < noise.pixels.size(); ++i) noise.pixels[i] = std::abs(waves.pixels[i]);
  return noise;
}

Image<std::complex<double>> noise_wave(const ScanLines& lines, const Settings& settings) {
  Image<std::complex<double>> noise = filtered_noise(lines, settings);
  for (std::complex<double>& n : noise.pixels) n *= std::sqrt(glm::pi<double>()) / 2;  // mean of the square 4/pi
  return noise;
}

glm::ivec2 noise_shift(const Pose& patient_from_probe, int look) {
  const glm::dmat4 matrix = patient_from_probe.matrix();
  std::uint32_t h = kSeed;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) h = hash(h, std::bit_cast<std::uint32_t>(float(matrix[column][row])));
  const auto of_look = std::uint32_t(2 * look);
  return {int(hash(h, of_look) >> 8), int(hash(h, of_look + 1) >> 8)};
}

std::complex<double> noise_of_pixel(const Image<std::complex<double>>& noise, const ImageGeometry& geometry,
                                    const ScanLines& lines, int x, int y) {
  const glm::dvec2 plane_mm = geometry.plane_mm(x, y);
  const LinePosition position = position_among(lines.fan, {plane_mm.x, std::abs(plane_mm.y)});
  const double line = position.line, sample = (position.r_mm - lines.r_min_mm) / lines.dr_mm() - 0.5;
  const double i = std::floor(line), k = std::floor(sample), fi = line - i, fk = sample - k;
  const auto wrapped = [](double value, int size) {
    const int rest = int(std::fmod(value, double(size)));
    return rest < 0 ? rest + size : rest;
  };
  const int i0 = wrapped(i, noise.width), i1 = i0 + 1 < noise.width ? i0 + 1 : 0;
  const int k0 = wrapped(k, noise.height), k1 = k0 + 1 < noise.height ? k0 + 1 : 0;
  // Lines are independent, so that a mean of two has less power than either.
  return ((1 - fi) * ((1 - fk) * noise.at(i0, k0) + fk * noise.at(i0, k1)) +
          fi * ((1 - fk) * noise.at(i1, k0) + fk * noise.at(i1, k1))) /
         std::hypot(1 - fi, fi);
}

double noise_level(const Settings& settings) {
  return settings.electronic_noise ? settings.fixed_level * std::pow(10.0, settings.noise_db / 10) : 0;
}

double clutter_share(const Settings& settings) {
  return settings.clutter ? std::pow(10.0, settings.clutter_db / 10) : 0;
}

}  // namespace insonate
