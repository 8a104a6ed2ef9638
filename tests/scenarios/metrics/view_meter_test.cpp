#include "scenarios/metrics/view_meter.h"

#include <catch2/catch.hpp>

#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

struct Bench {
  Case subject = tiny_case();
  ViewMeter meter{subject, *subject.find_view("ball"), tiny_tissues()};
};

}  // namespace

TEST_CASE("the reference pose itself is right in every respect") {
  const Bench bench;
  const ViewValues values = bench.meter.measure(Pose{});
  CHECK(values.plane_distance_mm == 0);
  CHECK(values.in_plane_offset_mm == 0);
  CHECK(values.plane_angle_deg == 0);
  CHECK(values.tilt_deg == 0);
  CHECK(values.rock_deg == 0);
  CHECK(values.rotation_deg == 0);
  CHECK(values.target_in_view_percent == 100);
  CHECK(values.target_insonated_percent == 100);
  CHECK(values.landmarks_in_view_percent == 100);
  CHECK(values.off_centre_percent < 1);  // the ball's voxels are symmetric, the scan lines fall between them
}

TEST_CASE("a shift out of the plane cuts a smaller disc of the ball") {
  const Bench bench;
  for (const double shift : {-12.0, -7.0, 4.0, 10.0}) {
    const ViewValues values = bench.meter.measure({glm::dmat3(1.0), {0, 0, shift}});
    INFO(shift);
    CHECK(values.plane_distance_mm == Approx(-shift));
    CHECK(values.in_plane_offset_mm == Approx(0).margin(1e-12));
    CHECK(values.plane_angle_deg == 0);
    // A ball's disc at distance d has the area (1 - d^2/r^2) of its largest one. Voxels of 2 mm hide up to 1 mm of the
    // distance, and round the disc's edge to about one in twenty of its area.
    const double exact = 100 * (1 - shift * shift / (kBallRadius_mm * kBallRadius_mm));
    CHECK(values.target_in_view_percent == Approx(exact).margin(8));
    CHECK(values.landmarks_in_view_percent == (std::abs(shift) <= 5 ? 100 : 0));
  }
}

TEST_CASE("a shift in the plane moves the target across the picture") {
  const Bench bench;
  const ViewValues values = bench.meter.measure({glm::dmat3(1.0), {15, 0, 0}});
  CHECK(values.plane_distance_mm == Approx(0).margin(1e-12));
  CHECK(values.in_plane_offset_mm == Approx(15));
  // 15 mm aside at 60 mm depth, seen from the apex 60 mm behind the face: atan(15/120) of the half angle of 30 degrees.
  CHECK(values.off_centre_percent == Approx(100 * glm::degrees(std::atan(15.0 / 120)) / 30).margin(1.5));
  CHECK(values.target_in_view_percent == Approx(100).margin(2));

  // Away from the ball there is nothing left of it.
  const ViewValues away = bench.meter.measure({glm::dmat3(1.0), {0, 0, 60}});
  CHECK(away.target_in_view_percent == 0);
  CHECK(away.off_centre_percent == 100);
  CHECK(away.landmarks_in_view_percent == 0);
}

TEST_CASE("a turn is taken apart into tilt, rock and rotation") {
  const Bench bench;
  for (const double tilt : {-70.0, -20.0, 0.0, 35.0})
    for (const double rock : {-40.0, 0.0, 25.0, 80.0})
      for (const double rotation : {-170.0, -45.0, 0.0, 60.0, 120.0}) {
        const glm::dmat3 turn =
            turned(tilt, {1, 0, 0}).rotation * turned(rock, {0, 0, 1}).rotation * turned(rotation, {0, 1, 0}).rotation;
        const ViewValues values = bench.meter.measure({turn, {0, 0, 0}});
        INFO(tilt << " " << rock << " " << rotation);
        CHECK(values.tilt_deg == Approx(tilt).margin(1e-9));
        CHECK(values.rock_deg == Approx(rock).margin(1e-9));
        CHECK(values.rotation_deg == Approx(rotation).margin(1e-9));
      }
}

TEST_CASE("the plane's angle sees tilt and rotation, and a mirrored picture, but no rock") {
  const Bench bench;
  CHECK(bench.meter.measure(turned(30, {1, 0, 0})).plane_angle_deg == Approx(30));
  CHECK(bench.meter.measure(turned(-30, {0, 1, 0})).plane_angle_deg == Approx(30));
  CHECK(bench.meter.measure(turned(30, {0, 0, 1})).plane_angle_deg == Approx(0).margin(1e-9));
  CHECK(bench.meter.measure(turned(180, {0, 1, 0})).plane_angle_deg == Approx(180));
}

TEST_CASE("a target behind a rib, or before which the probe hangs in the air, is not reached by the sound") {
  const Bench bench;
  // From z = 45 mm, tilted to the ball: the way crosses the rib.
  const double tilt = glm::degrees(std::atan2(-45.0, 60.0));
  const ViewValues behind_rib = bench.meter.measure(turned(tilt, {1, 0, 0}, {0, 0, 45}));
  // The plane runs through the ball's centre, and 7.5 mm above it is the target point: 7.5 mm sin(36.9 degrees).
  CHECK(std::abs(behind_rib.plane_distance_mm) == Approx(4.5));
  CHECK(behind_rib.target_in_view_percent > 90);
  CHECK(behind_rib.target_insonated_percent < 5);

  // From the other side, the same way round: nothing is in between.
  const ViewValues clear = bench.meter.measure(turned(-tilt, {1, 0, 0}, {0, 0, -45}));
  CHECK(clear.target_in_view_percent > 90);
  CHECK(clear.target_insonated_percent > 90);

  // Gel fills a gap of 3 mm, not one of 15 mm.
  CHECK(bench.meter.measure({glm::dmat3(1.0), {0, -3, 0}}).target_insonated_percent > 95);
  const ViewValues in_air = bench.meter.measure({glm::dmat3(1.0), {0, -15, 0}});
  CHECK(in_air.target_in_view_percent > 95);
  CHECK(in_air.target_insonated_percent == 0);
}

TEST_CASE("few lines find nearly the same shares as many") {
  const Bench bench;
  const ViewMeter fine(bench.subject, *bench.subject.find_view("ball"), tiny_tissues(), 16 * ViewMeter::kLines);
  // Across the ball, half out of the fan, and past the rib so that it shadows a part of the ball.
  double least = 1e9, most = -1e9;
  for (const double tilt : {0.0, -10.0, -20.0, -25.0, -30.0, -35.0})
    for (const double lateral : {0.0, 13.0, 41.0}) {
      const double z = 60 * std::tan(glm::radians(-tilt));
      const Pose pose = turned(tilt, glm::normalize(glm::dvec3(1, 0, 0.3)), {lateral, 0, z});
      const ViewValues few = bench.meter.measure(pose), many = fine.measure(pose);
      CAPTURE(tilt, lateral);
      CHECK(few.target_in_view_percent == Approx(many.target_in_view_percent).margin(ViewMeter::kLineError_percent));
      CHECK(few.target_insonated_percent ==
            Approx(many.target_insonated_percent).margin(ViewMeter::kLineError_percent));
      least = std::min(least, many.target_insonated_percent);
      most = std::max(most, many.target_insonated_percent);
    }
  CHECK(least < 10);
  CHECK(most > 90);
}

TEST_CASE("depth is used by as much of it as the target takes") {
  const Bench bench;
  // The ball reaches from 40 to 80 mm, in voxels of 2 mm; those at its poles lie between two lines.
  const double mm = 4;
  CHECK(bench.meter.measure(Pose{}).depth_use_percent == Approx(100 * 40.0 / 140).margin(100 * mm / 140));
  CHECK(bench.meter.measure(Pose{}, 80).depth_use_percent == Approx(100 * 40.0 / 80).margin(100 * mm / 80));
  CHECK(bench.meter.measure(Pose{}, 60).depth_use_percent == Approx(100 * 20.0 / 60).margin(100 * mm / 60));
  CHECK(bench.meter.measure(Pose{}, 30).depth_use_percent == 0);
  CHECK(bench.meter.measure({glm::dmat3(1.0), {0, 0, 60}}).depth_use_percent == 0);
}

TEST_CASE("moving patient and probe together changes nothing") {
  const Bench bench;
  const Pose moved = turned(73, {1, -2, 0.5}, {412, -95, 1300});
  const Case elsewhere = moved_case(bench.subject, moved);
  const ViewMeter meter(elsewhere, *elsewhere.find_view("ball"), tiny_tissues());

  for (const Pose& pose : {turned(12, {1, 0, 0}, {3, 1, 4}), turned(-30, {1, 1, 1}, {-5, 0, 7})}) {
    const ViewValues here = bench.meter.measure(pose);
    const ViewValues there = meter.measure(moved * pose);
    for (const MetricInfo& metric : metrics()) {
      if (metric.scope != MetricScope::picture) continue;
      INFO(metric.name);
      // Rounding alone; areas may besides gain or lose a sample that lies on a voxel's border, of some thousands, and
      // an extent one of two hundred.
      const double sample = metric.metric == Metric::depth_use_percent ? 0.6 : 0.2;
      CHECK(here.of(metric.metric) == Approx(there.of(metric.metric)).margin(metric.needs_targets ? sample : 1e-9));
    }
  }
}

TEST_CASE("the target point stands in where a view names no landmarks") {
  Case subject = tiny_case();
  CHECK(glm::distance(ViewMeter(subject, subject.views[0], tiny_tissues()).target_point(),
                      kBall - glm::dvec3(0, 7.5, 0)) < 1e-9);
  subject.views[0].landmarks.clear();
  // The disc's centroid, found from voxels of 2 mm.
  CHECK(glm::distance(ViewMeter(subject, subject.views[0], tiny_tissues()).target_point(), kBall) < 1);
  CHECK(glm::distance(ViewMeter(subject, subject.views[1], tiny_tissues()).target_point(), glm::dvec3(0, 70, 0)) <
        1e-9);
}

TEST_CASE("a view that does not fit its case is refused") {
  Case subject = tiny_case();
  const auto refused = [&](auto&& spoil, const char* words) {
    ReferenceView view = subject.views[0];
    spoil(view);
    CHECK_THROWS_WITH(ViewMeter(subject, view, tiny_tissues()), Catch::Contains(words));
  };
  refused([](ReferenceView& v) { v.probe = "curvilinaer"; }, "did you mean 'curvilinear'?");
  refused([](ReferenceView& v) { v.targets = {"cube"}; }, "'cube' is not a label");
  refused([](ReferenceView& v) { v.landmarks = {"bottom"}; }, "'bottom' is not in the case");
  refused([](ReferenceView& v) { v.patient_from_probe.translation.z = 70; }, "do not appear");
}
