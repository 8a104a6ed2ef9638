#include "sim/acoustics/pulse.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace insonate {
namespace {

// A Gaussian is below 1e-6 beyond this many standard deviations.
constexpr double kGaussianReach = 5.3;

double sinc(double x) {
  const double y = glm::pi<double>() * x;
  return std::abs(y) < 1e-8 ? 1 : std::sin(y) / y;
}

double squared(double x) {
  return x * x;
}

}  // namespace

Pulse::Pulse(const Transducer& transducer)
    : frequency_mhz_(transducer.frequency_mhz),
      sigma_mhz_(transducer.bandwidth_percent / 100 * transducer.frequency_mhz / std::sqrt(8 * std::log(2.0))),
      excitation_us_(transducer.excitation_cycles / transducer.frequency_mhz) {
  // The value of the analytic pulse at 0 us is the integral of its spectrum.
  constexpr int kSteps = 4096;
  const double most = frequency_mhz_ + kGaussianReach * sigma_mhz_, step = most / kSteps;
  std::complex<double> middle = 0;
  for (int i = 0; i < kSteps; ++i) middle += step * raw_spectrum((i + 0.5) * step);
  scale_ = 1 / std::abs(middle);
}

std::complex<double> Pulse::raw_spectrum(double frequency_mhz) const {
  // A sine has the spectrum -i (..., its mirror image subtracted).
  const auto one_way = [&](double off_mhz) { return std::exp(-squared(off_mhz / (2 * sigma_mhz_))); };
  const std::complex<double> element(0,
                                     one_way(frequency_mhz + frequency_mhz_) - one_way(frequency_mhz - frequency_mhz_));
  if (excitation_us_ == 0) return element * element;
  // The sine begins at 0, so its phase in the middle is that of half its length.
  const std::complex<double> turn = std::polar(1.0, glm::pi<double>() * frequency_mhz_ * excitation_us_);
  const std::complex<double> sine =
      std::complex<double>(0, -1) * (turn * sinc((frequency_mhz - frequency_mhz_) * excitation_us_) -
                                     std::conj(turn) * sinc((frequency_mhz + frequency_mhz_) * excitation_us_));
  return element * element * sine;
}

std::complex<double> Pulse::spectrum(double frequency_mhz) const {
  return frequency_mhz > 0 ? scale_ * raw_spectrum(frequency_mhz) : 0;
}

double Pulse::half_length_us() const {
  return excitation_us_ / 2 + kGaussianReach / (glm::two_pi<double>() * sigma_mhz_);
}

double Pulse::impulse_fwhm_us() const {
  return std::sqrt(8 * std::log(2.0)) / (glm::two_pi<double>() * sigma_mhz_);
}

std::vector<double> Pulse::element_response(double per_us) const {
  // The square root of a Gaussian of standard deviation sigma has sqrt(2) sigma.
  const double sigma_us = 1 / (glm::two_pi<double>() * std::sqrt(2.0) * sigma_mhz_);
  const int half = int(std::ceil(kGaussianReach * sigma_us * per_us));
  std::vector<double> samples;
  for (int k = -half; k <= half; ++k) {
    const double t = k / per_us;
    samples.push_back(std::exp(-squared(t / sigma_us) / 2) * std::sin(glm::two_pi<double>() * frequency_mhz_ * t));
  }
  return samples;
}

std::vector<double> Pulse::excitation(double per_us) const {
  if (excitation_us_ == 0) return {1};
  std::vector<double> samples;
  for (int k = 0; k <= int(std::lround(excitation_us_ * per_us)); ++k)
    samples.push_back(std::sin(glm::two_pi<double>() * frequency_mhz_ * k / per_us));
  return samples;
}

}  // namespace insonate
