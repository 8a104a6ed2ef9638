// Tests fully developed speckle. The scatterers' echo in a homogeneous medium has the statistics of many scatterers per
// resolution cell: real and imaginary parts are normally distributed, so the envelope is Rayleigh distributed (Wagner,
// Smith, Sandrik, Lopez, IEEE Trans. Sonics Ultrason. 30 (1983) 156).

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <complex>
#include <cstdio>
#include <vector>

#include "sim/model/beam.h"
#include "sim/model/scatterers.h"
#include "tests/accuracy/media.h"

using namespace insonate;
using namespace insonate::test;

namespace {

constexpr int kSide = 63;
// Trilinear interpolation uses one cell to either side, so echoes more than two cells from each other share no
// scatterer. The lattice of 128 cells repeats after the last of these.
constexpr double kSpacingCells = 2.03;

/// Returns lines and samples along the lattice's axes, kSpacingCells from each other. No two echoes share a scatterer,
/// and they lie at all places between the lattice's points. `beside` lines, a tenth of a cell from each other, surround
/// each.
ScanLines independent_cells(double cell_mm, int beside) {
  ScanLines lines;
  lines.samples = kSide;
  lines.r_max_mm = kSide * kSpacingCells * cell_mm;
  for (int z = 0; z < kSide; ++z)
    for (int x = 0; x < kSide; ++x)
      for (int j = -beside; j <= beside; ++j)
        lines.lines.push_back(
            {glm::dvec3(x * kSpacingCells + 0.1 * j, 0, z * kSpacingCells) * cell_mm, glm::dvec3(0, 1, 0)});
  return lines;
}

Pose along_the_lattice(double cell_mm) {
  const glm::dmat3 turned(lattice_from_patient(cell_mm));
  return {glm::transpose(turned / glm::length(turned[0])), glm::dvec3(0)};
}

struct Statistics {
  double signal_to_noise = 0;
  double off_rayleigh = 0;  ///< the largest distance between the distributions
  double mean_power = 0;    ///< <|echo|^2>
};

/// Compares envelopes with the Rayleigh distribution of their own mean power.
Statistics statistics(std::vector<double> envelope) {
  std::sort(envelope.begin(), envelope.end());
  const double n = double(envelope.size());
  double sum = 0, squares = 0;
  for (const double a : envelope) {
    sum += a;
    squares += a * a;
  }
  const double mean = sum / n;
  Statistics found{mean / std::sqrt(squares / n - mean * mean), 0, squares / n};
  for (std::size_t i = 0; i < envelope.size(); ++i) {
    const double rayleigh = -std::expm1(-envelope[i] * envelope[i] / found.mean_power);
    found.off_rayleigh = std::max({found.off_rayleigh, rayleigh - double(i) / n, double(i + 1) / n - rayleigh});
  }
  return found;
}

std::vector<double> envelopes(BeamWindow window, int beam_lines) {
  Settings settings = without_absorption(0.5);
  settings.speckle = true;
  settings.beam_window = window;
  settings.beam_lines = beam_lines;
  const int beside = (beam_lines - 1) / 2;
  const ScanLines lines = independent_cells(settings.speckle_cell_mm, beside);
  const auto scan = traverse_reference(
      [](const glm::dvec3&) {
        return Medium{60, 0};
      },
      plain_table(), lines, settings, along_the_lattice(settings.speckle_cell_mm));
  const std::vector<double> weights = beam_weights(settings);
  std::vector<double> values;
  for (int line = 0; line < int(lines.lines.size()); line += beam_lines)
    for (int k = 0; k < lines.samples; ++k) {
      std::complex<double> echo = 0;
      for (int j = 0; j < beam_lines; ++j)
        echo += weights[std::size_t(j)] * std::complex(scan.echo_re.at(line + j, k), scan.echo_im.at(line + j, k));
      values.push_back(std::abs(echo));
    }
  return values;
}

}  // namespace

TEST_CASE("fully developed speckle has the signal to noise ratio of 1.91 and is Rayleigh distributed") {
  for (const int beam_lines : {1, 7}) {
    const std::vector<double> values = envelopes(BeamWindow::hann, beam_lines);
    REQUIRE(values.size() >= 100000);
    const Statistics found = statistics(values);
    std::printf("speckle of %zu cells, %d lines a beam: SNR %.4f, %.5f off Rayleigh, power %.4f\n", values.size(),
                beam_lines, found.signal_to_noise, found.off_rayleigh, found.mean_power);
    CHECK(found.signal_to_noise == Approx(std::sqrt(M_PI / (4 - M_PI))).margin(0.05));
    // Kolmogorov-Smirnov at a level of 5 %.
    CHECK(found.off_rayleigh < 1.36 / std::sqrt(double(values.size())));
    // Two parts of variance 1, or what remains of them after the window.
    if (beam_lines == 1) CHECK(found.mean_power == Approx(2).epsilon(0.01));
  }
}

TEST_CASE("an echo is interpolated between the lattice's points and keeps their variance") {
  Settings settings = without_absorption(0.5);
  settings.speckle = true;
  settings.speckle_seed = 5;
  const double cell = settings.speckle_cell_mm;
  constexpr int side = ScattererLattice::kSide;
  const ScattererLattice lattice = make_scatterers(5);
  const auto point = [&](int x, int y, int z) {
    const std::size_t i = 2 * std::size_t((z * side + y % side) * side + x);
    return std::complex<double>(lattice.stored[i], lattice.stored[i + 1]) * (kScattererScale / 32767);
  };
  // Even samples lie at the points (10, k/2, 20), past the lattice's end; odd ones half-way between. The second line
  // lies half-way to x = 11.
  ScanLines lines;
  lines.samples = 2 * (side + 5);
  lines.r_max_mm = lines.samples * cell / 2;
  for (const double x : {10.5, 11.0}) lines.lines.push_back({glm::dvec3(x, 0.25, 20.5) * cell, {0, 1, 0}});
  const auto scan = traverse_reference(
      [](const glm::dvec3&) {
        return Medium{60, 0};
      },
      plain_table(), lines, settings, along_the_lattice(cell));
  const double amplitude = 1 - std::pow(10, kSilent_db / 10);
  double worst = 0;
  for (int k = 0; k < lines.samples; ++k) {
    const auto column = [&](int x) {
      const std::complex<double> below = point(x, k / 2, 20), above = point(x, k / 2 + 1, 20);
      return k % 2 ? (below + above) / std::sqrt(2.0) : below;
    };
    const std::complex<double> expected[] = {column(10), (column(10) + column(11)) / std::sqrt(2.0)};
    for (int line = 0; line < 2; ++line)
      worst = std::max(worst, std::abs(std::complex(scan.echo_re.at(line, k), scan.echo_im.at(line, k)) -
                                       amplitude * expected[line]));
  }
  CHECK(worst < 1e-9);
}
