#include "tools/register/swept_planes.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

#include "sim/registration/find_fan.h"

using namespace insonate;

namespace {

constexpr double kVoxel_mm = 1, kRadius_mm = 60, kDepth_mm = 100, kHalfView = glm::radians(30.0);
const glm::dvec3 kApex(10, -90, 5);  // of the fans, in the frame of the box's axes

/// A volume of some 200 mm along each axis of the box.
struct Volume200 {
  Grid grid{glm::ivec3(200), glm::dvec3(kVoxel_mm), glm::dvec3(-100), glm::dmat3(1)};
  PlaneBox box{glm::dmat3(1), glm::dvec3(-100), glm::dvec3(99)};

  glm::dvec3 in_box(const glm::ivec3& index) const {
    return glm::transpose(box.axes) * grid.patient_from_index(glm::dvec3(index));
  }
};

/// The same, turned, with the planes' rows along the volume's third axis, and finer along that.
Volume200 turned_volume() {
  Volume200 v;
  v.box.axes = glm::dmat3(glm::rotate(glm::dmat4(1), 0.7, glm::normalize(glm::dvec3(1, 2, -1))));
  v.grid.direction = glm::dmat3(v.box.axes[1], v.box.axes[2], v.box.axes[0]);
  v.grid.spacing = {1, 1, 0.5};
  v.grid.size = {200, 200, 400};
  v.grid.origin = v.box.axes * glm::dvec3(-100);
  return v;
}

/// Returns whether a point lies in a fan whose lines meet at `apex`, seen along z.
bool in_fan(const glm::dvec2& from_apex) {
  const double r = glm::length(from_apex);
  return r >= kRadius_mm && r <= kRadius_mm + kDepth_mm && std::abs(std::atan2(from_apex.x, from_apex.y)) <= kHalfView;
}

}  // namespace

TEST_CASE("planes that were tilted about a line are found from the wedge that they fill") {
  const bool turned = GENERATE(false, true);
  const Volume200 v = turned ? turned_volume() : Volume200();
  // The line lies 30 mm behind the middle of the face. The planes are tilted from -12 to 25 degrees.
  const double from = glm::radians(-12.0), to = glm::radians(25.0), behind = 30;
  const double line_y = kApex.y + kRadius_mm - behind;
  const auto known = [&](const glm::ivec3& index) {
    if (index.x == 1 && index.z == 1 && index.y % 10 == 0) return true;  // specks beside the wedge
    const glm::dvec3 at = v.in_box(index);
    const double y = at.y - line_y, z = at.z - kApex.z, angle = std::atan2(z, y);
    return angle >= from && angle <= to && in_fan({at.x - kApex.x, std::hypot(y, z) + kRadius_mm - behind});
  };
  const SweptPlanes planes = find_swept_planes(v.grid, v.box, known);
  REQUIRE(planes.tilted);
  // The sides are steps of whole voxels.
  CHECK(glm::degrees(planes.first) == Approx(-12).margin(1));
  CHECK(glm::degrees(planes.last) == Approx(25).margin(1));
  CHECK(planes.axis_y == Approx(line_y).margin(3));
  CHECK(planes.axis_z == Approx(kApex.z).margin(1));

  const FanSearch search = find_fan(known_in_planes(v.grid, v.box, planes, kVoxel_mm, known), glm::dvec2(kVoxel_mm));
  REQUIRE(search.fan);
  CHECK(search.fan->probe.kind == ProbeKind::curvilinear);
  CHECK(search.fan->probe.radius_mm == Approx(kRadius_mm).margin(2));
  CHECK(search.fan->probe.field_of_view_deg == Approx(60).margin(1));
  CHECK(search.fan->depth_mm == Approx(kDepth_mm).margin(2));
  // The middle plane at the face's middle.
  const glm::dvec2 face = glm::dvec2(v.box.low.x, planes.depths(v.box).x) + search.fan->face_pixel * kVoxel_mm;
  const glm::dvec3 at = planes.plane(v.box, 0.5).point(glm::dvec3(face, 0));
  const double middle = (from + to) / 2;
  const glm::dvec3 expected(kApex.x, line_y + behind * std::cos(middle), kApex.z + behind * std::sin(middle));
  CHECK(glm::length(glm::transpose(v.box.axes) * at - expected) < 2);
}

TEST_CASE("planes that slid beside each other or cross are parallel, and so are those without straight sides") {
  const Volume200 v;
  const auto slid = [&](const glm::ivec3& index) {
    const glm::dvec3 at = v.grid.patient_from_index(glm::dvec3(index));
    return std::abs(at.z) < 20 && in_fan({at.x - kApex.x, at.y - kApex.y});
  };
  const SweptPlanes parallel = find_swept_planes(v.grid, v.box, slid);
  CHECK_FALSE(parallel.tilted);
  CHECK(parallel.plane(v.box, 0).translation == glm::dvec3(0, 0, v.box.low.z));
  CHECK(parallel.plane(v.box, 1).translation == glm::dvec3(0, 0, v.box.high.z));
  CHECK(parallel.plane(v.box, 0.3).rotation == v.box.axes);

  // From -8 to 8 mm, tilted against it from 11 to -11 degrees: the planes cross 41 mm below the face.
  const auto crossing = [&](const glm::ivec3& index) {
    const glm::dvec3 at = v.grid.patient_from_index(glm::dvec3(index));
    const double depth = at.y - kApex.y - kRadius_mm;
    return std::abs(at.z) < std::abs(8 - std::tan(glm::radians(11.0)) * depth) + 1 &&
           in_fan({at.x - kApex.x, at.y - kApex.y});
  };
  CHECK_FALSE(find_swept_planes(v.grid, v.box, crossing).tilted);

  const auto ball = [&](const glm::ivec3& index) {
    return glm::length(v.grid.patient_from_index(glm::dvec3(index))) < 80;
  };
  CHECK_FALSE(find_swept_planes(v.grid, v.box, ball).tilted);
  CHECK_FALSE(find_swept_planes(v.grid, v.box, [](const glm::ivec3&) { return true; }).tilted);
  CHECK_FALSE(find_swept_planes(v.grid, v.box, [](const glm::ivec3&) { return false; }).tilted);
}
