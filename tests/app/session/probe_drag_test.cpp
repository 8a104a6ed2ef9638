#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/session/session.h"
#include "devices/mouse/mouse_tracker.h"
#include "sim/tissue/skin_contact.h"
#include "sim/view/body/line_of_sight.h"
#include "tests/phantom/abdomen.h"

// The probe dragged over the built-in patient in the 3D view, near both ends of the CT.

using namespace insonate;

namespace {

constexpr int kWidth = 440, kHeight = 400;  // the 3D view's pixels in a window of 1280 x 800

std::shared_ptr<const LoadedCase> loaded_case() {
  static const std::shared_ptr<const LoadedCase> once = [] {
    auto made = std::make_shared<LoadedCase>();
    made->subject = abdomen();
    return made;
  }();
  return once;
}

const Volume<std::int16_t>& patient() {
  return loaded_case()->subject.ct;
}

/// The z of the middles of the first and last slice, mm.
struct Ends {
  double feet, head;
};
Ends ends() {
  const Grid& grid = patient().grid;
  return {grid.patient_from_index(glm::dvec3(0)).z, grid.patient_from_index(glm::dvec3(grid.size) - 1.0).z};
}

/// Returns the skin in a direction round the body's axis, 0 in front and 90 degrees on the patient's left.
glm::dvec3 skin_at(double angle_deg, double z) {
  constexpr double kOutside_mm = 300;
  const double angle = glm::radians(angle_deg);
  const glm::dvec3 out(std::sin(angle), -std::cos(angle), 0), from = glm::dvec3(0, 0, z) + kOutside_mm * out;
  return from - distance_to_skin(patient(), from, -out, kOutside_mm).value() * out;
}

/// Returns the angle between the beam and the normal of the body's outline at the face, degrees. The outline is that of
/// the slice at the face: along its axis this body hardly changes.
double off_normal_deg(const Pose& pose) {
  const glm::dvec3& face = pose.translation;
  const double z = std::clamp(face.z, ends().feet + 3, ends().head - 3);
  const double angle_deg = glm::degrees(std::atan2(face.x, -face.y));
  const double aside_deg = glm::degrees(20 / std::hypot(face.x, face.y));
  const glm::dvec3 along = skin_at(angle_deg + aside_deg, z) - skin_at(angle_deg - aside_deg, z);
  const glm::dvec3 inward = glm::normalize(glm::dvec3(-along.y, along.x, 0));
  return glm::degrees(std::acos(std::clamp(glm::dot(inward, pose.rotation[1]), -1.0, 1.0)));
}

/// Returns how far the face is off the body's outline, mm.
double off_skin_mm(const Pose& pose) {
  const glm::dvec3& face = pose.translation;
  const double angle_deg = glm::degrees(std::atan2(face.x, -face.y));
  return glm::distance(face, skin_at(angle_deg, std::clamp(face.z, ends().feet + 3, ends().head - 3)));
}

/// A learner's hand at a pose, in a window that draws 10 times a second: 6 samples of the mouse per frame.
class Hand {
public:
  explicit Hand(const Pose& start) : session_(loaded_case(), [&] { return std::make_unique<MouseTracker>(start); }) {
    session_.advance(now_s_);
  }

  const Pose& pose() const { return session_.newest_pose().value(); }

  /// Moves the pointer in steps, and the probe at each step as the 3D view does. Returns the steps at which it stayed.
  int drag(const view::OrbitCamera& camera, const glm::dvec2& from, const glm::dvec2& to) {
    constexpr int kSteps = 8;
    int stayed = 0;
    for (int step = 1; step <= kSteps; ++step) {
      const glm::dvec2 pointer = from + (to - from) * (double(step) / kSteps);
      const view::LineOfSight line = view::line_of_sight(camera, pointer, kWidth, kHeight);
      session_.move_probe(
          [&](const ProbeHand& hand, const Pose& pose) { return hand.put(pose, line.eye, line.direction); });
      stayed += session_.stop() == Session::Stop::at_edge;
      session_.advance(now_s_ += 0.1);
    }
    return stayed;
  }

private:
  Session session_;
  double now_s_ = 0;
};

/// The cameras of a person who wants to see an end of the CT: beside it, above it and below it.
std::vector<view::OrbitCamera> cameras() {
  std::vector<view::OrbitCamera> all;
  for (const double yaw_deg : {0.0, 20.0, 90.0, -60.0, 180.0})
    for (const double pitch_deg : {-60.0, -12.0, 35.0, 60.0}) {
      view::OrbitCamera camera = view::OrbitCamera::framing(patient().grid);
      camera.yaw_deg = yaw_deg;
      camera.pitch_deg = pitch_deg;
      all.push_back(camera);
    }
  return all;
}

/// A probe that stands straight on the belly, tilted by an angle.
Pose on_belly(const ProbeHand& hand, double tilt_deg) {
  const Pose nowhere{glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)), {0, 900, 0}};
  return ProbeHand::turn(hand.put(nowhere, {0, -500, 40}, {0, 1, 0}).value(), tilt_deg, 0, 0);
}

}  // namespace

TEST_CASE("a probe that is dragged to skin near the ends of the CT keeps its angle to it, and can be dragged back") {
  const ProbeHand hand(patient());
  const double tilt_deg = GENERATE(0.0, 25.0);
  for (const view::OrbitCamera& camera : cameras())
    for (const double end_mm : {8.0, 25.0, 60.0})
      for (const double angle_deg : {0.0, 40.0, 90.0, 130.0, 180.0, -75.0, -25.0})
        for (const bool head : {false, true}) {
          CAPTURE(camera.yaw_deg, camera.pitch_deg, end_mm, angle_deg, head);
          const Pose start = on_belly(hand, tilt_deg);
          Hand learner(start);
          const double z = head ? ends().head - end_mm : ends().feet + end_mm;
          const glm::dvec2 from = camera.project(start.translation, kWidth, kHeight),
                           to = camera.project(skin_at(angle_deg, z), kWidth, kHeight);
          learner.drag(camera, from, to);
          // The skin's slope is measured over 36 mm, which is up to 8 degrees off on the flanks.
          CHECK(off_normal_deg(learner.pose()) < tilt_deg + 10);
          // A tilted face is lifted at its middle, and 4 mm voxels make a staircase.
          CHECK(off_skin_mm(learner.pose()) < 4);
          learner.drag(camera, to, from);
          CHECK(off_normal_deg(learner.pose()) < tilt_deg + 10);
          // Where the pointer was on the skin at the start, the probe is there again.
          const view::LineOfSight line = view::line_of_sight(camera, from, kWidth, kHeight);
          if (!hand.put(start, line.eye, line.direction)) continue;
          CHECK(glm::distance(camera.project(learner.pose().translation, kWidth, kHeight), from) < 3);
        }
}

TEST_CASE("a probe stops where the CT ends, also where it cuts through the lungs") {
  const ProbeHand hand(patient());
  view::OrbitCamera camera = view::OrbitCamera::framing(patient().grid);
  camera.pitch_deg = 60;
  int through_lungs = 0;
  for (double x = -100; x <= 100; x += 10)
    for (double y = -60; y <= 60; y += 10) {
      CAPTURE(x, y);
      const glm::dvec3 cut(x, y, ends().head);
      through_lungs += !distance_to_skin(patient(), cut, {0, 1, 0}, 0).has_value();
      Hand learner(on_belly(hand, 0));
      const Pose before = learner.pose();
      const glm::dvec2 pointer = camera.project(cut, kWidth, kHeight);
      CHECK(learner.drag(camera, pointer, pointer) == 8);
      CHECK(learner.pose() == before);
    }
  CHECK(through_lungs > 50);
}

TEST_CASE("each of the patient's views can be reached by turns that the handle leaves room for") {
  const ProbeHand hand(patient());
  REQUIRE(loaded_case()->subject.views.size() > 10);
  for (const ReferenceView& view : loaded_case()->subject.views) {
    CAPTURE(view.name);
    // A hand that is half a degree beside it gets there, whole.
    const Pose& pose = view.patient_from_probe;
    const Pose beside = ProbeHand::turn(pose, 0.5, 0, 0);
    const auto back = hand.turn_on_skin(beside, -0.5, 0, 0);
    REQUIRE(back);
    CHECK(glm::dot(back->rotation[1], pose.rotation[1]) > std::cos(glm::radians(0.01)));
    CHECK(off_normal_deg(pose) < ProbeHand::kMostTilted_deg);
  }
}
