#include "sim/reference/reverberation_reference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/model/mirror_image.h"
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

struct Reflector {
  int sample;
  double strength, place_mm;
};

/// What happens along a line.
class Along {
public:
  Along(const Image<double>& intensity, const Image<double>& reflection, const ScanLines& lines,
        const Settings& settings, int line)
      : intensity_(intensity),
        reflection_(reflection),
        lines_(lines),
        line_(line),
        near_(std::max(int(std::ceil(settings.reflection_length_mm / lines.dr_mm() - 1e-3)), 1)) {}

  double intensity(int k) const { return intensity_.at(line_, std::clamp(k, 0, lines_.samples - 1)); }
  double before(int k) const { return intensity(k - near_ + 1); }
  double behind(int k) const { return intensity(k + near_); }
  double strength(int k) const {
    const double arriving = intensity(k);
    return arriving > kMinReverberant ? std::min(reflection_.at(line_, k) / (arriving * arriving), 1.0) : 0;
  }

  /// Returns the place of the interface that a sample shows; its own counts `own` besides.
  double place_mm(int k, double own = 0) const {
    double sum = own, moment = own * (lines_.r_min_mm + (k + 0.5) * lines_.dr_mm());
    for (int j = std::max(k - near_ + 1, 0); j < std::min(k + near_, lines_.samples); ++j) {
      sum += strength(j);
      moment += strength(j) * (lines_.r_min_mm + (j + 0.5) * lines_.dr_mm());
    }
    return sum > 0 ? moment / sum : lines_.r_min_mm + (k + 0.5) * lines_.dr_mm();
  }

private:
  const Image<double>& intensity_;
  const Image<double>& reflection_;
  const ScanLines& lines_;
  int line_, near_;
};

}  // namespace

Image<double> reverberation_reference(const Image<double>& intensity, const Image<double>& reflection,
                                      const ScanLines& lines, const Settings& settings) {
  const int d = lines.samples;
  const double dr = lines.dr_mm(), l = settings.reflection_length_mm;
  Image<double> repeats(intensity.width, d);
  for (int line = 0; line < intensity.width; ++line) {
    const Along along(intensity, reflection, lines, settings, line);
    std::vector<Reflector> reflectors;
    for (int k = 0; k < d && reflectors.size() < std::size_t(kMaxReflectors); ++k)
      if (along.strength(k) > kMinRound) reflectors.push_back({k, along.strength(k), along.place_mm(k)});

    const auto repeat = [&](const Reflector& deep, double echo, double apart_mm, double gain) {
      for (int n = 1; n <= kMaxRepeats && apart_mm > 0; ++n) {
        const double position = deep.sample + n * apart_mm / dr;
        if (position >= d + 1) break;  // the spline of a later position no longer covers the last sample
        echo *= gain;
        for (int k = std::max(int(position) - 1, 0); k <= std::min(int(position) + 2, d - 1); ++k)
          repeats.at(line, k) += heard(cubic_b_spline(k - position) * echo);
      }
    };
    for (std::size_t j = 0; j < reflectors.size(); ++j) {
      const Reflector& deep = reflectors[j];
      const double echo = reflection.at(line, deep.sample), before = along.before(deep.sample);
      repeat(deep, echo, deep.place_mm,
             face_reflection(settings, lines.fan.steering) * counted(deep.strength * before * before, kMinFromFace));
      for (std::size_t i = 0; i < j && settings.reverberation; ++i) {
        const Reflector& shallow = reflectors[i];
        const double apart = deep.place_mm - shallow.place_mm;
        const double separate = std::clamp(2 * apart / l - 1, 0.0, 1.0);
        const double behind = along.behind(shallow.sample), between = behind > before ? before / behind : 1;
        repeat(deep, std::min(dr / l, 1.0) * echo, apart,
               counted(separate * shallow.strength * deep.strength * between * between, kMinRound));
      }
    }
  }
  return repeats;
}

void add_mirror_images(Image<std::complex<double>>& echo, const Image<double>& intensity,
                       const Image<double>& reflection, const ScanLines& lines, const Settings& settings) {
  const double dr = lines.dr_mm(), l = settings.reflection_length_mm;
  const int n = std::max(int(l / (4 * dr) + 1e-3), 1);  // every n-th sample counts
  for (int line = 0; line < echo.width; ++line) {
    const Along along(intensity, reflection, lines, settings, line);
    int gas = lines.samples;  // the line's first sample in gas
    const auto echo_at = [&](int k) { return k < 0 || k >= gas ? 0.0 : echo.at(line, k); };
    const auto loss = [&](int k) {
      const double arriving = along.intensity(k);
      return arriving > kMinReverberant ? 1 - std::pow(std::min(along.intensity(k + 1) / arriving, 1.0), l / dr) : 0;
    };
    double left = kMaxMirrored;
    for (int j = 0; j < lines.samples && left > 0; j += n) {
      const double t = std::clamp((loss(j) - kMinMirror) / (kFullMirror - kMinMirror), 0.0, 1.0);
      const double counted = std::min(std::min(n * dr / l, 1.0) * t * t * (3 - 2 * t), left);
      if (counted == 0) continue;
      gas = std::min(gas, j);
      left -= counted;
      const double place_mm = along.place_mm(j, kOwnPlace);
      const double share = std::sqrt(settings.mirror_image) * counted;
      double kept = 1;
      for (int p = 1; kept >= kMinOfFace && p * place_mm < lines.r_max_mm; ++p) {
        for (int k = j + 1; k < lines.samples; ++k) {
          const double r = (p + 1) * place_mm - (lines.r_min_mm + (k + 0.5) * dr);  // where the echo comes from
          const double source = (r - lines.r_min_mm) / dr - 0.5;
          if (source < -1) break;
          const double separate = std::clamp((place_mm - r) / l - 1, 0.0, 1.0);
          if (separate == 0) continue;
          const int low = int(std::floor(source));
          const double f = source - low;
          const double way =
              std::min(along.before(j) / ((1 - f) * along.intensity(low) + f * along.intensity(low + 1)), 1.0);
          echo.at(line, k) += share * kept * separate * way * way * ((1 - f) * echo_at(low) + f * echo_at(low + 1)) /
                              std::hypot(f, 1 - f);
        }
        kept *= std::sqrt(settings.face_reflection) * along.before(j);
      }
    }
  }
}

}  // namespace insonate
