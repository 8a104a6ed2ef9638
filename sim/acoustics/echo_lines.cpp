#include "sim/acoustics/echo_lines.h"

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/acoustics/transform.h"

namespace insonate {
namespace {

// Error of interpolating exp(-x) linearly between points that lie this far apart: at most kNeperStep^2 / 8 = 0.1 %.
constexpr double kNeperStep = 0.089;
constexpr double kDbPerNeper = 8.685889638;

double nepers_per_mm(const Beamforming& beamforming, double frequency_mhz) {
  return 2 * beamforming.attenuation_db_cm_mhz / 10 * frequency_mhz / kDbPerNeper;  // both ways
}

// Adds a filtered spectrum to `sum`: by the pulse, by the attenuation over a distance, and by what the samples of both
// responses did to it. The pulse's spectrum is that of an analytic signal, so only positive frequencies remain.
void add_filtered(std::vector<std::complex<double>>& sum, const std::vector<std::complex<double>>& spectrum,
                  const Pulse& pulse, const Beamforming& beamforming, double distance_mm) {
  const Sampling& sampling = beamforming.sampling;
  const std::size_t length = spectrum.size();
  for (std::size_t k = 1; k < length / 2; ++k) {
    const double frequency = double(k) * sampling.per_us / double(length);
    const std::complex<double> response = pulse.spectrum(frequency);
    if (std::abs(response) == 0) continue;
    const double hat = hat_spectrum(frequency, sampling);
    sum[k] += spectrum[k] * response * std::exp(-nepers_per_mm(beamforming, frequency) * distance_mm) / (hat * hat);
  }
}

std::int64_t steps(double time_us, const Sampling& sampling) {
  return std::int64_t(std::ceil(time_us * sampling.per_us));
}

/// The parts of a line's spatial response that are attenuated as from one distance.
class Zones {
public:
  Zones(const ScanBeam& beam, double centre_mhz, double from_mm, double to_mm, std::int64_t first, std::size_t length)
      : first_(first), from_mm_(from_mm) {
    const double rate = nepers_per_mm(beam.beamforming(), centre_mhz);
    const int intervals = rate > 0 ? std::max(1, int(std::ceil((to_mm - from_mm) * rate / kNeperStep))) : 0;
    step_mm_ = intervals > 0 ? (to_mm - from_mm) / intervals : 0;
    zones_.assign(std::size_t(intervals) + 1, std::vector<double>(length));
  }

  void add(const SampledResponse& response, double amplitude, double distance_mm) {
    if (step_mm_ == 0) return add_to(zones_[0], response, amplitude);
    const double place = std::clamp((distance_mm - from_mm_) / step_mm_, 0.0, double(zones_.size() - 1));
    const std::size_t before = std::min(std::size_t(place), zones_.size() - 2);
    add_to(zones_[before], response, amplitude * (1 - (place - double(before))));
    add_to(zones_[before + 1], response, amplitude * (place - double(before)));
  }

  std::size_t size() const { return zones_.size(); }
  const std::vector<double>& samples(std::size_t zone) const { return zones_[zone]; }
  double distance_mm(std::size_t zone) const { return from_mm_ + double(zone) * step_mm_; }

private:
  void add_to(std::vector<double>& zone, const SampledResponse& response, double amplitude) const {
    const std::int64_t shift = response.first - first_;
    const std::int64_t from = std::max<std::int64_t>(0, -shift);
    const std::int64_t to = std::min(std::int64_t(response.samples.size()), std::int64_t(zone.size()) - shift);
    for (std::int64_t k = from; k < to; ++k)
      zone[std::size_t(k + shift)] += amplitude * response.samples[std::size_t(k)];
  }

  std::int64_t first_;
  double from_mm_, step_mm_ = 0;
  std::vector<std::vector<double>> zones_;
};

}  // namespace

std::vector<double> EchoLine::envelope() const {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const std::complex<double>& sample : samples) values.push_back(std::abs(sample));
  return values;
}

EchoLine point_echo(const ScanBeam& beam, const Pulse& pulse, const glm::dvec3& point_mm) {
  const Sampling& sampling = beam.beamforming().sampling;
  const SampledResponse response = beam.both_ways(point_mm);
  const std::int64_t half_length = steps(pulse.half_length_us(), sampling);
  std::vector<double> padded(response.samples.size() + std::size_t(2 * half_length));
  std::copy(response.samples.begin(), response.samples.end(), padded.begin() + half_length);

  // Twice as long, because the imaginary part dies away slowly if the band begins near 0 MHz (Pulse::half_length_us()).
  const Transform transform(fast_length(2 * padded.size()));
  std::vector<std::complex<double>> sum(transform.length());
  add_filtered(sum, transform.forward(padded), pulse, beam.beamforming(), glm::distance(point_mm, beam.line().start));
  EchoLine echo{double(response.first - half_length) * sampling.step_us(), sampling.step_us(), sampling.speed_mm_us,
                transform.backward(sum)};
  echo.samples.resize(padded.size());
  return echo;
}

EchoLine echo_line(const ScanBeam& beam, const Pulse& pulse, const std::vector<PointScatterer>& scatterers,
                   double from_mm, double to_mm) {
  const Sampling& sampling = beam.beamforming().sampling;
  const std::int64_t half_length = steps(pulse.half_length_us(), sampling);
  const std::int64_t first = std::int64_t(std::floor(2 * from_mm / sampling.speed_mm_us * sampling.per_us));
  const std::int64_t end = steps(2 * to_mm / sampling.speed_mm_us, sampling) + 1;
  const std::size_t padded = std::size_t(end - first + 2 * half_length);

  Zones zones(beam, pulse.frequency_mhz(), from_mm, to_mm, first - half_length, padded);
  for (const PointScatterer& scatterer : scatterers)
    zones.add(beam.both_ways(scatterer.position_mm), scatterer.amplitude,
              glm::distance(scatterer.position_mm, beam.line().start));

  const Transform transform(fast_length(padded + std::size_t(half_length)));  // so that the pulse does not wrap around
  std::vector<std::complex<double>> sum(transform.length());
  for (std::size_t zone = 0; zone < zones.size(); ++zone)
    add_filtered(sum, transform.forward(zones.samples(zone)), pulse, beam.beamforming(), zones.distance_mm(zone));
  const std::vector<std::complex<double>> samples = transform.backward(sum);
  return {
      double(first) * sampling.step_us(), sampling.step_us(), sampling.speed_mm_us,
      std::vector<std::complex<double>>(samples.begin() + half_length, samples.begin() + half_length + (end - first))};
}

std::vector<EchoLine> echo_lines(const Transducer& transducer, const Beamforming& beamforming,
                                 const std::vector<ScanLine>& lines, const std::vector<PointScatterer>& scatterers,
                                 double from_mm, double to_mm) {
  const Pulse pulse(transducer);
  std::vector<EchoLine> echoes(lines.size());
  tbb::parallel_for(std::size_t(0), lines.size(), [&](std::size_t i) {
    echoes[i] = echo_line(ScanBeam(transducer, beamforming, lines[i]), pulse, scatterers, from_mm, to_mm);
  });
  return echoes;
}

}  // namespace insonate
