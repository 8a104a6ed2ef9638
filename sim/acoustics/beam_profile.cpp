#include "sim/acoustics/beam_profile.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/acoustics/echo_lines.h"

namespace insonate {
namespace {

constexpr double kFarthest_mm = 200;  // no beam is as wide

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

double axial_width(const EchoLine& echo, double level) {
  const std::vector<double> envelope = echo.envelope();
  const double threshold = level * largest(envelope);
  const auto above = [&](double value) { return value >= threshold; };
  const auto first = std::find_if(envelope.begin(), envelope.end(), above);
  const auto last = std::find_if(envelope.rbegin(), envelope.rend(), above).base() - 1;
  // Between the last sample below the threshold and the first above it; a point's echo begins and ends in silence.
  const auto crossing = [&](auto inside, int outwards) {
    const double in = *inside, out = *(inside + outwards);
    return double(inside - envelope.begin()) + outwards * (in - threshold) / (in - out);
  };
  return echo.distance_mm(crossing(last, 1)) - echo.distance_mm(crossing(first, -1));
}

/// The envelope's maximum as a function of where the point lies.
class Across {
public:
  Across(const ScanBeam& beam, const Pulse& pulse, const glm::dvec3& middle, const glm::dvec3& direction)
      : beam_(beam), pulse_(pulse), middle_(middle), direction_(direction) {}

  double at(double offset_mm) const {
    return largest(point_echo(beam_, pulse_, middle_ + offset_mm * direction_).envelope());
  }

  /// Returns the offset, to one side, of the outermost crossing of the threshold.
  double outermost(double threshold, double first_step_mm) const {
    constexpr int kSamples = 48, kBisections = 10;
    constexpr double kWellBelow = 0.3;  // of the threshold: less than any dip within a main lobe
    double far = first_step_mm;
    while (std::abs(far) < kFarthest_mm && at(far) > kWellBelow * threshold) far *= 1.5;
    double inside = 0, outside = far;
    for (int i = kSamples - 1; i > 0; --i) {
      inside = far * i / kSamples;
      if (at(inside) >= threshold) break;
      outside = inside;
      inside = 0;
    }
    for (int i = 0; i < kBisections; ++i) {
      const double middle = (inside + outside) / 2;
      (at(middle) >= threshold ? inside : outside) = middle;
    }
    return (inside + outside) / 2;
  }

private:
  const ScanBeam& beam_;
  const Pulse& pulse_;
  glm::dvec3 middle_, direction_;
};

}  // namespace

BeamProfile beam_profile(const Transducer& transducer, const Beamforming& beamforming, const ScanLine& line,
                         double distance_mm, double level) {
  const ScanBeam beam(transducer, beamforming, line);
  const Pulse pulse(transducer);
  const glm::dvec3 point = line.start + distance_mm * line.direction;
  const EchoLine echo = point_echo(beam, pulse, point);
  const double amplitude = largest(echo.envelope());
  const double step = transducer.wavelength_mm() / 2;
  const auto width = [&](const glm::dvec3& direction) {
    const Across across(beam, pulse, point, direction);
    return across.outermost(level * amplitude, step) - across.outermost(level * amplitude, -step);
  };
  return {distance_mm, axial_width(echo, level), width(glm::dvec3(line.direction.y, -line.direction.x, 0)),
          width(glm::dvec3(0, 0, 1)), amplitude};
}

}  // namespace insonate
