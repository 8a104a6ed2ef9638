#include "app/session/guide.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "devices/mouse/mouse_tracker.h"
#include "scenarios/guidance.h"
#include "tests/scenarios/tiny_case.h"
#include "tests/scenarios/tiny_exam.h"

using namespace insonate;

namespace {

std::shared_ptr<const LoadedCase> tiny_loaded_case() {
  auto loaded_case = std::make_shared<LoadedCase>();
  loaded_case->subject = tiny_case();
  std::swap(loaded_case->subject.views[0], loaded_case->subject.views[1]);  // the exam's view is not the case's first
  loaded_case->tissues = tiny_tissues();
  std::string two_views = kTinyScenario;
  const std::string view = "view = \"ball\"";
  two_views.replace(two_views.rfind(view), view.size(), "view = \"bare\"");
  loaded_case->scenario = parse_scenario(two_views, "exam.toml");
  loaded_case->surroundings.start.translation = {0, 0, -40};
  return loaded_case;
}

Session by_hand(const std::shared_ptr<const LoadedCase>& loaded_case) {
  return Session(loaded_case,
                 [loaded_case] { return std::make_unique<MouseTracker>(loaded_case->surroundings.start); });
}

/// Returns the tiny exam with another tolerance of its first step in place of the plane's distance.
std::shared_ptr<const LoadedCase> with_tolerance(const std::string& tolerance) {
  const std::string usual = "plane_distance_mm = 8";
  std::string scenario = kTinyScenario;
  scenario.replace(scenario.find(usual), usual.size(), tolerance);
  auto loaded_case = std::make_shared<LoadedCase>(*tiny_loaded_case());
  loaded_case->scenario = parse_scenario(scenario, "exam.toml");
  return loaded_case;
}

}  // namespace

TEST_CASE("in practice the guide leads to one view after the other, those of the exam first") {
  const auto loaded_case = tiny_loaded_case();
  Session session = by_hand(loaded_case);
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

TEST_CASE("the guide names the keys of its advice, and they lead nearer, however the probe is held") {
  // What each key does, as F1 says. Slides are towards the patient's left and head, turns are tilt, rotation and rock.
  struct Key {
    const char* name;
    glm::dvec2 slide;
    glm::dvec3 turn;
  };
  const Key kKeys[] = {{"\u2191", {0, 1}, {}}, {"\u2193", {0, -1}, {}}, {"\u2190", {-1, 0}, {}}, {"\u2192", {1, 0}, {}},
                       {"D", {}, {1, 0, 0}},   {"A", {}, {-1, 0, 0}},   {"E", {}, {0, 1, 0}},    {"Q", {}, {0, -1, 0}},
                       {"W", {}, {0, 0, 1}},   {"S", {}, {0, 0, -1}}};
  const auto loaded_case = tiny_loaded_case();
  Session session = by_hand(loaded_case);
  session.practise();
  Guide guide;
  guide.next(session);
  const Pose view = loaded_case->subject.find_view("ball")->patient_from_probe;
  double now_s = 0;
  std::set<std::string> named;
  for (const Pose& off : {turned(20, {1, 0, 0}, {0, 0, -40}), turned(-20, {1, 0, 0}, {0, 0, 40}),
                          turned(20, {0, 1, 0}, {30, 0, 0}), turned(-20, {0, 1, 0}, {-30, 0, 0}),
                          turned(20, {0, 0, 1}, {30, 0, -25}), turned(-20, {0, 0, 1}, {-25, 0, -30})}) {
    const Pose pose = view * off;
    session.move_probe([&](const ProbeHand&, const Pose&) { return pose; });
    for (int i = 0; i < 3; ++i) session.advance(now_s += 0.1);
    const std::optional<Guiding> guiding = guide.now(session);
    REQUIRE(guiding);
    REQUIRE(guiding->keys.size() == guiding->advice.size());
    REQUIRE(glm::distance(session.newest_pose()->translation, pose.translation) < 1e-6);
    for (std::size_t i = 0; i < guiding->keys.size(); ++i) {
      CAPTURE(guiding->advice[i], guiding->keys[i]);
      // The words name as many ways as there are keys, and the same ones.
      const auto says = [&](const char* words) { return guiding->advice[i].find(words) != std::string::npos; };
      const auto has = [&](const char* key) { return guiding->keys[i].find(key) != std::string::npos; };
      if (says("Slide")) {
        CHECK(says("the head") == has("\u2191"));
        CHECK(says("the feet") == has("\u2193"));
        CHECK((says("the patient's") || says("the back") || says("the front")) == (has("\u2190") || has("\u2192")));
        CHECK(says(" and ") == has(" "));
      }
      const GuidingMove before = move_to(pose, view);
      for (const Key& key : kKeys) {
        if (guiding->keys[i].find(key.name) == std::string::npos) continue;
        named.insert(key.name);
        const Pose turned = ProbeHand::turn(pose, key.turn.x, key.turn.y, key.turn.z);
        const glm::dvec2 mm = ProbeHand::slide_in_patient(turned, key.slide);
        const GuidingMove after = move_to({turned.rotation, turned.point({mm.x, 0, mm.y})}, view);
        if (key.slide != glm::dvec2(0)) {
          CHECK(glm::length(after.slide_mm) < glm::length(before.slide_mm));
        } else {
          const auto left = [](const GuidingMove& move) {
            return std::abs(move.tilt_deg) + std::abs(move.rotation_deg) + std::abs(move.rock_deg);
          };
          CHECK(left(after) < left(before));
        }
      }
    }
  }
  CHECK(named.size() == std::size(kKeys));
}

TEST_CASE("who does what the guide lists, one after the other over the skin, arrives") {
  auto on_body = std::make_shared<LoadedCase>(*tiny_loaded_case());
  on_body->scenario.reset();
  Volume<std::int16_t>& ct = on_body->subject.ct;
  ct.grid.origin = {-80, -80, -80};
  ct.grid.size = {81, 81, 81};
  ct.voxels.assign(ct.grid.count(), -1000);
  constexpr double kRadius_mm = 60;  // a cylinder of tissue from feet to head
  for (int k = 0; k < ct.grid.size.z; ++k)
    for (int j = 0; j < ct.grid.size.y; ++j)
      for (int i = 0; i < ct.grid.size.x; ++i) {
        const glm::dvec3 p = ct.grid.patient_from_index({i, j, k});
        const double inside = std::clamp((kRadius_mm - std::hypot(p.x, p.y)) / 4 + 0.5, 0.0, 1.0);
        ct.at({i, j, k}) = std::int16_t(std::lround(-1000 + 1000 * inside));
      }
  const Pose front{glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)), {0, -kRadius_mm, 0}};
  const ProbeHand hand(ct);
  const auto away = [&](double around_mm, double up_mm, double tilt, double rotation, double rock) {
    const Pose there = hand.slide(front, ProbeHand::slide_in_patient(front, {around_mm, up_mm})).value();
    return ProbeHand::turn(ProbeHand::turn(ProbeHand::turn(there, 0, rotation, 0), tilt, 0, 0), 0, 0, rock);
  };
  for (const Pose& goal : {away(30, 20, 35, 0, 0), away(-25, -25, 30, 60, -15), away(10, 30, -25, -80, 20)}) {
    for (ReferenceView& view : on_body->subject.views) view.patient_from_probe = goal;
    Session session = by_hand(on_body);
    session.practise();
    Guide guide;
    guide.next(session);
    double now_s = 0;
    const auto put = [&](const Pose& pose) {
      session.move_probe([&](const ProbeHand&, const Pose&) { return pose; });
      for (int i = 0; i < 3; ++i) session.advance(now_s += 0.1);
      return guide.now(session).value();
    };
    Pose probe = ProbeHand::turn(front, -10, 40, 10);
    const std::vector<std::string> advice = put(probe).advice;
    CAPTURE(advice);
    REQUIRE(advice.size() == 4);
    const auto amount = [](const std::string& said) {
      return std::atof(said.c_str() + said.find_first_of("0123456789"));
    };
    REQUIRE(advice[0].find("Slide") == 0);
    const glm::dvec3 begun = probe.translation;
    const auto way = hand.slide_to(probe, goal).value().way_mm;
    for (int i = 0; i < 200 && glm::distance(begun, probe.translation) < amount(advice[0]) - 0.5; ++i)
      probe = hand.slide(probe, {glm::dot(way, probe.rotation[0]) / glm::length(way),
                                 glm::dot(way, probe.rotation[2]) / glm::length(way)})
                  .value();
    const Pose slid = probe;
    for (const std::string& said : advice) {
      const auto says = [&](const char* part) { return said.find(part) != std::string::npos; };
      if (says("Rotate")) probe = ProbeHand::turn(probe, 0, says("counter") ? -amount(said) : amount(said), 0);
      if (says("Rock")) probe = ProbeHand::turn(probe, 0, 0, says("away") ? amount(said) : -amount(said));
      if (says("Tilt"))
        probe = ProbeHand::turn(probe, move_to(slid, goal).tilt_deg > 0 ? amount(said) : -amount(said), 0, 0);
    }
    const Guiding arrived = put(probe);
    CAPTURE(arrived.advice);
    CHECK(glm::distance(probe.translation, goal.translation) < GuidingLimits().slide_mm);
    CHECK(arrived.plane_angle_deg < 2 * GuidingLimits().turn_deg);
  }
}

TEST_CASE("while a scenario is practised the guide leads to the view of the step under way") {
  const auto loaded_case = tiny_loaded_case();
  Session session = by_hand(loaded_case);
  session.advance(0);
  session.advance(0.1);
  Guide guide;
  CHECK_FALSE(guide.now(session));
  guide.next(session);
  REQUIRE(guide.now(session));
  CHECK(guide.now(session)->view->name == "ball");
  guide.next(session);
  CHECK_FALSE(guide.now(session));
  guide.next(session);

  INFO("the next step's view is another");
  session.act({ActionKind::go_on});
  session.advance(0.2);
  REQUIRE(session.runner()->live().step == 1);
  REQUIRE(guide.now(session));
  CHECK(guide.now(session)->view->name == "bare");

  INFO("what is chosen without a scenario is another thing");
  session.practise();
  session.advance(0.3);
  CHECK_FALSE(guide.now(session));
}

TEST_CASE("in a step that asks for no view the guide cannot lead, and stays off for the next") {
  auto loaded_case = std::make_shared<LoadedCase>(*tiny_loaded_case());
  loaded_case->scenario = exam_of(
      step("free_scan", "") +
      step("find_view", "view = \"ball\"\n" + std::string("hold_s = 1\n[step.tolerance]\nplane_distance_mm = 8")) +
      "[[criterion]]\nmetric = \"time_s\"\nfull = 10\nzero = 100\n");
  Session session = by_hand(loaded_case);
  session.advance(0);
  session.advance(0.1);
  Guide guide;
  CHECK_FALSE(guide.can_lead(session));
  guide.next(session);
  session.act({ActionKind::go_on});
  session.advance(0.2);
  REQUIRE(session.runner()->live().step == 1);
  CHECK(guide.can_lead(session));
  CHECK_FALSE(guide.now(session));
}

TEST_CASE("the result of an attempt holds how long the guide was shown, also if it was on from the start") {
  const auto loaded_case = tiny_loaded_case();
  Session session = by_hand(loaded_case);
  Guide guide;
  double now_s = 0;
  const auto scan = [&](double seconds) {
    for (const double end_s = now_s + seconds; now_s < end_s; now_s += 0.1) {
      guide.report_use(session);
      session.advance(now_s);
    }
  };
  scan(1);
  guide.next(session);
  scan(2);
  guide.next(session);
  scan(1);
  guide.next(session);
  scan(0.5);
  session.hand_in();
  REQUIRE(session.result());
  CHECK(session.result()->steps[0].guide_times == 2);
  CHECK(session.result()->steps[0].guide_s == Approx(2.5).margin(0.21));  // each end lies within a step of 0.1 s

  session.start_over();
  scan(1.5);
  session.hand_in();
  REQUIRE(session.result());
  CHECK(session.result()->steps[0].guide_times == 1);
  CHECK(session.result()->steps[0].guide_s == Approx(1.5).margin(0.11));
}

TEST_CASE("in a step the guide leads on until the step's own tolerances are met") {
  Session session = by_hand(with_tolerance("plane_distance_mm = 2"));
  Guide guide;
  guide.turn(true);
  double now_s = 0;
  const auto at = [&](double off_mm) {
    session.move_probe([&](const ProbeHand&, const Pose&) { return at_z(off_mm); });
    for (int i = 0; i < 3; ++i) session.advance(now_s += 0.1);
    return guide.now(session).value();
  };
  const Guiding near = at(-3);
  CHECK_FALSE(near.there);
  CHECK(near.advice == std::vector<std::string>{"Slide 3 mm towards the head."});
  CHECK(near.keys.size() == 1);
  CHECK(at(-1.5).there);

  CHECK(at(0).there);
}

TEST_CASE("where the probe is in place and the step asks for more, the guide does not say to hold still") {
  Session session = by_hand(with_tolerance("plane_distance_mm = 8\ndepth_use_percent = 90"));
  Guide guide;
  guide.turn(true);
  session.move_probe([&](const ProbeHand&, const Pose&) { return at_z(0); });
  for (int i = 1; i < 4; ++i) session.advance(0.1 * i);
  REQUIRE(guide.now(session));
  CHECK_FALSE(guide.now(session)->there);
  CHECK(guide.now(session)->advice ==
        std::vector<std::string>{"The probe is in place. Share of the picture's depth that the target takes: 26 %, "
                                 "asked for: 90 % or more."});
}

TEST_CASE("under strict rules there is no guide, not even after the exam") {
  const auto loaded_case = tiny_loaded_case();
  Session session(
      loaded_case, [loaded_case] { return std::make_unique<MouseTracker>(loaded_case->surroundings.start); }, 0,
      ExamRules::strict);
  session.advance(0);
  session.advance(0.1);
  REQUIRE(session.newest_pose());
  CHECK_FALSE(session.can_stand_still());
  Guide guide;
  guide.next(session);
  CHECK_FALSE(guide.now(session));

  INFO("whatever was asked for elsewhere");
  Session practised = by_hand(loaded_case);
  practised.advance(0);
  practised.advance(0.1);
  guide.next(practised);
  REQUIRE(guide.now(practised));
  CHECK_FALSE(guide.now(session));
  session.hand_in();
  CHECK_FALSE(guide.now(session));
}
