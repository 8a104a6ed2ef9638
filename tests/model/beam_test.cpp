#include "sim/model/beam.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

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

TEST_CASE("half of the slice lies between the lines, and outer lines go on as within") {
  const ScanLines lines = scan_lines(*find_probe("curvilinear"), 100, 64, 0);
  Settings settings = trainer_settings(3.5, 100);
  std::vector<double> laterals;
  for (const SlicePlane& plane : slice_planes(settings)) laterals.push_back(plane.of_line(0).lateral);
  CHECK(laterals == std::vector<double>{-0.5, 0, 0.5});
  settings.waves = false;
  for (const SlicePlane& plane : slice_planes(settings)) CHECK(plane.of_line(0).lateral == 0);

  const auto close = [](const ScanLine& a, const ScanLine& b) {
    return glm::distance(a.start, b.start) < 1e-3 && glm::distance(a.direction, b.direction) < 1e-5;
  };
  const std::size_t last = lines.lines.size() - 1;
  CHECK(close(line_beside(lines, 5, 0.5), line_beside(lines, 6, -0.5)));
  CHECK_FALSE(close(line_beside(lines, 5, 0.5), lines.lines[5]));
  CHECK(line_beside(lines, 5, 0).start == lines.lines[5].start);
  CHECK(close(line_beside(lines, 5, 1), lines.lines[6]));
  // At the ends, what lies one line further is what lies one line nearer, mirrored at the outer line.
  for (const auto& [outer, share] : {std::pair(last, 1.0), std::pair(std::size_t(0), -1.0)}) {
    const ScanLine beyond = line_beside(lines, outer, share), before = line_beside(lines, outer, -share);
    CHECK(glm::distance((beyond.start + before.start) / 2.0, lines.lines[outer].start) < 1e-3);
    CHECK(glm::length(beyond.direction) == Approx(1));
  }
  ScanLines single = lines;
  single.lines.resize(1);
  CHECK(line_beside(single, 0, 0.5).start == single.lines[0].start);
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
