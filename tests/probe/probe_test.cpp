#include "sim/probe/probe.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

using namespace insonate;

TEST_CASE("scan lines start on the face, point away from it, and run towards the marker") {
  for (const Probe& probe : probes()) {
    INFO(probe.name);
    const ScanLines set = scan_lines(probe, 100, 256);
    REQUIRE(int(set.lines.size()) == probe.lines);
    CHECK(set.dr_mm() == Approx(100.0 / 256));
    for (const ScanLine& line : set.lines) {
      CHECK(glm::length(line.direction) == Approx(1));
      CHECK(line.direction.y > 0);
      CHECK(line.start.z == 0);
      if (probe.kind == ProbeKind::curvilinear)
        CHECK(glm::distance(line.start, glm::dvec3(0, -probe.radius_mm, 0)) == Approx(probe.radius_mm));
      else
        CHECK(line.start.y == 0);
    }
    CHECK(set.lines.front().start.x < 0);
    CHECK(set.lines.back().start.x > 0);
    CHECK(set.lines.front().start.x == Approx(-set.lines.back().start.x));
  }
}

TEST_CASE("a point on a scan line is found among the lines where it lies") {
  for (const Probe& probe : probes()) {
    const ScanLines set = scan_lines(probe, 120, 64);
    for (int i : {0, 1, probe.lines / 2, probe.lines - 1})
      for (double r : {0.0, 0.5, 60.0, 120.0}) {
        const ScanLine& line = set.lines[std::size_t(i)];
        const glm::dvec3 p = line.start + r * line.direction;
        const auto found = line_position(probe, 120 + 1e-9, glm::dvec2(p) + glm::dvec2(0, 1e-10));
        INFO(probe.name << " line " << i << " r " << r);
        REQUIRE(found);
        CHECK(found->line == Approx(i).margin(1e-6));
        CHECK(found->r_mm == Approx(r).margin(1e-6));
      }
  }
}

TEST_CASE("outside the fan there is no line") {
  const Probe& curvilinear = *find_probe("curvilinear");
  CHECK_FALSE(line_position(curvilinear, 160, {0, -1}));
  CHECK_FALSE(line_position(curvilinear, 160, {0, 161}));
  CHECK_FALSE(line_position(curvilinear, 160, {100, 20}));
  CHECK(line_position(curvilinear, 160, {0, 80}));
  const Probe& linear = *find_probe("linear");
  CHECK_FALSE(line_position(linear, 50, {linear.width_mm / 2 + 0.1, 10}));
  CHECK(line_position(linear, 50, {linear.width_mm / 2 - 0.1, 10}));
}

TEST_CASE("the picture shows the whole fan, centred, with square pixels") {
  for (const Probe& probe : probes())
    for (auto [width, height] : {std::pair(640, 480), std::pair(300, 900)}) {
      const ImageGeometry image = image_geometry(probe, 100, width, height);
      const glm::dvec2 low = image.plane_mm(-0.5, -0.5), high = image.plane_mm(width - 0.5, height - 0.5);
      const ScanLines set = scan_lines(probe, 100, 8);
      for (const ScanLine& line : set.lines)
        for (double r : {0.0, 100.0}) {
          const glm::dvec3 p = line.start + r * line.direction;
          CHECK(p.x > low.x - 1e-9);
          CHECK(p.x < high.x + 1e-9);
          CHECK(p.y > low.y - 1e-9);
          CHECK(p.y < high.y + 1e-9);
        }
      CHECK(low.x == Approx(-high.x));
      CHECK(glm::distance(image.pixel(image.plane_mm(12.5, 7)), glm::dvec2(12.5, 7)) < 1e-9);
    }
}
