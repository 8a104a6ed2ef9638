#include "app/session/probe_hand.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/skin_contact.h"

using namespace insonate;

namespace {

constexpr double kRadius_mm = 100;

/// A cylinder of tissue along z.
Volume<std::int16_t> cylinder() {
  Volume<std::int16_t> ct;
  ct.grid.size = {121, 121, 61};
  ct.grid.spacing = glm::dvec3(2.0);
  ct.grid.origin = {-120, -120, -60};
  ct.voxels.resize(ct.grid.count());
  for (int k = 0; k < ct.grid.size.z; ++k)
    for (int j = 0; j < ct.grid.size.y; ++j)
      for (int i = 0; i < ct.grid.size.x; ++i) {
        const glm::dvec3 p = ct.grid.patient_from_index({i, j, k});
        // A ramp two voxels wide, as a scanner draws an edge: without it the skin is a staircase.
        const double inside = std::clamp((kRadius_mm - std::hypot(p.x, p.y)) / 4 + 0.5, 0.0, 1.0);
        ct.at({i, j, k}) = std::int16_t(std::lround(-1000 + 1000 * inside));
      }
  return ct;
}

/// In front of the cylinder, marker to the right, `pressed_mm` into the skin.
Pose in_front(double pressed_mm) {
  return {glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)),
          {0, -kRadius_mm + pressed_mm, 0}};
}

double pressed_mm(const Pose& pose) {
  return kRadius_mm - std::hypot(pose.translation.x, pose.translation.y);
}

double off_normal_deg(const Pose& pose) {
  const glm::dvec3 inward = -glm::normalize(glm::dvec3(pose.translation.x, pose.translation.y, 0));
  return glm::degrees(std::acos(std::min(1.0, glm::dot(inward, pose.rotation[1]))));
}

}  // namespace

TEST_CASE("sliding round a body keeps the face's pressure and its angle to the skin") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  Pose pose = in_front(3);
  for (int i = 0; i < 150; ++i) pose = hand.slide(pose, {1, 0}).value();
  // 150 mm along a circle of 97 mm radius, where the face's middle runs, is 89 degrees: from the front to the side.
  CHECK(glm::degrees(std::atan2(-pose.translation.x, -pose.translation.y)) == Approx(89).margin(4));
  // The staircase of 2 mm voxels, and the slope taken over 36 mm of it.
  CHECK(pressed_mm(pose) == Approx(3).margin(1.0));
  CHECK(off_normal_deg(pose) < 6);
}

TEST_CASE("a probe that was tilted stays tilted while it slides") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  Pose pose = ProbeHand::turn(in_front(0), 20, 0, 0);
  REQUIRE(off_normal_deg(pose) == Approx(20).margin(0.5));
  for (int i = 0; i < 60; ++i) pose = hand.slide(pose, {1, 0}).value();
  CHECK(off_normal_deg(pose) == Approx(20).margin(6));
}

TEST_CASE("turns are about the middle of the face and in the probe's own frame") {
  const Pose start = in_front(0);
  const Pose rotated = ProbeHand::turn(start, 0, 90, 0);
  CHECK(rotated.translation == start.translation);
  CHECK(glm::dot(rotated.rotation[1], start.rotation[1]) == Approx(1));
  CHECK(glm::dot(rotated.rotation[0], start.rotation[2]) == Approx(-1));  // right-hand rule about y: x turns to -z
  const Pose rocked = ProbeHand::turn(start, 0, 0, 30);
  CHECK(glm::dot(rocked.rotation[2], start.rotation[2]) == Approx(1));
  CHECK(ProbeHand::turn(start, 0, 0, 0) == start);
}

TEST_CASE("a probe is tilted and rocked until it would lie on the body, and back from there") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  for (const double pressed : {0.0, ProbeHand::kDeepest_mm})
    for (const glm::dvec2& way : {glm::dvec2(1, 0), glm::dvec2(-7, 0), glm::dvec2(0, 1), glm::dvec2(0, -40)}) {
      CAPTURE(pressed, way.x, way.y);
      Pose pose = in_front(pressed);
      int turns = 0;
      for (; turns < 200; ++turns) {
        const auto turned = hand.turn_on_skin(pose, way.x, 0, way.y);
        if (!turned) break;
        pose = *turned;
      }
      CHECK(turns < 200);
      // The slope of 2 mm voxels, taken over 36 mm of them.
      CHECK(off_normal_deg(pose) == Approx(ProbeHand::kMostTilted_deg).margin(5));
      const auto rotated = hand.turn_on_skin(pose, way.x, 40, way.y);
      REQUIRE(rotated);
      CHECK(glm::dot(rotated->rotation[0], pose.rotation[0]) < std::cos(glm::radians(35.0)));
      CHECK(off_normal_deg(*rotated) < off_normal_deg(pose) + 1);
      CHECK(hand.turn_on_skin(pose, -way.x, 0, -way.y) == ProbeHand::turn(pose, -way.x, 0, -way.y));
    }
}

TEST_CASE("pressing ends at what a patient bears, lifting where contact is long lost") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  Pose pose = in_front(0);
  for (int i = 0; i < 100; ++i) pose = hand.press(pose, 1);
  CHECK(pressed_mm(pose) == Approx(ProbeHand::kDeepest_mm).margin(0.5));
  for (int i = 0; i < 100; ++i) pose = hand.press(pose, -1);
  CHECK(pressed_mm(pose) == Approx(-ProbeHand::kFarthest_mm).margin(0.5));
}

TEST_CASE("a probe put by a line of sight lands on the skin there, or stays when there is none") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  const Pose from = in_front(2);
  const Pose put = hand.put(from, {-500, 0, 20}, {1, 0, 0}).value();
  CHECK(put.translation.x == Approx(-kRadius_mm + 2).margin(1.0));
  CHECK(put.translation.z == Approx(20).margin(1.0));
  CHECK(off_normal_deg(put) < 6);
  CHECK_FALSE(hand.put(from, {-500, 0, 900}, {1, 0, 0}));
}

TEST_CASE("a probe slides to where the CT's end makes pictures dark, and no farther, and comes back from there") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  Pose pose = in_front(0);
  int moved = 0;
  while (const auto next = hand.slide(pose, {0, 1})) {
    pose = *next;
    REQUIRE(++moved < 100);
  }
  CHECK(pose.translation.z == Approx(-60 + kEnd_mm).margin(1));  // it goes 1 mm at a time
  CHECK(pose.translation.z >= -60 + kEnd_mm);
  CHECK(off_normal_deg(pose) < 6);

  INFO("a tracker may have left it there");
  pose.translation.z = -57;
  CHECK_FALSE(hand.slide(pose, {0, 1}));
  CHECK(hand.slide(pose, {0, -1}).value().translation.z == Approx(-56).margin(0.2));
  CHECK_FALSE(hand.put(pose, {0, -500, -57}, {0, 1, 0}));
}

TEST_CASE("the faces at which the CT cuts the body are not skin, and a probe that faces none can be put back") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  const Pose from = in_front(2);
  CHECK_FALSE(hand.put(from, {0, 0, 500}, {0, 0, -1}));
  CHECK_FALSE(hand.put(from, {20, 30, -500}, {0, 0, 1}));
  // Behind the cut, where its beam meets the cut alone.
  const Pose lost{glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, -1, 0)), {0, 0, 70}};
  const Pose back = hand.put(lost, {0, -500, 10}, {0, 1, 0}).value();
  CHECK(pressed_mm(back) == Approx(0).margin(1.0));
  CHECK(back.translation.z == Approx(10).margin(1.0));
  CHECK(off_normal_deg(back) < 6);
  // Far round the side as the line of sight has it, and beside the cut: still onto the skin.
  const Pose side = hand.put(from, {80, -500, 50}, {0, 1, 0}).value();
  CHECK(pressed_mm(side) == Approx(2).margin(1.5));
  CHECK(off_normal_deg(side) < 15);
  CHECK(pressed_mm(hand.put(in_front(-20), {0, -500, 10}, {0, 1, 0}).value()) == Approx(0).margin(1.0));
}

TEST_CASE("a slide in the patient's directions is the same however the probe is rotated") {
  for (const double rotation_deg : {0.0, 30.0, 90.0, 200.0}) {
    CAPTURE(rotation_deg);
    const Pose pose = ProbeHand::turn(in_front(0), 0, rotation_deg, 0);
    const auto moved = [&](const glm::dvec2& mm) {
      const glm::dvec2 slide = ProbeHand::slide_in_patient(pose, mm);
      return pose.rotation * glm::dvec3(slide.x, 0, slide.y);
    };
    CHECK(glm::distance(moved({5, 0}), glm::dvec3(5, 0, 0)) < 1e-9);  // to the patient's left
    CHECK(glm::distance(moved({0, 5}), glm::dvec3(0, 0, 5)) < 1e-9);  // to the head
  }
  // A beam that runs from the feet to the head: nothing along the face leads to the head.
  const Pose up{glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0)), {0, 0, -60}};
  CHECK(ProbeHand::slide_in_patient(up, {0, 5}) == glm::dvec2(0));
  CHECK(glm::distance(ProbeHand::slide_in_patient(up, {5, 0}), glm::dvec2(-5, 0)) < 1e-9);
}

TEST_CASE("one key leads the probe all the way round the body, over both flanks and the back") {
  const Volume<std::int16_t> ct = cylinder();
  const ProbeHand hand(ct);
  Pose pose = in_front(0);
  double angle_deg = 0, reached_deg = 0;
  for (int step = 0; step < 2000 && reached_deg < 360; ++step) {
    const std::optional<Pose> next = hand.slide(pose, ProbeHand::slide_in_patient(pose, {1, 0}));
    REQUIRE(next);
    pose = *next;
    // From the front over the left flank: the face's direction from the body's axis.
    const double now_deg = glm::degrees(std::atan2(pose.translation.x, -pose.translation.y));
    reached_deg += std::remainder(now_deg - angle_deg, 360.0);
    angle_deg = now_deg;
  }
  CHECK(reached_deg >= 360);
}

TEST_CASE("a probe that is put faces the skin, also where the line of sight runs along it") {
  const auto ct = cylinder();
  const ProbeHand hand(ct);
  const double z_mm = GENERATE(10.0, 51.5);  // far from the CT's end, and as near to it as the hand goes
  for (const double to_skin_deg : {10.0, 20.0, 40.0}) {
    CAPTURE(to_skin_deg, z_mm);
    const double angle = glm::radians(to_skin_deg);
    const glm::dvec3 sight(0, std::sin(angle), std::cos(angle));  // from the feet
    const auto put = hand.put(in_front(2), glm::dvec3(0, -kRadius_mm, z_mm) - 500.0 * sight, sight);
    REQUIRE(put);
    CHECK(pressed_mm(*put) == Approx(2).margin(1.0));
    CHECK(off_normal_deg(*put) < 6);  // the staircase of 2 mm voxels, as above
  }
}
