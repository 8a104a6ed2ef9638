#include "sim/model/noise.h"

#include <glm/gtc/constants.hpp>

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

}  // namespace

Image<double> electronic_noise(const ScanLines& lines, const Settings& settings) {
  Image<double> noise(int(lines.lines.size()), lines.samples);
  const double step = lines.dr_mm() / settings.reflection_length_mm;
  for (int line = 0; line < noise.width; ++line) {
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
      noise.at(line, k) = std::abs((1 - f) * before + f * behind) / std::hypot(1 - f, f);
    }
  }
  return noise;
}

double noise_level(const Settings& settings) {
  return settings.electronic_noise ? settings.fixed_level * std::pow(10.0, settings.noise_db / 10) : 0;
}

double clutter_share(const Settings& settings) {
  return settings.clutter ? std::pow(10.0, settings.clutter_db / 10) : 0;
}

}  // namespace insonate
