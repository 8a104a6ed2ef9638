#include "scenarios/guidance.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

// A probe on the belly: the beam goes to the back (+y of LPS), the marker to the patient's right, so that z = x cross y
// goes to the feet.
const Pose kOnBelly{glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)), {10, -100, 50}};

std::vector<std::string> advice(const Pose& from, const Pose& to) {
  return in_words(move_to(from, to), from);
}

}  // namespace

TEST_CASE("tilt, rock and rotation, one after the other, lead to the reference whatever the way") {
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    const Pose from = turned(1.7 * i, {1, 0.3 * (i % 7) - 1, 0.2}, {3, 4, 5});
    const Pose to = turned(0.9 * i - 90, {0.1 * (i % 5), 1, 0.4 - 0.1 * (i % 11)}, {i - 50.0, 2, 1});
    const GuidingMove move = move_to(from, to);
    const glm::dmat3 turn = turned(move.tilt_deg, {1, 0, 0}).rotation * turned(move.rock_deg, {0, 0, 1}).rotation *
                            turned(move.rotation_deg, {0, 1, 0}).rotation;
    const glm::dmat3 reached = from.rotation * turn;
    for (int c = 0; c < 3; ++c) CHECK(glm::distance(reached[c], to.rotation[c]) < 1e-9);
    CHECK(std::abs(glm::dot(move.slide_mm, from.rotation[1])) < 1e-9);
    CHECK(move.rock_deg <= 90);
  }
}

TEST_CASE("advice names the patient's sides, the marker, and the sense of rotation as seen from the handle") {
  const auto from = [](const Pose& turn) { return kOnBelly * turn; };
  CHECK(advice(kOnBelly, kOnBelly).empty());
  CHECK(advice(kOnBelly, from(Pose{glm::dmat3(1.0), {0, 0, -32}})) ==
        std::vector<std::string>{"Slide 32 mm towards the head."});
  CHECK(advice(kOnBelly, from(Pose{glm::dmat3(1.0), {-30, 0, 20}})) ==
        std::vector<std::string>{"Slide 36 mm towards the patient's left and the feet."});
  INFO("pressing is not sliding");
  CHECK(advice(kOnBelly, from(Pose{glm::dmat3(1.0), {0, 30, 0}})).empty());
  // Seen from the handle, which is along the beam: the patient's right is on the left hand side when their head is up.
  // Clockwise takes a marker on the left up, towards the head.
  const Pose clockwise = from(turned(90, {0, 1, 0}));
  CHECK(glm::distance(clockwise.rotation[0], glm::dvec3(0, 0, 1)) < 1e-9);
  CHECK(advice(kOnBelly, clockwise) == std::vector<std::string>{"Rotate 90\u00b0 clockwise."});
  CHECK(advice(clockwise, kOnBelly) == std::vector<std::string>{"Rotate 90\u00b0 counter-clockwise."});
  const Pose to_feet = from(turned(20, {1, 0, 0}));
  CHECK(to_feet.rotation[1].z < -0.3);  // the beam goes to the feet
  CHECK(advice(kOnBelly, to_feet) == std::vector<std::string>{"Tilt 20\u00b0, the beam towards the feet."});
  const Pose from_marker = from(turned(12, {0, 0, 1}));
  CHECK(from_marker.rotation[1].x > 0.2);  // to the patient's left, the marker being on their right
  CHECK(advice(kOnBelly, from_marker) == std::vector<std::string>{"Rock 12\u00b0, the beam away from the marker."});
  CHECK(advice(from_marker, kOnBelly) == std::vector<std::string>{"Rock 12\u00b0, the beam towards the marker."});
  CHECK(advice(kOnBelly, from(turned(4, {1, 1, 1}, {2, 0, 2}))).empty());
}
