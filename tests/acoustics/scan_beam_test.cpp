#include "sim/acoustics/scan_beam.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/acoustics/beam_profile.h"
#include "sim/acoustics/echo_lines.h"
#include "tests/acoustics/helpers.h"

using namespace insonate;
using test::shipped;
using test::spectrum_of;
using Complex = std::complex<double>;

namespace {

// A linear array with a pulse of a few percent bandwidth, for which the formulas of a single frequency hold. It has no
// lens and is so low that its height changes nothing in the imaging plane.
Transducer narrow_band() {
  Transducer transducer;
  transducer.elements = 128;
  transducer.pitch_mm = 0.25;
  transducer.kerf_mm = 0.02;
  transducer.height_mm = 0.5;
  transducer.frequency_mhz = 4;
  transducer.bandwidth_percent = 5;
  transducer.excitation_cycles = 0;
  return transducer;
}

Beamforming focused(double focus_mm, double f_number) {
  Beamforming beamforming;
  beamforming.transmit_focus_mm = focus_mm;
  beamforming.transmit_f_number = beamforming.receive_f_number = f_number;
  return beamforming;
}

// The width of an aperture along x, mm: its elements' number times the pitch.
double width_of(const Aperture& aperture, const Transducer& transducer) {
  double least = 0, most = 0;
  for (const Rectangle& rectangle : aperture) {
    least = std::min(least, rectangle.centre.x);
    most = std::max(most, rectangle.centre.x);
  }
  return most - least + transducer.pitch_mm;
}

double full_width(const std::function<double(double)>& amplitude, double level) {
  const double threshold = level * amplitude(0);
  double inside = 0, outside = 0.05;
  while (amplitude(outside) > threshold) outside += 0.05;
  for (int i = 0; i < 30; ++i) {
    const double middle = (inside + outside) / 2;
    (amplitude(middle) > threshold ? inside : outside) = middle;
  }
  return 2 * inside;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

}  // namespace

TEST_CASE("at the focus, beams are as wide as their aperture's diffraction: sinc one way, sinc^2 both ways") {
  const Transducer transducer = narrow_band();
  const double depth = 60;
  for (const double f_number : {3.0, 5.0}) {
    const Beamforming beamforming = focused(depth, f_number);
    const ScanBeam beam(transducer, beamforming, line_at(transducer, 0));
    const double width = width_of(beam.transmit_aperture(), transducer);
    const double unit = transducer.wavelength_mm() * depth / width;
    const auto one_way = [&](double x) {
      return std::abs(spectrum_of(beam.transmitted({x, depth, 0}), transducer.frequency_mhz, beamforming.sampling));
    };
    CAPTURE(f_number, width);
    // |sinc| is 1/2 at 0.603, sinc^2 at 0.443, sinc^4 at 0.319 lambda z / D. The elements' own directivity, and the
    // path that is longer aside, take up to 2 %.
    CHECK(full_width(one_way, 0.5) / unit == Approx(1.207).epsilon(0.02));
    CHECK(full_width(one_way, kHalfPower) / unit == Approx(0.886).epsilon(0.02));
    const ScanLine line = line_at(transducer, 0);
    CHECK(beam_profile(transducer, beamforming, line, depth).lateral_mm / unit == Approx(0.886).epsilon(0.02));
    CHECK(beam_profile(transducer, beamforming, line, depth, kHalfPower).lateral_mm / unit ==
          Approx(0.638).epsilon(0.02));
  }
}

TEST_CASE("wide-band pulses keep the width of the focus within 5 % of the formula at their mean frequency") {
  Transducer transducer = narrow_band();
  transducer.bandwidth_percent = 60;
  const double depth = 60;
  const Beamforming beamforming = focused(depth, 4);
  const ScanLine line = line_at(transducer, 0);
  const double unit = transducer.wavelength_mm() * depth /
                      width_of(ScanBeam(transducer, beamforming, line).transmit_aperture(), transducer);
  CHECK(beam_profile(transducer, beamforming, line, depth).lateral_mm / unit == Approx(0.886).epsilon(0.05));
}

TEST_CASE("at the lens's focus, the slice is as thick as the diffraction of the elements' height") {
  Transducer transducer = narrow_band();
  transducer.height_mm = 12;
  transducer.elevation_focus_mm = 50;
  const ScanLine line = line_at(transducer, 0);
  const double unit = transducer.wavelength_mm() * 50 / transducer.height_mm;
  // An aperture of few elements, so that the path to the point hardly depends on the element.
  const BeamProfile profile = beam_profile(transducer, focused(50, 12), line, 50);
  CHECK(profile.elevation_mm / unit == Approx(0.886).epsilon(0.02));
  transducer.elevation_focus_mm = 0;
  CHECK(beam_profile(transducer, focused(50, 12), line, 50).elevation_mm > 3 * profile.elevation_mm);
}

TEST_CASE("a focused echo is the product of the apertures' integrals, at the time there and back") {
  Transducer transducer = narrow_band();
  transducer.height_mm = 8;
  transducer.elevation_focus_mm = 60;
  for (const double steering : {0.0, 6.3}) {
    const ScanBeam beam(transducer, focused(60, 4), line_at(transducer, steering));
    const glm::dvec3 focus = beam.line().start + 60.0 * beam.line().direction;
    double sent = 0, heard = 0;
    for (const Rectangle& part : beam.transmit_aperture()) sent += trapezoid_of(part, focus, kSpeedOfSound).area_mm;
    for (const Rectangle& part : beam.receive_aperture(60)) heard += trapezoid_of(part, focus, kSpeedOfSound).area_mm;
    const EchoLine echo = point_echo(beam, Pulse(transducer), focus);
    const std::vector<double> envelope = echo.envelope();
    const auto peak = std::max_element(envelope.begin(), envelope.end()) - envelope.begin();
    // The paths from the rows of the lens differ by a hundredth of a wavelength among elements.
    CHECK(envelope[std::size_t(peak)] == Approx(sent * heard).epsilon(0.01));
    CHECK(echo.distance_mm(double(peak)) == Approx(60).margin(0.02));
  }
}

TEST_CASE("the beam across the focus is the sum over the elements, with their weights") {
  const Transducer transducer = narrow_band();
  const double depth = 70, k = glm::two_pi<double>() / transducer.wavelength_mm();
  for (const auto transmit : {Apodization::uniform, Apodization::hann})
    for (const auto receive : {Apodization::uniform, Apodization::hann}) {
      Beamforming beamforming = focused(depth, 4);
      beamforming.receive_f_number = 3;
      beamforming.transmit_apodization = transmit;
      beamforming.receive_apodization = receive;
      const ScanBeam beam(transducer, beamforming, line_at(transducer, 0));
      const auto pattern = [&](double x, double f_number, Apodization apodization) {
        Complex sum = 0;
        const double half = depth / f_number / 2;
        for (const ElementPlace& place : element_places(transducer)) {
          const double across = place.centre.x / half;
          if (std::abs(across) > 1) continue;
          const double weight =
              apodization == Apodization::hann ? std::pow(std::cos(glm::half_pi<double>() * across), 2) : 1;
          const double path = std::hypot(depth, x - place.centre.x) - std::hypot(depth, place.centre.x);
          sum += std::polar(weight, -k * path);
        }
        return std::abs(sum);
      };
      const auto expected = [&](double x) { return pattern(x, 4, transmit) * pattern(x, 3, receive); };
      const Pulse pulse(transducer);
      const double middle = largest(point_echo(beam, pulse, {0, depth, 0}).envelope());
      for (const double x : {0.4, 0.9, 1.5, 2.2}) {
        CAPTURE(int(transmit), int(receive), x);
        CHECK(largest(point_echo(beam, pulse, {x, depth, 0}).envelope()) / middle ==
              Approx(expected(x) / expected(0)).margin(0.01));
      }
    }
}

TEST_CASE("transmitting with one aperture and receiving with the other may be exchanged") {
  const Transducer transducer = shipped("curvilinear");
  Beamforming there = focused(60, 4);
  there.dynamic_receive = false;
  there.receive_f_number = 2.5;
  there.receive_apodization = Apodization::hann;
  Beamforming back = there;
  std::swap(back.transmit_f_number, back.receive_f_number);
  std::swap(back.transmit_apodization, back.receive_apodization);
  const ScanLine line = line_at(transducer, 11);
  const glm::dvec3 point = line.start + 43.0 * line.direction + glm::dvec3(1, 0, 2);
  const SampledResponse a = ScanBeam(transducer, there, line).both_ways(point);
  const SampledResponse b = ScanBeam(transducer, back, line).both_ways(point);
  REQUIRE(a.samples.size() == b.samples.size());
  CHECK(a.first == b.first);
  for (std::size_t k = 0; k < a.samples.size(); ++k)
    CHECK(a.samples[k] == Approx(b.samples[k]).margin(1e-12 * largest(a.samples)));
}

TEST_CASE("both ways is the convolution of the two apertures' responses") {
  const Transducer transducer = shipped("phased");
  const ScanLine line = line_at(transducer, -20);
  Beamforming beamforming = focused(70, 5);
  beamforming.receive_f_number = 3;
  beamforming.receive_apodization = Apodization::hann;
  const ScanBeam beam(transducer, beamforming, line);
  const glm::dvec3 point = line.start + 90.0 * line.direction + glm::dvec3(2, 1, -1);
  const SampledResponse direct = beam.both_ways(point);
  const SampledResponse parts = convolved(beam.transmitted(point), beam.received(point), beamforming.sampling);
  REQUIRE(direct.samples.size() == parts.samples.size());
  CHECK(direct.first == parts.first);
  for (std::size_t k = 0; k < parts.samples.size(); ++k)
    CHECK(direct.samples[k] == Approx(parts.samples[k]).margin(1e-12 * largest(parts.samples)));
}

TEST_CASE("the rectangles of a beam are small enough from its nearest depth on") {
  // Against the exact response of whole elements, which needs an array without a lens.
  for (const char* name : {"curvilinear", "linear", "phased"}) {
    Transducer transducer = shipped(name);
    transducer.elevation_focus_mm = 0;
    const Beamforming beamforming = focused(40, 3);
    const ScanBeam beam(transducer, beamforming, line_at(transducer, 0));
    Aperture whole;
    const std::size_t parts = beam.transmit_aperture().size();
    for (const Rectangle& part : beam.transmit_aperture()) {
      if (!whole.empty() && glm::distance(whole.back().lateral, part.lateral) < 1e-12 &&
          whole.back().centre.x == part.centre.x)
        continue;
      whole.push_back(part);
      whole.back().centre.z = 0;
      whole.back().height_mm = transducer.height_mm;
    }
    REQUIRE(whole.size() < parts);
    for (const glm::dvec3& point : {glm::dvec3(0, 10, 0), glm::dvec3(1, 10, 2), glm::dvec3(0, 20, 0),
                                    glm::dvec3(2, 20, 1), glm::dvec3(3, 40, 1)}) {
      const Complex expected = spectrum_of(spatial_response(whole, point, beamforming.sampling, RectangleMethod::exact),
                                           transducer.frequency_mhz, beamforming.sampling);
      const Complex got = spectrum_of(beam.transmitted(point), transducer.frequency_mhz, beamforming.sampling);
      const double all = std::abs(spectrum_of(beam.transmitted(point), 0, beamforming.sampling));
      CAPTURE(name, point.x, point.y, point.z);
      // What Beamforming::nearest_mm states.
      CHECK(std::abs(got - expected) < (point.y < 20 ? 0.01 : 0.003) * all);
    }
  }
}

TEST_CASE("a dynamic receive focus keeps lines narrow beside the transmit focus") {
  const Transducer transducer = shipped("linear");
  Beamforming dynamic = focused(20, 3);
  Beamforming fixed = dynamic;
  fixed.dynamic_receive = false;
  const ScanLine line = line_at(transducer, 0);
  // Alike in the focus, but for the pulse's ends, which lie beside it.
  CHECK(beam_profile(transducer, dynamic, line, 20).lateral_mm ==
        Approx(beam_profile(transducer, fixed, line, 20).lateral_mm).epsilon(1e-4));
  for (const double depth : {10.0, 40.0})
    CHECK(beam_profile(transducer, dynamic, line, depth).lateral_mm <
          0.85 * beam_profile(transducer, fixed, line, depth).lateral_mm);
}

TEST_CASE("widths across the line are resolved to a thousandth") {
  const Transducer transducer = shipped("linear");
  const ScanLine line = line_at(transducer, 0);
  const Beamforming beamforming = focused(20, 4);
  const ScanBeam beam(transducer, beamforming, line);
  const Pulse pulse(transducer);
  const auto amplitude = [&](double x, double z) { return largest(point_echo(beam, pulse, {x, 26, z}).envelope()); };
  const BeamProfile profile = beam_profile(transducer, beamforming, line, 26, 0.3);
  CHECK(profile.lateral_mm == Approx(full_width([&](double x) { return amplitude(x, 0); }, 0.3)).epsilon(1e-3));
  CHECK(profile.elevation_mm == Approx(full_width([&](double z) { return amplitude(0, z); }, 0.3)).epsilon(1e-3));
}

TEST_CASE("widths lie between samples") {
  const Transducer transducer = shipped("linear");
  const ScanLine line = line_at(transducer, 0);
  for (const double per_us : {100.0, 130.0, 170.0}) {
    Beamforming coarse = focused(20, 4), fine = focused(20, 4);
    coarse.sampling.per_us = per_us;
    fine.sampling.per_us = 1000;
    CAPTURE(per_us);
    // The envelope is straight between samples to the square of a step, 0.1 % here.
    CHECK(beam_profile(transducer, coarse, line, 20).axial_mm ==
          Approx(beam_profile(transducer, fine, line, 20).axial_mm).epsilon(0.005));
  }
}

TEST_CASE("lines beside the middle have the focus of the middle line") {
  for (const auto& [name, position] :
       std::vector<std::pair<std::string, double>>{{"curvilinear", 40 * 0.508}, {"linear", -12}, {"phased", 25}}) {
    Transducer transducer = shipped(name);
    transducer.bandwidth_percent = 5;
    transducer.excitation_cycles = 0;
    const Beamforming beamforming = focused(45, 6);
    const BeamProfile middle = beam_profile(transducer, beamforming, line_at(transducer, 0), 45);
    const BeamProfile aside = beam_profile(transducer, beamforming, line_at(transducer, position), 45);
    CAPTURE(name);
    // A steered aperture looks smaller by the cosine.
    const double seen = name == "phased" ? std::cos(glm::radians(position)) : 1;
    CHECK(aside.lateral_mm * seen == Approx(middle.lateral_mm).epsilon(0.03));
    CHECK(aside.axial_mm == Approx(middle.axial_mm).epsilon(0.01));
  }
}
