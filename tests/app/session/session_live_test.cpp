// Sessions with a live tracker.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "app/session/session.h"
#include "scenarios/result_json.h"
#include "tests/app/session/tiny_session.h"

using namespace insonate;

TEST_CASE("a live tracker is opened once, and what it says while the learner has the probe is past") {
  std::vector<ProbeSample> coming;
  int opened = 0;
  Session session(tiny_loaded_case(), [&] {
    ++opened;
    return std::make_unique<HandFed>(coming);
  });
  const Pose first = turned(5, {1, 0, 0}, {1, 2, 3}), unseen = turned(50, {0, 1, 0}, {9, 9, 9});
  session.advance(1000);
  INFO("a session that begins while the clock runs has lost nothing yet");
  CHECK_FALSE(session.lost_for_s());
  coming = {sample_at(1000.1, first)};
  session.advance(1000.2);
  REQUIRE(session.shown_pose());
  CHECK(*session.shown_pose() == first);
  session.take_probe();
  coming = {sample_at(1000.3, unseen)};
  session.advance(1000.4);
  CHECK(coming.empty());
  CHECK_FALSE(*session.newest_pose() == unseen);
  session.give_back_probe();
  session.advance(1000.5);
  CHECK_FALSE(*session.newest_pose() == unseen);
  CHECK(session.tracker_state().delivered == 2);
  session.start_over();
  session.advance(1000.6);
  CHECK_FALSE(session.newest_pose());
  CHECK(session.activity() == Activity::exam);
  CHECK(session.tracker_state().delivered == 2);
  CHECK(opened == 1);
}

TEST_CASE("a tracker without an absolute position goes on from where the learner put it, any other from its own") {
  const Pose before = turned(0, {1, 0, 0}, {1, 2, 3}), after = turned(30, {0, 1, 0}, {1, 2, 3});
  const glm::dvec3 chosen(40, -20, 7);
  for (const bool relative : {true, false}) {
    CAPTURE(relative);
    std::vector<ProbeSample> coming;
    Session session(tiny_loaded_case(false), [&] { return std::make_unique<HandFed>(coming, relative); });
    double now_s = 100;
    const auto say = [&](const Pose& pose) {
      coming = {sample_at(now_s, pose)};
      session.advance(now_s += 0.1);
    };
    session.advance(now_s);
    say(before);
    session.move_probe([&](const ProbeHand&, const Pose& pose) { return Pose{pose.rotation, chosen}; });
    say(before);
    session.give_back_probe();
    coming = {{now_s, PoseStatus::missing, Pose{}, 0}};
    session.advance(now_s += 0.1);
    say(before);
    const Pose there = *session.newest_pose();
    say(after);
    const Pose turned_there = *session.newest_pose();
    CHECK(glm::distance(there.translation, relative ? chosen : before.translation) < 1e-9);
    CHECK(glm::distance(turned_there.translation, there.translation) < 1e-9);
    CHECK(angle_between_deg(there, turned_there) == Approx(30));
    CHECK(session.latest_samples().back().patient_from_probe == turned_there);
  }
}

TEST_CASE("of a live tracker the pose at the time of the picture is shown, and how it was found is reported") {
  // 100 mm/s along x, at 60 Hz for a second.
  std::vector<ProbeSample> steady;
  for (int i = 0; i <= 60; ++i) steady.push_back(sample_at(i / 60.0, turned(0, {1, 0, 0}, {100 * i / 60.0, 0, 30})));
  const auto after = [&](double ahead_s, double predict_s) {
    std::vector<ProbeSample> coming = steady;
    Session session(
        tiny_loaded_case(), [&] { return std::make_unique<HandFed>(coming); }, predict_s);
    session.advance(0);
    session.advance(1 + ahead_s);
    REQUIRE(session.pose_estimate());
    CHECK(session.newest_pose()->translation.x == 100);
    return std::pair{session.pose_estimate()->how, session.shown_pose()->translation.x};
  };
  CHECK(after(0, 0.03) == std::pair{PoseAnswer::exact, 100.0});
  CHECK(after(-0.5 / 60, 0.03).first == PoseAnswer::interpolated);
  CHECK(after(-0.5 / 60, 0.03).second == Approx(100 - 50 / 60.0));
  CHECK(after(0.02, 0.03).first == PoseAnswer::predicted);
  CHECK(after(0.02, 0.03).second == Approx(102));
  CHECK(after(0.02, 0) == std::pair{PoseAnswer::held, 100.0});
  CHECK(after(0.2, 0.01).second == Approx(101));
  CHECK(after(0.2, 5).first == PoseAnswer::held);  // no more than PoseHistory allows
  CHECK(after(0.2, 5).second == Approx(103));
  CHECK(after(0.3, 0.03).first == PoseAnswer::stale);

  INFO("what is replayed shows its newest sample");
  Session replayed(tiny_loaded_case(), replay_of(steady));
  replayed.advance(0);
  replayed.advance(0.51);
  CHECK_FALSE(replayed.pose_estimate());
  CHECK(replayed.shown_pose()->translation.x == steady[30].patient_from_probe.translation.x);
}

TEST_CASE("an exam of a live tracker is scored from its samples, not from the poses that are shown") {
  const auto loaded_case = tiny_loaded_case();
  std::vector<ProbeSample> log = searching_scan();
  // The device goes silent, and the exam's time runs out.
  for (double time_s = 9.1; time_s < 60; time_s += 0.1) log.push_back({time_s, PoseStatus::missing, Pose{}, 0});
  Runner runner(*loaded_case->scenario, loaded_case->subject, loaded_case->tissues);
  runner.feed(log);
  REQUIRE(runner.live().finished);
  const std::string expected = score_of(runner);
  for (const double frames_per_s : {7.0, 60.0}) {
    CAPTURE(frames_per_s);
    std::vector<ProbeSample> coming;
    Session session(loaded_case, [&] { return std::make_unique<HandFed>(coming); });
    std::size_t next = 0;
    for (double now_s = 0; next < log.size() && !session.result(); now_s += 1 / frames_per_s) {
      while (next < log.size() && log[next].time_s <= now_s) coming.push_back(log[next++]);
      session.advance(now_s + 0.004);
    }
    REQUIRE(session.result());
    CHECK(to_json(*session.result()) == expected);
  }
}
