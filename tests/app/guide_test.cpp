#include "app/guide.h"

#include <catch2/catch.hpp>

#include "devices/mouse/mouse_tracker.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

std::shared_ptr<const Study> tiny_study() {
  auto study = std::make_shared<Study>();
  study->subject = tiny_case();
  std::swap(study->subject.views[0], study->subject.views[1]);  // the exam's view is not the case's first
  study->tissues = tiny_tissues();
  study->scenario = parse_scenario(kTinyScenario, "exam.toml");
  study->surroundings.start.translation = {0, 0, -40};
  return study;
}

Session by_hand(const std::shared_ptr<const Study>& study) {
  return Session(study, [study] { return std::make_unique<MouseTracker>(study->surroundings.start); });
}

}  // namespace

TEST_CASE("in practice the guide leads to one view after the other, those of the exam first") {
  const auto study = tiny_study();
  Session session = by_hand(study);
  session.practise();
  session.advance(0);
  session.advance(0.1);
  Guide guide;
  CHECK_FALSE(guide.now(session));
  guide.next(session);
  std::optional<Guiding> guiding = guide.now(session);
  REQUIRE(guiding);
  CHECK(guiding->view->name == "ball");
  CHECK_FALSE(guiding->there);
  CHECK(guiding->plane_distance_mm == Approx(40));
  CHECK(guiding->advice == std::vector<std::string>{"Slide 40 mm towards the head."});

  session.move_probe([](const ProbeHand&, const Pose& from) { return Pose{from.rotation, {0, 0, 0}}; });
  session.advance(0.2);
  guiding = guide.now(session);
  REQUIRE(guiding);
  CHECK(guiding->there);
  CHECK(guiding->plane_distance_mm == Approx(0).margin(1e-9));

  INFO("of a tilted probe the middle of the picture is off, 70 mm below the face");
  session.move_probe([](const ProbeHand&, const Pose&) { return turned(30, {1, 0, 0}); });
  session.advance(0.3);
  guiding = guide.now(session);
  REQUIRE(guiding);
  CHECK_FALSE(guiding->there);
  CHECK(guiding->plane_distance_mm == Approx(35));
  CHECK(guiding->plane_angle_deg == Approx(30));

  guide.next(session);
  CHECK(guide.now(session)->view->name == "bare");
  guide.next(session);
  CHECK_FALSE(guide.now(session));
}

TEST_CASE("an exam has no guide, whatever was asked for before") {
  const auto study = tiny_study();
  Session session = by_hand(study);
  session.advance(0);
  session.advance(0.1);
  Guide guide;
  guide.next(session);
  CHECK_FALSE(guide.now(session));
  session.practise();
  session.advance(0.2);
  CHECK_FALSE(guide.now(session));  // what was asked for in the exam was not heard
  guide.next(session);
  CHECK(guide.now(session));
  session.start_over();
  session.advance(0.3);
  session.advance(0.4);
  REQUIRE(session.activity() == Activity::exam);
  REQUIRE(session.newest_pose());
  CHECK_FALSE(guide.now(session));
}
