#include "sim/probe/sweep.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace insonate;

namespace {

Pose somewhere() {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, -2, 0.5)));
  return pose_from_matrix(glm::translate(glm::dmat4(1.0), glm::dvec3(30, -50, 120)) * turn);
}

Sweep swept(const char* probe_name, int planes, double pivot_mm) {
  Sweep sweep{*find_probe(probe_name), 100, swept_planes(somewhere(), planes, 50, pivot_mm)};
  sweep.probe.lines = 24;
  return sweep;
}

// A hand that slides, tilts and turns a little from plane to plane.
Sweep by_hand(const char* probe_name) {
  Sweep sweep{*find_probe(probe_name), 60, {}};
  sweep.probe.lines = 16;
  Pose patient_from_plane = somewhere();
  for (int k = 0; k < 9; ++k) {
    sweep.patient_from_plane.push_back(patient_from_plane);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.01, glm::normalize(glm::dvec3(1, 0.5 * std::sin(k), 0.2)));
    patient_from_plane = patient_from_plane * Pose{glm::dmat3(turn), {0.3 * std::cos(k), 0.1, 2.0}};
  }
  return sweep;
}

}  // namespace

TEST_CASE("a 3D probe's planes share an axis behind the face and tilt by equal angles") {
  const Pose pose = somewhere();
  const std::vector<Pose> planes = swept_planes(pose, 21, 50, 40);
  REQUIRE(planes.size() == 21);
  const glm::dvec3 pivot = pose.point({0, -40, 0});
  for (std::size_t k = 0; k < planes.size(); ++k) {
    CHECK_FALSE(why_not_rigid(planes[k].matrix()));
    CHECK(glm::distance(planes[k].point({0, -40, 0}), pivot) < 1e-9);
    CHECK(glm::distance(planes[k].direction({1, 0, 0}), pose.direction({1, 0, 0})) < 1e-12);
    if (k > 0) CHECK(angle_between_deg(planes[k - 1], planes[k]) == Approx(2.5));
  }
  CHECK(angle_between_deg(planes.front(), pose) == Approx(25));
  CHECK(glm::distance(planes[10].translation, pose.translation) < 1e-9);
  CHECK(glm::dot(planes.back().translation - planes.front().translation, pose.direction({0, 0, 1})) ==
        Approx(2 * 40 * std::sin(glm::radians(25.0))));
}

TEST_CASE("a sweep's lines come plane by plane") {
  const Sweep sweep = swept("phased", 5, 10);
  const ScanLines plane = scan_lines(sweep.probe, 100, 64), all = scan_lines(sweep, 64);
  REQUIRE(all.lines.size() == 5 * plane.lines.size());
  CHECK(all.samples == 64);
  CHECK(all.dr_mm() == plane.dr_mm());
  for (std::size_t p = 0; p < 5; ++p)
    for (std::size_t i = 0; i < plane.lines.size(); ++i) {
      const ScanLine& line = all.lines[p * plane.lines.size() + i];
      const Pose& pose = sweep.patient_from_plane[p];
      CHECK(glm::distance(line.start, pose.point(plane.lines[i].start)) < 1e-9);
      CHECK(glm::distance(line.direction, pose.direction(plane.lines[i].direction)) < 1e-12);
    }
}

TEST_CASE("a point on a sweep's line is found in its plane, on that line, at that depth") {
  for (const Sweep& sweep : {swept("curvilinear", 11, 45), swept("phased", 11, 10), swept("linear", 6, 20),
                             by_hand("curvilinear"), by_hand("linear")}) {
    INFO(sweep.probe.name);
    const ScanLines all = scan_lines(sweep, 8);
    const int lines = sweep.probe.lines, planes = int(sweep.patient_from_plane.size());
    for (int p = 1; p + 1 < planes; ++p)  // the first and last are at the edge, where rounding decides
      for (int i = 1; i + 1 < lines; ++i)
        for (double r : {4.0, 31.0, sweep.depth_mm - 3}) {
          const ScanLine& line = all.lines[std::size_t(p * lines + i)];
          const auto found = sweep_position(sweep, line.start + r * line.direction);
          REQUIRE(found);
          CHECK(found->plane + found->share == Approx(p).margin(1e-9));
          const LinePosition& at = found->share < 0.5 ? found->in_this : found->in_next;
          CHECK(at.line == Approx(i).margin(1e-6));
          CHECK(at.r_mm == Approx(r).margin(1e-6));
        }
  }
}

TEST_CASE("a point between a 3D probe's planes is found by its angle") {
  const Sweep sweep = swept("curvilinear", 26, 45);  // 2 degrees apart
  const Pose pose = somewhere();
  for (double tilt_deg : {-24.5, -7.1, 0.0, 0.4, 13.0}) {
    const double tilt = glm::radians(tilt_deg), r = 70;
    const glm::dvec3 p = pose.point({0, (45 + r) * std::cos(tilt) - 45, (45 + r) * std::sin(tilt)});
    const auto found = sweep_position(sweep, p);
    REQUIRE(found);
    // The ratio of two sines is that of their angles but for a tenth of the third power of 2 degrees.
    CHECK(found->plane + found->share == Approx((tilt_deg + 25) / 2).margin(1e-4));
    // Planes are where the point is nearest to them: at a distance of 115 mm, up to 115 (1 - cos 2 degrees) = 0.07 mm
    // closer to the face.
    CHECK(std::abs(found->in_this.r_mm - r) < 0.08);
    CHECK(std::abs(found->in_next.r_mm - r) < 0.08);
  }
  CHECK_FALSE(sweep_position(sweep, pose.point({0, 115 * std::cos(0.45) - 45, 115 * std::sin(0.45)})));
  CHECK_FALSE(sweep_position(sweep, pose.point({0, -1, 0})));
  CHECK_FALSE(sweep_position(sweep, pose.point({0, 101, 0})));
}

TEST_CASE("a sweep that goes back is distinguished from one that goes one way or rests") {
  const auto at = [](const std::vector<double>& elevations_mm) {
    Sweep sweep{*find_probe("linear"), 60, {}};
    for (const double z : elevations_mm) sweep.patient_from_plane.push_back({glm::dmat3(1.0), {0, 0, z}});
    return reversal_index(sweep);
  };
  CHECK(!at({0, 5, 10, 15}));
  CHECK(!at({15, 10, 5, 0}));
  CHECK(!at({0, 5, 5, 4.98, 5, 10}));
  CHECK(at({0, 5, 10, 5, 0}) == 3u);
  CHECK(at({0, 0, -5, -4}) == 3u);
  const Sweep swept{*find_probe("curvilinear"), 160, swept_planes({}, 33, 120, 60)};
  CHECK(!reversal_index(swept));
}

TEST_CASE("the grid of a sweep holds all of it, with cubic voxels along the middle plane's axes") {
  for (const Sweep& sweep : {swept("curvilinear", 11, 45), by_hand("linear")}) {
    const Grid grid = sweep_grid(sweep, 0.8);
    CHECK(grid.spacing == glm::dvec3(0.8));
    CHECK(grid.direction == sweep.patient_from_plane[sweep.patient_from_plane.size() / 2].rotation);
    glm::dvec3 low(1e9), high(-1e9);
    for (const ScanLine& line : scan_lines(sweep, 1).lines)
      for (double r : {0.0, sweep.depth_mm}) {
        const glm::dvec3 index = grid.index_from_patient(line.start + r * line.direction);
        low = glm::min(low, index);
        high = glm::max(high, index);
      }
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(low[axis] >= 0);
      CHECK(low[axis] < 2.1);  // no more than what is to spare
      CHECK(high[axis] <= grid.size[axis] - 1);
      CHECK(high[axis] > grid.size[axis] - 3.1);
    }
  }
}
