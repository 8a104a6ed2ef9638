#include "sim/acoustics/echo_lines.h"

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "sim/acoustics/beam_profile.h"
#include "sim/acoustics/transform.h"
#include "tests/acoustics/helpers.h"

using namespace insonate;
using test::shipped;
using Complex = std::complex<double>;

namespace {

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// A small array at 5 MHz that an impulse drives.
Transducer impulse_driven(double bandwidth_percent) {
  Transducer transducer;
  transducer.elements = 32;
  transducer.pitch_mm = 0.3;
  transducer.kerf_mm = 0.03;
  transducer.height_mm = 1;
  transducer.frequency_mhz = 5;
  transducer.bandwidth_percent = bandwidth_percent;
  transducer.excitation_cycles = 0;
  return transducer;
}

Beamforming focused(double focus_mm, double attenuation = 0) {
  Beamforming beamforming;
  beamforming.transmit_focus_mm = focus_mm;
  beamforming.attenuation_db_cm_mhz = attenuation;
  return beamforming;
}

// The frequency about which the power of an analytic signal lies.
double mean_frequency(const EchoLine& echo) {
  Complex turn = 0;
  for (std::size_t k = 0; k + 1 < echo.samples.size(); ++k) turn += echo.samples[k + 1] * std::conj(echo.samples[k]);
  return std::arg(turn) / (glm::two_pi<double>() * echo.step_us);
}

}  // namespace

TEST_CASE("at the focus, an echo is as long as the pulse") {
  for (const double bandwidth : {30.0, 50.0, 70.0}) {
    const Transducer transducer = impulse_driven(bandwidth);
    const double expected = Pulse(transducer).impulse_fwhm_us() * kSpeedOfSound / 2;
    CAPTURE(bandwidth);
    // The elements' widths and heights lengthen it by a hundredth.
    CHECK(beam_profile(transducer, focused(50), line_at(transducer, 0), 50).axial_mm == Approx(expected).epsilon(0.02));
  }
}

TEST_CASE("attenuation takes its decibels, and takes more of the higher frequencies") {
  const Transducer transducer = impulse_driven(40);
  const ScanLine line = line_at(transducer, 0);
  const glm::dvec3 point(0, 50, 0);
  const Pulse pulse(transducer);
  const EchoLine plain = point_echo(ScanBeam(transducer, focused(50), line), pulse, point);
  const EchoLine attenuated = point_echo(ScanBeam(transducer, focused(50, 0.7), line), pulse, point);
  // A Gaussian spectrum of standard deviation s about f0, times exp(-b f), is one about f0 - b s^2 of
  // exp(-b f0 + b^2 s^2 / 2) times the height; b = 0.7 dB/(cm MHz) * 10 cm.
  const double b = 0.7 * 10 / (20 / std::log(10.0)), s = 2 / std::sqrt(8 * std::log(2.0));
  CHECK(largest(attenuated.envelope()) / largest(plain.envelope()) ==
        Approx(std::exp(-b * 5 + b * b * s * s / 2)).epsilon(0.01));
  CHECK(mean_frequency(plain) - mean_frequency(attenuated) == Approx(b * s * s).epsilon(0.02));
}

TEST_CASE("a line is the sum of its scatterers' echoes") {
  const Transducer transducer = shipped("linear");
  const ScanLine line = line_at(transducer, 2);
  const std::vector<PointScatterer> scatterers{
      {{2, 15, 0}, 1}, {{1.4, 18.3, 0.7}, -2}, {{2.9, 23, -1}, 0.5}, {{2, 29.9, 0}, 3}, {{3, 60, 0}, 5}};
  for (const double attenuation : {0.0, 0.5}) {
    const ScanBeam beam(transducer, focused(20, attenuation), line);
    const Pulse pulse(transducer);
    const EchoLine whole = echo_line(beam, pulse, scatterers, 12, 30);
    CHECK(whole.distance_mm(0) == Approx(12).margin(0.01));
    CHECK(whole.distance_mm(double(whole.samples.size() - 1)) == Approx(30).margin(0.02));
    std::vector<Complex> sum(whole.samples.size());
    for (const PointScatterer& scatterer : scatterers) {
      const EchoLine one = point_echo(beam, pulse, scatterer.position_mm);
      const auto shift = std::int64_t(std::lround((one.first_us - whole.first_us) / whole.step_us));
      for (std::size_t k = 0; k < one.samples.size(); ++k) {
        const std::int64_t at = shift + std::int64_t(k);
        if (at >= 0 && at < std::int64_t(sum.size())) sum[std::size_t(at)] += scatterer.amplitude * one.samples[k];
      }
    }
    double most = 0, off = 0, imaginary_off = 0;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      most = std::max(most, std::abs(sum[k]));
      off = std::max(off, std::abs(sum[k].real() - whole.samples[k].real()));
      imaginary_off = std::max(imaginary_off, std::abs(sum[k].imag() - whole.samples[k].imag()));
    }
    CAPTURE(attenuation);
    // Without attenuation only the pulse's tails differ. The attenuation's interpolation may be off by 0.1 % at the
    // centre frequency, and by the square of the ratio more above it.
    CHECK(off < (attenuation == 0 ? 1e-5 : 2e-3) * most);
    CHECK(imaginary_off < 2e-3 * most);
  }
}

TEST_CASE("100 MHz is fine enough") {
  for (const char* name : {"curvilinear", "linear", "phased"}) {
    const Transducer transducer = shipped(name);
    const ScanLine line = line_at(transducer, 0);
    Beamforming fine = focused(40);
    fine.sampling.per_us = 400;
    const glm::dvec3 point(0.8, 37, 0.6);
    const Pulse pulse(transducer);
    const EchoLine coarse = point_echo(ScanBeam(transducer, focused(40), line), pulse, point);
    const EchoLine exact = point_echo(ScanBeam(transducer, fine, line), pulse, point);
    const double most = largest(exact.envelope());
    double off = 0;
    for (std::size_t k = 0; k < coarse.samples.size(); ++k) {
      const auto at = std::int64_t(std::lround((coarse.time_us(double(k)) - exact.first_us) / exact.step_us));
      const Complex expected = at >= 0 && at < std::int64_t(exact.samples.size()) ? exact.samples[std::size_t(at)] : 0;
      off = std::max(off, std::abs(coarse.samples[k] - expected));
    }
    CAPTURE(name);
    // At 7.5 MHz steps of 10 ns leave 0.13 % of the largest echo, the other arrays' less: nothing within 57 dB.
    CHECK(off < 1.4e-3 * most);
  }
}

TEST_CASE("lines computed together equal lines computed alone") {
  const Transducer transducer = impulse_driven(60);
  std::vector<ScanLine> lines;
  for (int i = -3; i <= 3; ++i) lines.push_back(line_at(transducer, 0.5 * i));
  const std::vector<PointScatterer> scatterers{{{0.3, 30, 0}, 1}, {{-0.7, 34, 0.2}, 2}};
  const std::vector<EchoLine> together = echo_lines(transducer, focused(32), lines, scatterers, 25, 40);
  REQUIRE(together.size() == lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    CHECK(together[i].samples ==
          echo_line(ScanBeam(transducer, focused(32), lines[i]), Pulse(transducer), scatterers, 25, 40).samples);
}
