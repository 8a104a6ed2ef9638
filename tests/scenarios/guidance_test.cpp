#include "scenarios/guidance.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

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

TEST_CASE("the movements of the advice, one after the other about the probe's own axes, lead to the reference") {
  int of_three_turns = 0;
  for (int i = 0; i < 400; ++i) {
    const Pose from = turned(1.7 * i, {1, 0.3 * (i % 7) - 1, 0.2}, {3, 4, 5});
    const Pose to = turned(0.9 * i - 90, {0.1 * (i % 5), 1, 0.4 - 0.1 * (i % 11)}, {i - 50.0, 2, 1});
    Pose probe = from;
    const auto left_deg = [&] {
      const glm::dmat3 left = glm::transpose(probe.rotation) * to.rotation;
      return glm::degrees(std::acos(std::clamp((left[0].x + left[1].y + left[2].z - 1) / 2, -1.0, 1.0)));
    };
    const std::vector<std::string> sentences = advice(from, to);
    CAPTURE(i, sentences);
    for (const std::string& sentence : sentences) {
      const auto says = [&](const std::string& part) { return sentence.find(part) != std::string::npos; };
      const double amount = std::atof(sentence.c_str() + sentence.find_first_of("0123456789"));
      if (says("Slide")) {
        const glm::dvec3 slide = move_to(from, to).slide_mm;
        CHECK(glm::length(slide) == Approx(amount).margin(0.51));
        probe.translation += slide;
      } else if (says("Rotate")) {
        probe = probe * turned(says("counter") ? -amount : amount, {0, 1, 0});
      } else if (says("Rock")) {
        probe = probe * turned(says("away") ? amount : -amount, {0, 0, 1});
      } else {
        // The tilt that takes the beam to the named side of the patient.
        const double towards_z = move_to(from, to).tilt_deg > 0 ? 1 : -1;
        const Pose whole = Pose{probe.rotation, {}} * turned(towards_z * 90, {1, 0, 0});
        const auto component = [&](const char* to_positive, const char* to_negative, double value) {
          if (says(to_positive)) CHECK(value > 0);
          if (says(to_negative)) CHECK(value < 0);
        };
        component("patient's left", "patient's right", whole.rotation[1].x);
        component("back", "front", whole.rotation[1].y);
        component("head", "feet", whole.rotation[1].z);
        probe = probe * turned(towards_z * amount, {1, 0, 0});
      }
    }
    const bool slid = !sentences.empty() && sentences.front().find("Slide") == 0;
    of_three_turns += sentences.size() - std::size_t(slid) == 3;
    // Each turn that is not mentioned is at most 5 degrees, and each of the others is rounded to a degree.
    CHECK(left_deg() <= 3 * GuidingLimits().turn_deg);
    if (sentences.size() - std::size_t(slid) == 3) CHECK(left_deg() < 1.51);
    const glm::dvec3 off = to.translation - probe.translation, beam = to.rotation[1];
    CHECK(glm::length(off - glm::dot(off, beam) * beam) <= GuidingLimits().slide_mm);
  }
  CHECK(of_three_turns > 200);
}

TEST_CASE("a movement that is done leaves the amounts of the movements after it as they were") {
  const Pose to = turned(40, {1, 0.4, -0.6}, {30, -10, 25});
  const GuidingMove whole = move_to(Pose{}, to);
  REQUIRE(std::min({std::abs(whole.rotation_deg), std::abs(whole.tilt_deg), std::abs(whole.rock_deg)}) > 5);
  const Pose half = turned(whole.rotation_deg / 2, {0, 1, 0});
  const GuidingMove left = move_to(half, to);
  CHECK(left.rotation_deg == Approx(whole.rotation_deg / 2));
  CHECK(left.tilt_deg == Approx(whole.tilt_deg));
  CHECK(left.rock_deg == Approx(whole.rock_deg));
  CHECK(glm::distance(left.slide_mm, whole.slide_mm) < 1e-9);
  const GuidingMove tilted = move_to(turned(whole.rotation_deg, {0, 1, 0}) * turned(whole.tilt_deg, {1, 0, 0}), to);
  CHECK(tilted.rotation_deg == Approx(0).margin(1e-9));
  CHECK(tilted.tilt_deg == Approx(0).margin(1e-9));
  CHECK(tilted.rock_deg == Approx(whole.rock_deg));

  INFO("a probe that tilts by 90 degrees, or past it");
  CHECK(move_to(Pose{}, turned(90, {1, 0, 0}) * turned(20, {0, 0, 1})).rock_deg == Approx(20));
  CHECK(move_to(Pose{}, turned(120, {1, 0, 0})).tilt_deg == Approx(120));
  CHECK(move_to(Pose{}, turned(120, {1, 0, 0})).rock_deg == Approx(0).margin(1e-9));
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
