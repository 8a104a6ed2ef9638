#include "sim/probe/probe.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

using namespace insonate;

namespace {

// The area of the fan, by integrating over its lines and depth: a curvilinear fan is a part of a ring; a phased line at
// the angle a, `behind / cos a` from the apex to the face, sweeps (r + behind / cos a) da at the distance r.
double fan_area_mm2(const Probe& probe, double depth_mm) {
  const double angle = glm::radians(probe.field_of_view_deg);
  switch (probe.kind) {
    case ProbeKind::linear:
      return probe.width_mm * depth_mm;
    case ProbeKind::curvilinear:
      return angle / 2 * depth_mm * (2 * probe.radius_mm + depth_mm);
    case ProbeKind::phased:
      const double behind = probe.width_mm / 2 / std::tan(angle / 2);
      return angle / 2 * depth_mm * depth_mm + 2 * behind * depth_mm * std::asinh(std::tan(angle / 2));
  }
  return 0;
}

}  // namespace

TEST_CASE("scan lines start on the face, point away from it, and run towards the marker") {
  for (const Probe& probe : probes()) {
    INFO(probe.name);
    const ScanLines set = scan_lines(probe, 100, 256);
    REQUIRE(int(set.lines.size()) == probe.lines);
    CHECK(set.dr_mm() == Approx(100.0 / 256));
    for (std::size_t i = 0; i < set.lines.size(); ++i) {
      const ScanLine& line = set.lines[i];
      CHECK(glm::length(line.direction) == Approx(1));
      CHECK(line.direction.y > 0);
      CHECK(line.start.z == 0);
      CHECK(std::abs(line.start.x) < face_edge(probe).x);
      if (i > 0) CHECK(line.start.x > set.lines[i - 1].start.x);
      if (probe.kind == ProbeKind::curvilinear)
        CHECK(glm::distance(line.start, glm::dvec3(0, -probe.radius_mm, 0)) == Approx(probe.radius_mm));
      else
        CHECK(line.start.y == 0);
    }
    CHECK(set.lines.front().start.x == Approx(-set.lines.back().start.x));
  }
}

TEST_CASE("the lines of a fan leave one point at equal angles, and their outer edges open the field of view") {
  for (const char* name : {"curvilinear", "phased"}) {
    Probe probe = *find_probe(name);
    probe.field_of_view_deg = 80;
    const ScanLines set = scan_lines(probe, 100, 16);
    const double step = glm::radians(80.0) / probe.lines;
    const auto angle = [](const ScanLine& line) { return std::atan2(line.direction.x, line.direction.y); };
    INFO(name);
    CHECK(angle(set.lines.front()) - step / 2 == Approx(glm::radians(-40.0)));
    for (std::size_t i = 1; i < set.lines.size(); ++i)
      CHECK(angle(set.lines[i]) - angle(set.lines[i - 1]) == Approx(step));

    // Each line reaches back to where the first one crosses the middle.
    const ScanLine& first = set.lines.front();
    const glm::dvec3 apex = first.start - first.direction * (first.start.x / first.direction.x);
    CHECK(apex.y < 0);
    for (const ScanLine& line : set.lines) CHECK(glm::length(glm::cross(line.start - apex, line.direction)) < 1e-9);
    // A line through the face's edge would leave the apex at half the field of view.
    const glm::dvec2 edge = face_edge(probe) - glm::dvec2(apex);
    CHECK(std::atan2(edge.x, edge.y) == Approx(glm::radians(40.0)));
  }
}

TEST_CASE("a point on a scan line is found among the lines where it lies") {
  for (const Probe& probe : probes()) {
    const ScanLines set = scan_lines(probe, 120, 64);
    for (int i = 0; i < probe.lines; ++i)
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
  const Probe& phased = *find_probe("phased");
  CHECK_FALSE(line_position(phased, 160, {0, -0.1}));
  CHECK_FALSE(line_position(phased, 160, {0, -25}));  // behind the apex
  CHECK_FALSE(line_position(phased, 160, {10.1, 0}));
  CHECK_FALSE(line_position(phased, 160, {20.1, 10}));
  CHECK(line_position(phased, 160, {19.9, 10}));
  CHECK(line_position(phased, 160, {-9.9, 0}));
  CHECK_FALSE(line_position(phased, 160, {0, 160.1}));
}

TEST_CASE("the pixels inside the fan measure its area to 1 %") {
  for (const Probe& probe : probes())
    for (double depth_mm : {30.0, 160.0}) {
      const ImageGeometry image = image_geometry(probe, depth_mm, 640, 480);
      long inside = 0;
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
          inside += line_position(probe, depth_mm, image.plane_mm(x, y)).has_value();
      INFO(probe.name << " to " << depth_mm << " mm");
      CHECK(double(inside) * image.mm_per_pixel * image.mm_per_pixel ==
            Approx(fan_area_mm2(probe, depth_mm)).epsilon(0.01));
    }
}

TEST_CASE("of two pixels that mirror each other both are inside the fan or neither, also on its edges") {
  for (const Probe& probe : probes())
    for (const double depth_mm : {probe.width_mm / 3, 60.0, 160.0})
      for (int width = 1; width < 48; ++width)
        for (int height = 1; height < 48; ++height) {
          const ImageGeometry image = image_geometry(probe, depth_mm, width, height);
          const auto is_inside = [&](int x, int y) {
            return line_position(probe, depth_mm, image.plane_mm(x, y)).has_value();
          };
          for (int y = 0; y < height; ++y)
            for (int x = 0; x < width / 2; ++x)
              if (is_inside(x, y) != is_inside(width - 1 - x, y))
                FAIL(probe.name << " to " << depth_mm << " mm, " << width << " x " << height << ", at " << x << " "
                                << y);
        }
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

TEST_CASE("a point beyond the fan has a position among lines that go on as they begin") {
  for (const Probe& probe : probes()) {
    INFO(probe.name);
    const ScanLines set = scan_lines(probe, 100, 50);
    for (std::size_t i = 0; i < set.lines.size(); i += 17)
      for (const double r : {0.5, 40.0, 99.0, 130.0}) {
        const glm::dvec3 p = set.lines[i].start + r * set.lines[i].direction;
        const LinePosition at = position_among(set.fan, {p.x, p.y});
        CHECK(at.line == Approx(double(i)).margin(1e-9));
        CHECK(at.r_mm == Approx(r));
        if (const auto inside = line_position(probe, 100, {p.x, p.y})) {
          CHECK(inside->line == Approx(at.line).margin(1e-9));
          CHECK(inside->r_mm == Approx(at.r_mm));
        }
      }
    // Ten lines' widths beyond the outer line: a wider probe's line there.
    Probe wider = probe;
    wider.lines += 20;
    const double more = double(wider.lines) / probe.lines;
    if (probe.kind == ProbeKind::linear)
      wider.width_mm *= more;
    else if (probe.kind == ProbeKind::curvilinear)
      wider.field_of_view_deg *= more;
    else
      continue;  // its apex would move
    const ScanLine outer = scan_lines(wider, 100, 50).lines.front();
    const glm::dvec3 p = outer.start + 60.0 * outer.direction;
    CHECK(position_among(set.fan, {p.x, p.y}).line == Approx(-10).margin(1e-9));
  }
}

TEST_CASE("lines that are steered start where they did, turn by the angle, and are found among themselves") {
  for (const char* name : {"linear", "curvilinear"}) {
    const Probe& probe = *find_probe(name);
    for (const double steering : {-0.3, -0.1, 0.1, 0.5}) {
      CAPTURE(name, steering);
      const ScanLines straight = scan_lines(probe, 80, 100), steered = scan_lines(probe, 80, 100, steering);
      for (std::size_t i = 0; i < steered.lines.size(); i += 19) {
        const ScanLine& line = steered.lines[i];
        CHECK(glm::distance(line.start, straight.lines[i].start) < 1e-12);
        const glm::dvec3 d = straight.lines[i].direction;
        const double towards_marker = d.y * line.direction.x - d.x * line.direction.y;
        CHECK(std::asin(towards_marker) == Approx(steering));
        for (const double r : {0.0, 3.0, 40.0, 79.9}) {
          const glm::dvec3 point = line.start + r * line.direction;
          const LinePosition at = position_among(steered.fan, {point.x, point.y});
          CHECK(at.line == Approx(double(i)).margin(1e-9));
          CHECK(at.r_mm == Approx(r).margin(1e-9));
          const auto within = position_within(steered, {point.x, point.y});
          REQUIRE(within.has_value() == (at.r_mm >= 0));  // rounding may put the start in front of the face
        }
      }
      const ScanLine& outer = steered.lines.back();
      const glm::dvec3 beside(outer.direction.y, -outer.direction.x, 0),
          too_deep = outer.start + 80.1 * outer.direction;
      const double spacing = glm::distance(outer.start, steered.lines[steered.lines.size() - 2].start);
      const glm::dvec3 in = outer.start + 0.3 * spacing * beside + 40.0 * outer.direction,
                       out = outer.start + 2.0 * spacing * beside + 40.0 * outer.direction;
      CHECK(position_within(steered, {in.x, in.y}));
      CHECK_FALSE(position_within(steered, {out.x, out.y}));
      CHECK_FALSE(position_within(steered, {too_deep.x, too_deep.y}));
    }
  }
}
