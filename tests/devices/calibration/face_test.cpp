#include "devices/calibration/face.h"

#include <catch2/catch.hpp>

#include "devices/calibration/still_point.h"
#include "tests/devices/calibration/synthetic.h"

using namespace insonate;

namespace {

/// A convex probe: the face 60 mm wide, its middle 12 mm ahead of its ends, the handle 150 mm long.
const FacePoints kDrawn{{0, 0, 0}, {30, -12, 0}, {-30, -12, 0}, {0, -150, 0}};

FacePoints moved(const Pose& to_from, const FacePoints& points) {
  return {to_from.point(points.middle), to_from.point(points.marker_end), to_from.point(points.other_end),
          to_from.point(points.tail)};
}

}  // namespace

TEST_CASE("four points of the probe give its face's frame, wherever the sensor sits") {
  Dice dice(1);
  for (int run = 0; run < 20; ++run) {
    const Pose sensor_from_face = dice.pose(150);
    const auto fit = fit_face(moved(sensor_from_face, kDrawn));
    REQUIRE(fit);
    CHECK(glm::distance(fit->sensor_from_face.translation, sensor_from_face.translation) < 1e-9);
    CHECK(angle_between_deg(fit->sensor_from_face, sensor_from_face) < 1e-6);
    CHECK_FALSE(why_not_rigid(fit->sensor_from_face.matrix()));
    CHECK(fit->skew_deg < 1e-6);
    CHECK(fit->off_middle_mm < 1e-9);
  }
}

TEST_CASE("points touched to a millimetre turn the face by a degree or two") {
  Dice dice(2);
  double worst = 0;
  for (int run = 0; run < 200; ++run) {
    const Pose sensor_from_face = dice.pose(150);
    FacePoints points = moved(sensor_from_face, kDrawn);
    for (glm::dvec3* point : {&points.middle, &points.marker_end, &points.other_end, &points.tail})
      *point += dice.noise(0.6);  // 1 mm RMS
    const auto fit = fit_face(points);
    REQUIRE(fit);
    worst = std::max(worst, angle_between_deg(fit->sensor_from_face, sensor_from_face));
  }
  // 0.6 sqrt(2) mm over the face's 60 mm is 0.8 degrees, over the handle's 150 mm 0.3: four times that at the worst.
  CHECK(worst < 3.5);
  CHECK(worst > 0.8);
}

TEST_CASE("points that are not a probe's are refused") {
  using Catch::Contains;
  FacePoints points = kDrawn;
  points.marker_end = points.other_end;
  CHECK_THAT(fit_face(points).refusal(), Contains("ends of the face lie in one place"));
  points = kDrawn;
  points.tail = {0, -20, 0};
  CHECK_THAT(fit_face(points).refusal(), Contains("tail lies too near"));
  points = kDrawn;
  points.tail = {40, -150, 0};
  CHECK_THAT(fit_face(points).refusal(), Contains("are 15 degrees off a right angle"));
  points = kDrawn;
  points.middle = {9, 0, 0};
  points.tail = {9, -150, 0};
  CHECK_THAT(fit_face(points).refusal(), Contains("9.0 mm away from between its ends"));
}

TEST_CASE("a point is read while it rests, and refused while it moves") {
  Dice dice(3);
  std::vector<glm::dvec3> readings;
  for (int i = 0; i < 60; ++i) readings.push_back(glm::dvec3(100, 200, -50) + dice.noise(0.3));
  const auto point = still_point(readings);
  REQUIRE(point);
  CHECK(glm::distance(point->mean_mm, glm::dvec3(100, 200, -50)) < 0.2);
  CHECK(point->wander_mm == Approx(0.52).epsilon(0.2));
  CHECK_FALSE(still_point(std::span(readings).first(9)));
  for (std::size_t i = 0; i < readings.size(); ++i) readings[i].x += 0.2 * double(i);
  CHECK_THAT(still_point(readings).refusal(), Catch::Contains("moved by 3."));
}
