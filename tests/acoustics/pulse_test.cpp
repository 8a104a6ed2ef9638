#include "sim/acoustics/pulse.h"

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <complex>
#include <vector>

#include "sim/acoustics/transform.h"

using namespace insonate;
using Complex = std::complex<double>;

namespace {

Transducer with_pulse(double frequency_mhz, double bandwidth_percent, double cycles) {
  Transducer transducer;
  transducer.frequency_mhz = frequency_mhz;
  transducer.bandwidth_percent = bandwidth_percent;
  transducer.excitation_cycles = cycles;
  return transducer;
}

// The analytic pulse at a time, by the inverse Fourier integral.
Complex pulse_at(const Pulse& pulse, double time_us) {
  constexpr double kStep = 0.005, kMax = 40;  // MHz; the pulse repeats after 200 us
  Complex sum = 0;
  for (double f = kStep / 2; f < kMax; f += kStep)
    sum += kStep * pulse.spectrum(f) * std::polar(1.0, glm::two_pi<double>() * f * time_us);
  return sum;
}

Complex spectrum_of_samples(const std::vector<double>& samples, double middle, double per_us, double frequency) {
  Complex sum = 0;
  for (std::size_t k = 0; k < samples.size(); ++k)
    sum += samples[k] / per_us * std::polar(1.0, -glm::two_pi<double>() * frequency * (double(k) - middle) / per_us);
  return sum;
}

}  // namespace

TEST_CASE("the transform is Fourier's, forward and backward") {
  const Transform transform(30);
  const std::vector<double> samples{1, -2, 0.5, 7, 3};
  const std::vector<Complex> spectrum = transform.forward(samples);
  for (const std::size_t j : {0, 1, 7, 29}) {
    Complex expected = 0;
    for (std::size_t k = 0; k < samples.size(); ++k)
      expected += samples[k] * std::polar(1.0, -glm::two_pi<double>() * double(j * k) / 30);
    CHECK(std::abs(spectrum[j] - expected) < 1e-12);
  }
  const std::vector<Complex> back = transform.backward(spectrum);
  for (std::size_t k = 0; k < back.size(); ++k)
    CHECK(std::abs(back[k] - (k < samples.size() ? samples[k] : 0)) < 1e-14);
}

TEST_CASE("lengths of transforms are the next products of 2, 3 and 5") {
  CHECK(fast_length(0) == 1);
  CHECK(fast_length(7) == 8);
  CHECK(fast_length(31) == 32);
  CHECK(fast_length(45) == 45);
  CHECK(fast_length(1025) == 1080);
}

TEST_CASE("the envelope of every pulse is 1 in its middle and dies away within its reach") {
  for (const double cycles : {0.0, 1.0, 2.0, 6.5}) {
    const Pulse pulse(with_pulse(3.5, 70, cycles));
    CAPTURE(cycles);
    CHECK(std::abs(pulse_at(pulse, 0)) == Approx(1).epsilon(1e-3));
    for (const double side : {-1.0, 1.0}) {
      CHECK(std::abs(pulse_at(pulse, side * pulse.half_length_us()).real()) < 2e-6);
      CHECK(std::abs(pulse_at(pulse, side * pulse.half_length_us())) < 2e-3);
    }
    CHECK(std::abs(pulse.spectrum(1e-9)) < 1e-9);
    CHECK(pulse.spectrum(-3.5) == 0.0);
  }
}

TEST_CASE("the elements' response falls to half at the ends of the stated bandwidth") {
  const Pulse pulse(with_pulse(5, 60, 0));
  const double middle = std::abs(pulse.spectrum(5));
  // The mirror image at -5 MHz takes 4e-5.
  CHECK(std::abs(pulse.spectrum(5 * 0.7)) / middle == Approx(0.5).epsilon(1e-3));
  CHECK(std::abs(pulse.spectrum(5 * 1.3)) / middle == Approx(0.5).epsilon(1e-3));
}

TEST_CASE("an impulse's echo has the Gaussian's width") {
  const Pulse pulse(with_pulse(5, 60, 0));
  // 4 ln 2 / (pi 3 MHz)
  CHECK(pulse.impulse_fwhm_us() == Approx(4 * std::log(2.0) / (glm::pi<double>() * 3)));
  CHECK(std::abs(pulse_at(pulse, pulse.impulse_fwhm_us() / 2)) == Approx(0.5).epsilon(1e-3));
}

TEST_CASE("the sampled excitation and element responses multiply to the pulse's spectrum") {
  constexpr double kPerUs = 200;
  const double cycles = GENERATE(0.0, 1.0, 2.0, 2.5);
  const Pulse pulse(with_pulse(4, 50, cycles));
  const std::vector<double> element = pulse.element_response(kPerUs), excitation = pulse.excitation(kPerUs);
  CHECK(element.size() % 2 == 1);
  const auto product = [&](double f) {
    const Complex once = spectrum_of_samples(element, double(element.size() / 2), kPerUs, f);
    return once * once * spectrum_of_samples(excitation, double(excitation.size() - 1) / 2, kPerUs, f);
  };
  const double scale = std::abs(pulse.spectrum(4)) / std::abs(product(4));
  for (const double f : {2.5, 3.0, 3.7, 4.0, 4.4, 5.5}) {
    CAPTURE(cycles, f);
    CHECK(std::abs(scale * product(f) - pulse.spectrum(f)) < 1e-3 * std::abs(pulse.spectrum(4)));  // the steps
  }
}
