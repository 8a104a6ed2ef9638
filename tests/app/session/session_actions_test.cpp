// What the learner does besides moving the probe: freezing, knobs, and acts in the order of the samples.

#include <catch2/catch.hpp>

#include <cmath>

#include "app/session/session.h"
#include "devices/mouse/mouse_tracker.h"
#include "devices/record/sequence_recorder.h"
#include "devices/registry.h"
#include "scenarios/result_json.h"
#include "tests/app/session/tiny_session.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

TEST_CASE("a frozen picture stays while the exam goes on") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  double now_s = run_until(session, 0, 1);
  const Pose frozen = *session.shown_pose();
  session.freeze(true);
  now_s = run_until(session, now_s, 2);
  CHECK(*session.shown_pose() == frozen);
  CHECK(session.runner()->live().elapsed_s == Approx(2).margin(0.02));
  session.freeze(false);
  run_until(session, now_s, 2.1);
  CHECK_FALSE(*session.shown_pose() == frozen);
}

TEST_CASE("freezing and thawing between two samples is nothing, either way round") {
  const auto loaded_case = tiny_loaded_case(false);
  std::vector<ProbeSample> coming{sample_at(0.1, Pose{})};
  Session session(loaded_case, [&] { return std::make_unique<HandFed>(coming); });
  session.advance(0.1);
  session.freeze(true);
  session.freeze(false);
  coming = {sample_at(0.2, Pose{})};
  session.advance(0.2);
  CHECK(session.latest_actions().empty());
  session.freeze(true);
  coming = {sample_at(0.3, Pose{glm::dmat3(1.0), {1, 0, 0}})};
  session.advance(0.3);
  const std::optional<Pose> frozen_at = session.machine().frozen_at;
  REQUIRE(frozen_at);
  session.freeze(false);
  session.freeze(true);
  coming = {sample_at(0.4, Pose{glm::dmat3(1.0), {2, 0, 0}})};
  session.advance(0.4);
  CHECK(session.latest_actions().empty());
  CHECK(session.machine().frozen);
  CHECK(session.machine().frozen_at == frozen_at);
  CHECK(session.frozen_picture() == frozen_at);
  CHECK(session.shown_pose() == frozen_at);
}

TEST_CASE("what the learner does reaches the exam, and again when the exam is scored from a log that keeps it") {
  const auto loaded_case = tiny_loaded_case();
  Session session(loaded_case, replay_of(searching_scan()));
  session.advance(0);
  double now_s = run_until(session, 0, 0.5);
  session.set(ActionKind::depth, 120);
  session.set(ActionKind::gain, 4);
  session.set(ActionKind::dynamic_range, 45);
  session.set({ActionKind::time_gain, {2, 6}});
  session.set({ActionKind::time_gain, {2, 9}});  // as a slider that is dragged
  session.set({ActionKind::time_gain, {8, -3}});
  now_s = run_until(session, now_s, 0.7);
  const Machine as_seen = session.machine();
  CHECK(as_seen.time_gain_db[1] == 9);
  CHECK(session.actions().begin()->second.size() == 5);
  CHECK(session.runner()->machine().depth_mm == 120);
  CHECK(session.runner()->machine().gain_db == 4);
  session.freeze(true);
  now_s = run_until(session, now_s, 0.8);
  REQUIRE(session.runner()->machine().frozen_at);
  CHECK(*session.runner()->machine().frozen_at == *session.shown_pose());
  session.act({ActionKind::go_on});
  run_until(session, now_s, 10);
  REQUIRE(session.result());
  CHECK(session.result()->steps[0].outcome == StepOutcome::went_on);

  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "acts.igs.mha";
  {
    SequenceRecorder recorder(file);
    for (const ProbeSample& sample : searching_scan()) {
      const auto done = session.actions().find(sample.time_s);
      recorder.add(sample, done == session.actions().end() ? "" : to_text(done->second));
    }
    recorder.finish();
  }
  Session again(loaded_case, [&] { return open_tracker("replay:" + file.string()); });
  again.advance(0);
  now_s = run_until(again, 0, 0.9, 23);
  CHECK(again.machine().depth_mm == 120);
  CHECK(again.machine().dynamic_range_db == 45);
  CHECK(again.machine().time_gain_db == as_seen.time_gain_db);
  CHECK(again.machine().frozen);
  CHECK(*again.shown_pose() == *again.runner()->machine().frozen_at);
  again.set(ActionKind::gain, 9);  // a log's score is its own, whatever the one who watches sets
  run_until(again, now_s, 10, 23);
  REQUIRE(again.result());
  ExamResult replayed = *again.result();
  replayed.provenance = session.result()->provenance;
  CHECK(to_json(replayed) == to_json(*session.result()));
}

TEST_CASE("a frozen picture is changed by no setting that would acquire another, and says what to do first") {
  std::vector<ProbeSample> coming;
  Session session(tiny_loaded_case(), [&] { return std::make_unique<HandFed>(coming); });
  double now_s = 1;
  const auto hold = [&](double x) {
    now_s += 0.05;
    coming = {sample_at(now_s, Pose{glm::dmat3(1.0), {x, 0, 0}})};
    session.advance(now_s);
  };
  CHECK_FALSE(session.can_stand_still());  // a device measures on, and its samples count
  for (const double x : {0.0, 1.0, 2.0}) hold(x);
  CHECK(session.shown_pose() == session.newest_pose());
  session.advance(now_s + 0.02);  // between two samples, the picture runs ahead of the newest one
  CHECK_FALSE(session.shown_pose() == session.newest_pose());
  CHECK(session.why_not(ActionKind::depth).empty());
  session.freeze(true);
  INFO("the picture is that of a sample from the first frame on, and the next sample does not change it");
  CHECK(session.shown_pose() == session.newest_pose());
  const std::optional<Pose> frozen = session.shown_pose();
  for (const double x : {5.0, 9.0}) {
    hold(x);
    CHECK(session.shown_pose() == frozen);
  }

  const Machine before = session.machine();
  session.set(ActionKind::depth, 55);
  session.set(ActionKind::frequency, 9);
  session.choose_probe("linear");
  hold(9);
  CHECK(session.machine() == before);
  CHECK(session.latest_actions().empty());
  CHECK(session.why_not(ActionKind::depth) == "Frozen: press Space to scan on, then change the depth.");
  CHECK(session.why_not(ActionKind::dynamic_range).empty());
  session.set(ActionKind::gain, 4);
  CHECK(session.machine().gain_db == 4);
  session.freeze(false);
  session.set(ActionKind::depth, 55);
  hold(9);
  CHECK(session.runner()->machine().depth_mm == 55);
}

TEST_CASE("a log's settings are shown after the viewer lets the picture go, but not those that it had frozen out") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "froze.igs.mha";
  {
    SequenceRecorder recorder(file);
    for (const ProbeSample& sample : samples_of(4, 20, [](double) { return Pose{}; })) {
      const int tenth = int(std::lround(10 * sample.time_s));
      recorder.add(sample, tenth == 10 ? "depth 110" : tenth == 20 ? "freeze" : tenth == 25 ? "depth 70" : "");
    }
    recorder.finish();
  }
  Session session(tiny_loaded_case(false), [&] { return open_tracker("replay:" + file.string()); });
  session.advance(0);
  double now_s = run_until(session, 0, 0.5);
  const double depth_mm = session.machine().depth_mm;
  session.freeze(true);
  now_s = run_until(session, now_s, 1.5);
  CHECK(session.machine().depth_mm == depth_mm);
  session.freeze(false);
  CHECK(session.machine().depth_mm == 110);
  now_s = run_until(session, now_s, 2.2);
  CHECK(session.machine().frozen);
  session.freeze(false);  // the viewer looks on; the log's own picture is still frozen when its depth is set
  run_until(session, now_s, 3);
  CHECK(session.machine().depth_mm == 110);
}

TEST_CASE("knobs and acts between two samples keep their order, in practice too") {
  for (const bool with_exam : {true, false}) {
    CAPTURE(with_exam);
    Session session(tiny_loaded_case(with_exam), [] { return std::make_unique<MouseTracker>(Pose{}); });
    session.advance(0);
    session.advance(0.1);
    CHECK_FALSE(session.frozen_picture());
    session.freeze(true);
    CHECK_FALSE(session.frozen_picture());  // no sample has followed yet
    session.act({ActionKind::point, {1, 2}});
    session.set(ActionKind::gain, 5);
    session.act({ActionKind::point, {3, 4}});
    session.freeze(false);
    session.advance(0.2);
    REQUIRE(session.latest_actions().size() == 1);
    const std::vector<Action> expected{{ActionKind::freeze},
                                       {ActionKind::point, {1, 2}},
                                       {ActionKind::gain, {5}},
                                       {ActionKind::point, {3, 4}},
                                       {ActionKind::unfreeze}};
    CHECK(session.latest_actions().begin()->second == expected);
    session.freeze(true);
    session.advance(0.3);
    CHECK(session.frozen_picture() == session.newest_pose());
    CHECK(session.latest_actions().begin()->second == std::vector<Action>{{ActionKind::freeze}});
  }
}

TEST_CASE("effects are changed in practice alone, and an exam that follows has none of it") {
  Session session(tiny_loaded_case(), [] { return std::make_unique<MouseTracker>(Pose{}); });
  session.advance(0);
  REQUIRE(session.activity() == Activity::exam);
  session.set({ActionKind::effect, {0}, "noise"});
  CHECK(session.machine().effects.empty());
  CHECK(session.why_not(ActionKind::effect) == "Effects are for practice, without steps and score.");

  session.practise();
  CHECK(session.why_not(ActionKind::effect).empty());
  session.set({ActionKind::effect, {0}, "noise"});
  session.set({ActionKind::effect, {0}, "waves"});
  CHECK(session.machine().effects.size() == 2);
  session.advance(0.1);
  REQUIRE(session.latest_actions().size() == 1);
  const std::vector<Action>& done = session.latest_actions().begin()->second;
  REQUIRE(done.size() >= 2);
  CHECK(done[done.size() - 2] == Action{ActionKind::effect, {0}, "noise"});
  CHECK(done.back() == Action{ActionKind::effect, {0}, "waves"});
  session.freeze(true);
  CHECK(session.why_not(ActionKind::effect).find("Frozen") == 0);
  session.freeze(false);

  session.start_over();
  REQUIRE(session.activity() == Activity::exam);
  CHECK(session.machine().effects.empty());
}
