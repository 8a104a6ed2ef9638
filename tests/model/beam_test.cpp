#include "sim/model/beam.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace insonate;

TEST_CASE("the beam's windows are a box, a triangle and Hann's, and let through as much") {
  Settings settings;
  settings.beam_lines = 5;
  const auto weights = [&](BeamWindow window) {
    settings.beam_window = window;
    return beam_weights(settings);
  };
  const auto expected = [](std::vector<double> window, double sum) {
    for (double& weight : window) weight /= sum;
    return window;
  };
  const auto off_by = [](const std::vector<double>& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
  };
  CHECK(off_by(weights(BeamWindow::box), expected({1, 1, 1, 1, 1}, 5)) < 1e-15);
  CHECK(off_by(weights(BeamWindow::triangle), expected({1, 2, 3, 2, 1}, 9)) < 1e-15);
  CHECK(off_by(weights(BeamWindow::hann), expected({1, 3, 4, 3, 1}, 12)) < 1e-15);  // cosines of 60 and 120 degrees
}

TEST_CASE("with waves the planes of even and odd lines share the slice out evenly, and without they are the same") {
  Settings settings = trainer_settings(3.5, 100);
  settings.slice_planes = 3;
  std::vector<double> offsets;
  for (std::size_t line = 0; line < 2; ++line) {
    double weights = 0;
    for (const SlicePlane& plane : slice_planes(settings)) {
      offsets.push_back(plane.of_line(line).offset);
      weights += plane.of_line(line).weight;
      CHECK(plane.of_line(line + 2).offset == plane.of_line(line).offset);
    }
    CHECK(weights == Approx(1));
  }
  std::ranges::sort(offsets);
  CHECK(offsets.front() == Approx(-offsets.back()));
  const double sigma = 1 / 2.354820045;  // of the slice's full width at half maximum
  for (std::size_t i = 1; i < offsets.size(); ++i) CHECK(offsets[i] - offsets[i - 1] == Approx(4 * sigma / 6));

  settings.waves = false;
  for (const SlicePlane& plane : slice_planes(settings))
    for (std::size_t line = 0; line < 2; ++line) {
      CHECK(plane.of_line(line).offset == plane.of_line(0).offset);
      CHECK(plane.of_line(line).weight == plane.of_line(0).weight);
    }
  settings.waves = true;
  settings.slice_planes = 1;
  for (std::size_t line = 0; line < 2; ++line) CHECK(slice_planes(settings).front().of_line(line).offset == 0);
}
