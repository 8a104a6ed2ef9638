// The echo of a point by another way: Rayleigh integrals at single frequencies over points of the elements, as SIMUS
// computes them (Garcia, Computer Methods and Programs in Biomedicine 218, 2022), and an inverse Fourier transform. It
// shares neither trapezoids nor sampling nor the delays of scan_beam.cpp.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "sim/acoustics/echo_lines.h"
#include "tests/acoustics/helpers.h"

using namespace insonate;
using test::shipped;
using Complex = std::complex<double>;

namespace {

constexpr double kSpeed = kSpeedOfSound;

// Returns the integral of exp(-i w (r / c + lens)) / (2 pi r) over an element, mm.
Complex over_element(const Transducer& transducer, const ElementPlace& place, const glm::dvec3& point,
                     double frequency_mhz) {
  constexpr int kColumns = 10, kRows = 80;
  const double width = transducer.element_width_mm() / kColumns, height = transducer.height_mm / kRows;
  const double focus = transducer.elevation_focus_mm, w = glm::two_pi<double>() * frequency_mhz;
  Complex sum = 0;
  for (int i = 0; i < kColumns; ++i)
    for (int j = 0; j < kRows; ++j) {
      const double x = (i + 0.5) * width - transducer.element_width_mm() / 2;
      const double z = (j + 0.5) * height - transducer.height_mm / 2;
      const double r = glm::distance(point, place.centre + x * place.lateral + glm::dvec3(0, 0, z));
      const double lens = focus - std::hypot(focus, z);
      sum += std::polar(width * height / (glm::two_pi<double>() * r), -w * (r + lens) / kSpeed);
    }
  return sum;
}

// Returns the response of the elements within `width_mm`, focused at a distance along the line, at one frequency.
Complex focused(const std::vector<Complex>& elements, const Transducer& transducer, const ScanLine& line,
                double focus_mm, double width_mm, double frequency_mhz) {
  const std::vector<ElementPlace> places = element_places(transducer);
  const glm::dvec3 focus = line.start + focus_mm * line.direction;
  Complex sum = 0;
  for (std::size_t e = 0; e < places.size(); ++e) {
    if (glm::distance(places[e].centre, line.start) > width_mm / 2) continue;
    const double early_mm = glm::distance(focus, places[e].centre) - focus_mm;
    sum += elements[e] * std::polar(1.0, glm::two_pi<double>() * frequency_mhz * early_mm / kSpeed);
  }
  return sum;
}

}  // namespace

TEST_CASE("an echo is the Fourier integral over the whole array") {
  struct Place {
    const char* name;
    double line, distance, across, elevation;
  };
  for (const Place& place : {Place{"curvilinear", 10.3, 52, 1.3, 1.1}, Place{"linear", 4.1, 17, -0.6, 0.5},
                             Place{"phased", 17, 66, 2.1, -2.3}, Place{"linear", 0, 31, 1.2, 0}}) {
    const Transducer transducer = shipped(place.name);
    const ScanLine line = line_at(transducer, place.line);
    Beamforming beamforming;
    beamforming.transmit_focus_mm = 40;
    beamforming.transmit_f_number = 3.3;
    beamforming.receive_f_number = 4.1;
    beamforming.attenuation_db_cm_mhz = 0.4;
    const glm::dvec3 point = line.start + place.distance * line.direction +
                             place.across * glm::dvec3(line.direction.y, -line.direction.x, 0) +
                             glm::dvec3(0, 0, place.elevation);
    const Pulse pulse(transducer);
    const double away = glm::distance(point, line.start), step = 0.05;  // MHz: the echo repeats after 20 us
    std::vector<double> frequencies;
    std::vector<Complex> spectrum;
    for (double f = step; f < 3.2 * transducer.frequency_mhz; f += step) {
      std::vector<Complex> elements;
      for (const ElementPlace& element : element_places(transducer))
        elements.push_back(glm::distance(element.centre, line.start) < 12 ? over_element(transducer, element, point, f)
                                                                          : 0);
      const double attenuation = std::pow(10, -0.4 * f * 2 * away / 10 / 20);
      frequencies.push_back(f);
      spectrum.push_back(step * pulse.spectrum(f) * attenuation * focused(elements, transducer, line, 40, 40 / 3.3, f) *
                         focused(elements, transducer, line, away, away / 4.1, f));
    }
    const auto error = [&](double nearest_mm) {
      Beamforming divided = beamforming;
      divided.nearest_mm = nearest_mm;
      const EchoLine echo = point_echo(ScanBeam(transducer, divided, line), pulse, point);
      double most = 0, off = 0;
      for (std::size_t k = 0; k < echo.samples.size(); ++k) {
        Complex expected = 0;
        for (std::size_t i = 0; i < frequencies.size(); ++i)
          expected += spectrum[i] * std::polar(1.0, glm::two_pi<double>() * frequencies[i] * echo.time_us(double(k)));
        most = std::max(most, std::abs(expected));
        off = std::max(off, std::abs(expected - echo.samples[k]));
      }
      return off / most;
    };
    CAPTURE(place.name, place.line, place.distance);
    // At 17 mm and deeper, rectangles for 10 mm are off by less than a thousandth. Smaller ones are nearer still, until
    // what folds back in sampling remains.
    const double usual = error(10), finer = error(2.5);
    CHECK(usual < 1e-3);
    CHECK(finer < 5e-4);
  }
}
