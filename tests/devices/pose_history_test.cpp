#include "devices/pose_history.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace insonate;

namespace {

/// A probe that moves at 100 mm/s along x and turns at 90 deg/s about z.
Pose moving(double time_s) {
  return {glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(90 * time_s), glm::dvec3(0, 0, 1))),
          {100 * time_s, 0, 0}};
}

ProbeSample usable(double time_s) {
  return {time_s, PoseStatus::ok, moving(time_s), 0};
}

/// What a tracker that has lost its sensor may send: a status, and a pose from nowhere.
ProbeSample unusable(double time_s, PoseStatus status = PoseStatus::missing) {
  return {time_s, status, Pose{glm::dmat3(1.0), {1e4, 1e4, 1e4}}, 0};
}

/// Samples at 60 Hz up to and with `last`/60 s.
PoseHistory history(int last) {
  PoseHistory made;
  for (int i = 0; i <= last; ++i) made.add(usable(i / 60.0));
  return made;
}

double distance_mm(const PoseEstimate& a, const Pose& b) {
  return glm::distance(a.patient_from_probe.translation, b.translation);
}

}  // namespace

TEST_CASE("a history without usable samples has no answer") {
  PoseHistory history;
  CHECK(history.at(0).how == PoseAnswer::none);
  history.add(unusable(0));
  CHECK(history.at(0).how == PoseAnswer::none);
  history.add(usable(1));
  CHECK(history.at(0.5).how == PoseAnswer::none);
  CHECK(history.at(1).how == PoseAnswer::exact);
  CHECK(history.at(std::nan("")).how == PoseAnswer::none);
}

TEST_CASE("a pose is exact at a sample and interpolated between two") {
  const PoseHistory poses = history(30);
  const PoseEstimate exact = poses.at(10 / 60.0);
  CHECK(exact.how == PoseAnswer::exact);
  CHECK(distance_mm(exact, moving(10 / 60.0)) == 0);
  const PoseEstimate between = poses.at(10.3 / 60.0);
  CHECK(between.how == PoseAnswer::interpolated);
  CHECK(distance_mm(between, moving(10.3 / 60.0)) < 1e-9);
  CHECK(angle_between_deg(between.patient_from_probe, moving(10.3 / 60.0)) < 1e-9);
  CHECK(between.age_s == Approx(0.3 / 60));
}

TEST_CASE("after the last sample a steady motion is predicted for 30 ms, then held, then stale") {
  const PoseHistory poses = history(60);
  for (const double ahead_s : {0.001, 0.01, 0.0299}) {
    const PoseEstimate ahead = poses.at(1 + ahead_s);
    CHECK(ahead.how == PoseAnswer::predicted);
    CHECK(distance_mm(ahead, moving(1 + ahead_s)) < 1e-9);
    CHECK(angle_between_deg(ahead.patient_from_probe, moving(1 + ahead_s)) < 1e-9);
    CHECK(ahead.age_s == Approx(ahead_s));
  }
  for (const double ahead_s : {0.031, 0.1, 0.249}) {
    const PoseEstimate held = poses.at(1 + ahead_s);
    CHECK(held.how == PoseAnswer::held);
    CHECK(distance_mm(held, moving(1 + PoseHistory::kPredict_s)) < 1e-9);
  }
  for (const double ahead_s : {0.251, 1.0, 3600.0}) {
    const PoseEstimate stale = poses.at(1 + ahead_s);
    CHECK(stale.how == PoseAnswer::stale);
    CHECK(distance_mm(stale, moving(1 + PoseHistory::kPredict_s)) < 1e-9);
  }
}

TEST_CASE("the prediction sets out from the last sample, however noisy the ones before were") {
  PoseHistory poses;
  for (int i = 0; i <= 20; ++i) {
    ProbeSample sample = usable(i / 60.0);
    sample.patient_from_probe.translation.y = i % 2;
    poses.add(sample);
  }
  const double last_s = 20 / 60.0;
  CHECK(distance_mm(poses.at(last_s + 1e-9), poses.at(last_s).patient_from_probe) < 1e-6);
  // The fit over many samples sees the motion along x and next to none of the zigzag of 60 mm/s across.
  const glm::dvec3 step =
      poses.at(last_s + 0.02).patient_from_probe.translation - poses.at(last_s).patient_from_probe.translation;
  CHECK(step.x == Approx(2));
  CHECK(std::abs(step.y) < 0.2);
}

TEST_CASE("samples that are not ok never move the probe") {
  const PoseStatus statuses[] = {PoseStatus::missing,  PoseStatus::out_of_view, PoseStatus::out_of_volume,
                                 PoseStatus::switched, PoseStatus::invalid,     PoseStatus::unknown};
  for (const PoseStatus status : statuses) {
    PoseHistory poses = history(60);
    poses.add(unusable(61 / 60.0, status));
    poses.add(unusable(62 / 60.0, status));
    // The prediction ends where the first of them says that nothing is known.
    CHECK(distance_mm(poses.at(61 / 60.0), moving(61 / 60.0)) < 1e-9);
    CHECK(poses.at(61 / 60.0).how == PoseAnswer::predicted);
    for (const double time_s : {61.1 / 60, 62 / 60.0, 1.2, 2.0}) {
      CHECK(poses.at(time_s).how != PoseAnswer::predicted);
      CHECK(distance_mm(poses.at(time_s), moving(61 / 60.0)) < 1e-9);
    }
    // A short dropout is bridged once the probe is back, without the poses in it.
    poses.add(usable(63 / 60.0));
    CHECK(poses.at(62 / 60.0).how == PoseAnswer::interpolated);
    CHECK(distance_mm(poses.at(62 / 60.0), moving(62 / 60.0)) < 1e-9);
  }
}

TEST_CASE("the pose stands still for as long as a tracker says that it has nothing") {
  PoseHistory poses = history(30);
  const Pose held = poses.at(1.0).patient_from_probe;
  CHECK(distance_mm(poses.at(1.0), moving(0.5)) > 1);  // it had been on its way
  for (double time_s = 1; time_s < 10; time_s += 0.1) {
    poses.add(unusable(time_s));
    CHECK(distance_mm(poses.at(time_s), held) == 0);
  }
}

TEST_CASE("a long gap is not bridged by a straight line") {
  PoseHistory poses = history(60);
  poses.add(usable(1.5));
  CHECK(poses.at(1.09).how == PoseAnswer::held);
  CHECK(poses.at(1.4).how == PoseAnswer::stale);
  CHECK(distance_mm(poses.at(1.4), moving(1 + PoseHistory::kPredict_s)) < 1e-9);
  // A single sample after the gap has no velocity to predict with.
  CHECK(distance_mm(poses.at(1.52), moving(1.5)) < 1e-9);
}

TEST_CASE("a history forgets what is older than it keeps, but never the last pose") {
  PoseHistory poses = history(600);
  CHECK(poses.at(1).how == PoseAnswer::none);
  CHECK(poses.at(8.5).how != PoseAnswer::none);
  for (int i = 601; i < 1200; ++i) poses.add(unusable(i / 60.0));
  CHECK(poses.at(20).how == PoseAnswer::stale);
  CHECK(distance_mm(poses.at(20), moving(10)) < 5);
}

TEST_CASE("a time that does not rise begins a new history") {
  PoseHistory poses = history(60);
  poses.add(usable(0.25));
  CHECK(poses.at(1).how == PoseAnswer::stale);
  CHECK(distance_mm(poses.at(1), moving(0.25)) < 1e-9);
  CHECK(poses.at(0.2).how == PoseAnswer::none);
}
