#include "sim/view/plane_trace.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace insonate;
using namespace insonate::view;

namespace {

constexpr double kDepth_mm = 100;

/// 400 by 400 pixels of half a millimetre, through the patient's origin.
AxisSlice slice_of(SliceAxis axis) {
  AxisSlice slice;
  slice.axis = axis;
  slice.mm_per_pixel = 0.5;
  slice.width = slice.height = 400;
  return slice;
}

Probe linear() {
  return *find_probe("linear");
}

/// A probe on the front at y = -50, with the beam to the back, turned about the beam.
Pose from_the_front(double turned_deg) {
  // Lateral along the patient's left and the beam to the back: the plane is axial.
  const glm::dmat3 axial(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1));
  return {glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(turned_deg), glm::dvec3(0, 1, 0))) * axial, {0, -50, 0}};
}

}  // namespace

TEST_CASE("a sagittal plane crosses an axial slice in a line from edge to edge, brighter where the beam runs") {
  const PlaneTrace trace = trace_of_plane(slice_of(SliceAxis::axial), from_the_front(90), linear(), kDepth_mm);
  REQUIRE(trace.line);
  CHECK(trace.outline.empty());
  for (const glm::dvec2& end : *trace.line) CHECK(end.x == Approx(200));
  CHECK(std::abs((*trace.line)[0].y - (*trace.line)[1].y) == Approx(400));
  // From the face, 50 mm in front of the middle, to 50 mm behind it.
  REQUIRE(trace.in_fan.size() == 1);
  CHECK(trace.in_fan[0][0].x == Approx(200));
  CHECK(std::min(trace.in_fan[0][0].y, trace.in_fan[0][1].y) == Approx(100));
  CHECK(std::max(trace.in_fan[0][0].y, trace.in_fan[0][1].y) == Approx(300));
}

TEST_CASE("an axial plane crosses a coronal slice along the face's width") {
  const PlaneTrace trace = trace_of_plane(slice_of(SliceAxis::coronal), from_the_front(0), linear(), kDepth_mm);
  REQUIRE(trace.in_fan.size() == 1);
  CHECK(trace.in_fan[0][0].y == Approx(200));
  const double width_mm = 0.5 * std::abs(trace.in_fan[0][0].x - trace.in_fan[0][1].x);
  CHECK(width_mm == Approx(linear().width_mm).epsilon(0.002));
}

TEST_CASE("a slice above a curved face crosses the fan twice, or not at all") {
  // The arc of the face bulges towards the patient: a coronal slice just behind the arc's ends passes it twice.
  const Probe curved = *find_probe("curvilinear");
  AxisSlice slice = slice_of(SliceAxis::coronal);
  const Pose pose = from_the_front(0);
  slice.middle.y = -50 - 3;
  const PlaneTrace trace = trace_of_plane(slice, pose, curved, kDepth_mm);
  REQUIRE(trace.in_fan.size() == 2);
  CHECK(trace.in_fan[0][1].x != Approx(trace.in_fan[1][0].x));
  slice.middle.y = -50 - 80;
  CHECK(trace_of_plane(slice, pose, curved, kDepth_mm).in_fan.empty());
  CHECK(trace_of_plane(slice, pose, curved, kDepth_mm).line);
}

TEST_CASE("a slice in the plane has the fan's outline in place of a line, and none apart from the plane") {
  AxisSlice slice = slice_of(SliceAxis::axial);
  const PlaneTrace within = trace_of_plane(slice, from_the_front(1), linear(), kDepth_mm);
  CHECK_FALSE(within.line);
  CHECK(within.in_fan.empty());
  REQUIRE_FALSE(within.outline.empty());
  CHECK(glm::distance(within.outline.front(), glm::dvec2(200 - linear().width_mm, 100)) < 3);
  slice.middle.z = 10;
  const PlaneTrace apart = trace_of_plane(slice, from_the_front(1), linear(), kDepth_mm);
  CHECK_FALSE(apart.line);
  CHECK(apart.outline.empty());
}

TEST_CASE("a plane that misses the picture leaves no line in it") {
  AxisSlice slice = slice_of(SliceAxis::axial);
  slice.middle.x = 500;
  CHECK_FALSE(trace_of_plane(slice, from_the_front(90), linear(), kDepth_mm).line);
}
