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
