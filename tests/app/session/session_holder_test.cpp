// Who holds the probe: the tracker or the learner.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "app/session/session.h"
#include "scenarios/result_json.h"
#include "sim/core/input_error.h"
#include "tests/app/session/tiny_session.h"

using namespace insonate;

TEST_CASE("who takes the probe out of an exam practises, and giving it back starts exam and log over") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  double now_s = run_until(session, 0, 2);
  const Pose before = *session.shown_pose();
  REQUIRE(session.runner());

  session.take_probe();
  CHECK(session.holder() == Holder::learner);
  CHECK(session.runner() == nullptr);
  now_s = run_until(session, now_s, now_s + 12);
  INFO("the probe stays where it was taken, and the log's end brings no score");
  CHECK(glm::distance(session.shown_pose()->translation, before.translation) < 1e-9);
  const Pose resting = *session.shown_pose();
  now_s = run_until(session, now_s, now_s + 3);
  CHECK(*session.shown_pose() == resting);  // to the bit: a probe at rest is not drawn anew
  CHECK_FALSE(session.result());

  session.give_back_probe();
  CHECK(session.holder() == Holder::tracker);
  run_until(session, now_s, now_s + 10);
  Runner runner(*session.loaded_case().scenario, session.loaded_case().subject, session.loaded_case().tissues);
  runner.feed(searching_scan());
  runner.end();
  REQUIRE(session.result());
  CHECK(to_json(*session.result()) == score_of(runner));
}

TEST_CASE("who takes the probe out of practice and gives it back goes on practising") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  session.practise();
  session.take_probe();
  session.give_back_probe();
  CHECK(session.holder() == Holder::tracker);
  CHECK(session.activity() == Activity::practice);
  CHECK(session.runner() == nullptr);
}

TEST_CASE("who takes the probe out of an exam, and then practises, goes on practising with the tracker") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  session.take_probe();
  session.start_over();
  session.practise();
  session.give_back_probe();
  CHECK(session.activity() == Activity::practice);
}

TEST_CASE("who gives the probe back during steps of the learner's own begins the tracker's steps") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  session.practise();
  session.take_probe();
  session.start_over();
  REQUIRE(session.runner());
  session.give_back_probe();
  CHECK(session.activity() == Activity::exam);
  CHECK(session.runner());
}

TEST_CASE("an exam of the learner's own starts on the belly and scores the learner's samples alone") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  double now_s = run_until(session, 0, 4);
  session.take_probe();
  session.start_over();
  CHECK(session.holder() == Holder::learner);
  now_s = run_until(session, now_s, now_s + 3);
  REQUIRE(session.runner());
  CHECK(session.runner()->live().elapsed_s == Approx(3).margin(0.02));
  const glm::dvec3 start = session.loaded_case().surroundings.start.translation;
  REQUIRE_FALSE(session.runner()->trace().empty());
  for (const TracePoint& point : session.runner()->trace()) CHECK(glm::distance(point.face, start) < 1e-9);
}

TEST_CASE("moving the probe takes it, and moves it as far as was asked") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  double now_s = run_until(session, 0, 0.5);
  const Pose before = *session.shown_pose();
  session.move_probe([](const ProbeHand&, const Pose& from) { return Pose{from.rotation, from.point({7, 0, 0})}; });
  CHECK(session.holder() == Holder::learner);
  run_until(session, now_s, now_s + 0.2);
  CHECK(glm::distance(session.shown_pose()->translation, before.point({7, 0, 0})) < 1e-9);
}

TEST_CASE("a log that is gone leaves the probe with the learner") {
  bool gone = false;
  Session session(tiny_loaded_case(), [&]() -> std::unique_ptr<Tracker> {
    if (gone) throw InputError("scan.igs.mha", "", "it is gone", "bring it back");
    return replay_of(searching_scan())();
  });
  session.advance(0);
  session.take_probe();
  gone = true;
  CHECK_THROWS_AS(session.give_back_probe(), InputError);
  CHECK(session.holder() == Holder::learner);
  run_until(session, 0, 0.5);
  CHECK(session.tracker_state().delivered > 20);
}

TEST_CASE("a motion that finds no skin leaves the probe where it is, and is reported for a moment") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  session.take_probe();
  session.advance(0.1);
  const Pose before = *session.shown_pose();
  session.move_probe([](const ProbeHand&, const Pose&) { return std::nullopt; });
  session.advance(0.5);
  CHECK(session.stop() == Session::Stop::at_edge);
  CHECK(*session.shown_pose() == before);
  session.move_probe([](const ProbeHand&, const Pose& from) { return Pose{from.rotation, from.point({7, 0, 0})}; });
  session.advance(0.6);
  CHECK(session.stop() == Session::Stop::none);
  session.move_probe([](const ProbeHand&, const Pose&) { return std::nullopt; });
  session.advance(5);
  CHECK(session.stop() == Session::Stop::none);

  INFO("a turn that goes on does not hide what stops a slide");
  session.move_probe([](const ProbeHand&, const Pose&) { return std::nullopt; });
  session.turn_probe(0, 10, 0);
  session.advance(5.5);
  CHECK(session.stop() == Session::Stop::at_edge);
}
