#include "sim/reference/reverberation_reference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/model/reverberation.h"
#include "sim/reference/reference.h"

namespace insonate {
namespace {

// Returns what one round trip counts as.
double counted(double round, double least) {
  return round > least ? round * std::pow(1 - std::pow(least / round, 2), 8) : 0;
}

double cubic_b_spline(double x) {
  const double away = std::abs(x);
  return away < 1 ? 2.0 / 3 - away * away * (1 - away / 2) : std::pow(std::max(2 - away, 0.0), 3) / 6;
}

}  // namespace

Image<double> reverberation_reference(const Image<double>& intensity, const Image<double>& reflection,
                                      const ScanLines& lines, const Settings& settings) {
  const int d = lines.samples;
  const double dr = lines.dr_mm(), l = settings.reflection_length_mm;
  const int near = std::max(int(std::ceil(l / dr - 1e-3)), 1);  // l in whole samples
  struct Reflector {
    int sample;
    double strength, place_mm;
  };
  Image<double> repeats(intensity.width, d);
  for (int line = 0; line < intensity.width; ++line) {
    const auto i_at = [&](int k) { return intensity.at(line, std::clamp(k, 0, d - 1)); };
    const auto strength = [&](int k) {
      return i_at(k) > kLeastReverberant ? std::min(reflection.at(line, k) / (i_at(k) * i_at(k)), 1.0) : 0;
    };
    std::vector<Reflector> reflectors;
    for (int k = 0; k < d && reflectors.size() < std::size_t(kMostReflectors); ++k) {
      if (strength(k) <= kLeastRound) continue;
      double sum = 0, moment = 0;
      for (int j = std::max(k - near + 1, 0); j < std::min(k + near, d); ++j) {
        sum += strength(j);
        moment += strength(j) * (lines.r_min_mm + (j + 0.5) * dr);
      }
      reflectors.push_back({k, strength(k), moment / sum});
    }

    const auto repeat = [&](const Reflector& deep, double echo, double apart_mm, double gain) {
      for (int n = 1; n <= kMostRepeats && apart_mm > 0; ++n) {
        const double position = deep.sample + n * apart_mm / dr;
        if (position >= d + 1) break;  // the spline of a later position no longer covers the last sample
        echo *= gain;
        for (int k = std::max(int(position) - 1, 0); k <= std::min(int(position) + 2, d - 1); ++k)
          repeats.at(line, k) += heard(cubic_b_spline(k - position) * echo);
      }
    };
    for (std::size_t j = 0; j < reflectors.size(); ++j) {
      const Reflector& deep = reflectors[j];
      const double echo = reflection.at(line, deep.sample), before = i_at(deep.sample - near + 1);
      repeat(deep, echo, deep.place_mm,
             settings.face_reflection * counted(deep.strength * before * before, kLeastFromFace));
      for (std::size_t i = 0; i < j && settings.reverberation; ++i) {
        const Reflector& shallow = reflectors[i];
        const double apart = deep.place_mm - shallow.place_mm;
        const double separate = std::clamp(2 * apart / l - 1, 0.0, 1.0);
        const double behind = i_at(shallow.sample + near), between = behind > before ? before / behind : 1;
        repeat(deep, std::min(dr / l, 1.0) * echo, apart,
               counted(separate * shallow.strength * deep.strength * between * between, kLeastRound));
      }
    }
  }
  return repeats;
}

}  // namespace insonate
