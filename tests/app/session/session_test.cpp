#include "app/session/session.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <unistd.h>

#include <filesystem>

#include "devices/live/probe_buttons.h"
#include "devices/mouse/mouse_tracker.h"
#include "devices/record/sequence_recorder.h"
#include "devices/registry.h"
#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "sim/core/digest.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "tests/app/session/tiny_session.h"

using namespace insonate;

namespace {

/// A runner's score as a session tells it that was fed from no file.
std::string score_of(const Runner& runner) {
  ExamResult result = runner.result();
  result.provenance.mode = AttemptMode::practice;
  return to_json(result);
}

}  // namespace

TEST_CASE("a log gets the same score to the bit in the trainer as from the runner, at any frame rate") {
  const auto loaded_case = tiny_loaded_case();
  Runner runner(*loaded_case->scenario, loaded_case->subject, loaded_case->tissues);
  runner.feed(searching_scan());
  runner.end();
  const std::string expected = score_of(runner);
  for (const double frames_per_s : {2.0, 23.0, 60.0, 144.0}) {
    CAPTURE(frames_per_s);
    Session session(loaded_case, replay_of(searching_scan()));
    session.advance(0);
    run_until(session, 0, 10, frames_per_s);
    REQUIRE(session.result());
    CHECK(to_json(*session.result()) == expected);
  }
}

TEST_CASE("a log that begins again at its end is refused for an exam, and practised with") {
  const auto looping = [] {
    return std::make_unique<ReplayTracker>("replay of scan.igs.mha", searching_scan(),
                                           ReplayTracker::Options{1.0, true});
  };
  CHECK_THROWS_WITH(Session(tiny_loaded_case(), looping),
                    Catch::Contains("scan.igs.mha") && Catch::Contains("leave loop=1 out"));
  CHECK_THROWS_AS(Session(tiny_loaded_case(), looping), InputError);

  Session session(tiny_loaded_case(false), looping);
  session.advance(0);
  run_until(session, 0, 20);  // more than twice through
  CHECK(session.tracker_state().delivered > 2 * searching_scan().size());
  CHECK_FALSE(session.result());
}

TEST_CASE("a log of a sensor's poses is refused: nobody knows where its probe was") {
  Recording recording{"run.raw", "digest", "reports of hydra:?raw=1"};
  const auto open = [&] {
    return std::make_unique<ReplayTracker>("raw replay of run.raw", searching_scan(), ReplayTracker::Options{},
                                           recording);
  };
  CHECK_NOTHROW(Session(tiny_loaded_case(false), open));
  recording.of_sensor = true;
  CHECK_THROWS_WITH(Session(tiny_loaded_case(false), open),
                    Catch::Contains("run.raw") && Catch::Contains("--calibration"));
}

TEST_CASE("each attempt names the log that it was scored from, also when the file has changed in between") {
  const auto file =
      std::filesystem::temp_directory_path() / ("insonate_session_" + std::to_string(getpid()) + ".igs.mha");
  const std::string first = write_sequence(searching_scan());
  const std::string second = write_sequence(samples_of(3, 60, [](double) { return turned(0, {1, 0, 0}, {0, 0, 30}); }));
  write_file(file, first);
  const auto loaded_case = tiny_loaded_case();
  Session session(loaded_case, [&] { return open_tracker("replay:" + file.string()); });
  session.advance(0);
  double now_s = run_until(session, 0, 1);
  write_file(file, second);  // the attempt under way has its samples already
  now_s = run_until(session, now_s, 10);

  const auto check = [&](const std::string& bytes) {
    Runner runner(*loaded_case->scenario, loaded_case->subject, loaded_case->tissues);
    runner.feed(probe_samples(parse_sequence(bytes, "a log")));
    runner.end();
    ExamResult expected = runner.result();
    expected.provenance.mode = AttemptMode::recording;
    expected.provenance.log = file.filename().string();
    expected.provenance.log_digest = digest_of(bytes);
    expected.provenance.log_transform = "ProbeToPatient";
    REQUIRE(session.result());
    CHECK(to_json(*session.result()) == to_json(expected));
  };
  check(first);
  session.start_over();
  CHECK_FALSE(session.result());
  now_s = run_until(session, now_s, now_s + 5);
  check(second);
  std::filesystem::remove(file);

  INFO("the learner's own exam names none");
  session.take_probe();
  session.start_over();
  run_until(session, now_s, now_s + 25);
  REQUIRE(session.result());
  CHECK(session.result()->provenance.mode == AttemptMode::practice);
  CHECK(session.result()->provenance.log.empty());
  CHECK(session.result()->provenance.log_digest.empty());
  CHECK(session.result()->provenance.log_transform.empty());
}

TEST_CASE(
    "a sample that is not OK never moves the probe, and after a quarter of a second the picture is said to stand") {
  const Pose good = turned(5, {1, 0, 0}, {1, 2, 3}), garbage = turned(50, {0, 1, 0}, {90, 90, 90});
  std::vector<ProbeSample> samples;
  for (int i = 0; i < 240; ++i) {
    const bool lost = i >= 60 && i < 180;
    samples.push_back(sample_at(i / 60.0, lost ? garbage : good, lost ? PoseStatus::out_of_view : PoseStatus::ok));
  }
  Session session(tiny_loaded_case(), replay_of(samples));
  session.advance(0);
  for (int i = 1; i < 239; ++i) {
    session.advance(i / 60.0);
    CAPTURE(i);
    REQUIRE(session.shown_pose());
    CHECK(*session.shown_pose() == good);
    // The last good sample is number 59, shown at 59/60 s.
    const bool stands = i / 60.0 - 59 / 60.0 > Session::kStale_s && i < 180;
    CHECK(session.lost_for_s().has_value() == stands);
  }
}

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

TEST_CASE("a tracker that tells no place goes on from where the learner has put the probe, any other from its own") {
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

TEST_CASE("of a live tracker the pose at the time of the picture is shown, and how it was found is told") {
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

  const auto file = std::filesystem::temp_directory_path() / ("insonate_acts_" + std::to_string(getpid()) + ".igs.mha");
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
  std::filesystem::remove(file);
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
  const auto file =
      std::filesystem::temp_directory_path() / ("insonate_froze_" + std::to_string(getpid()) + ".igs.mha");
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
  std::filesystem::remove(file);
}

TEST_CASE("knobs and acts between two samples keep their order, in practice too") {
  for (const bool with_exam : {true, false}) {
    CAPTURE(with_exam);
    Session session(tiny_loaded_case(with_exam), [] { return std::make_unique<MouseTracker>(Pose{}); });
    session.advance(0);
    session.advance(0.1);
    CHECK_FALSE(session.frozen_picture());
    session.freeze(true);
    CHECK_FALSE(session.frozen_picture());  // nobody has been told yet
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

TEST_CASE("free practice has no exam, and an exam can be started from it") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  session.practise();
  CHECK(session.runner() == nullptr);
  CHECK(session.holder() == Holder::tracker);
  run_until(session, 0, 10);
  CHECK_FALSE(session.result());
  session.start_over();
  REQUIRE(session.runner());
  CHECK(session.holder() == Holder::tracker);

  Session without(tiny_loaded_case(false), replay_of(searching_scan()));
  without.advance(0);
  run_until(without, 0, 10);
  CHECK(without.runner() == nullptr);
  CHECK_FALSE(without.result());
}

TEST_CASE("under strict rules an exam is taken once and as it is") {
  std::vector<ProbeSample> coming;
  const auto loaded_case = tiny_loaded_case();
  Session session(
      loaded_case, [&] { return std::make_unique<HandFed>(coming); }, 0, ExamRules::strict);
  CHECK(session.strict());
  CHECK_FALSE(session.shows_anatomy());
  session.advance(10);
  const int attempt = session.attempt();
  const auto still_the_exam = [&] {
    return session.activity() == Activity::exam && session.holder() == Holder::tracker &&
           session.attempt() == attempt && session.runner();
  };
  coming = {sample_at(10.1, turned(0, {1, 0, 0}, {1, 2, 3}))};
  session.advance(10.2);
  REQUIRE(session.runner()->live().started);

  session.practise();
  CHECK(still_the_exam());
  session.take_probe();
  CHECK(still_the_exam());
  session.give_back_probe();
  CHECK(still_the_exam());
  session.start_over();
  CHECK(still_the_exam());
  session.move_probe([](const ProbeHand&, const Pose& from) { return Pose{from.rotation, from.point({7, 0, 0})}; });
  CHECK(still_the_exam());

  INFO("there are no hints, and freezing is no pause");
  session.act({ActionKind::hint});
  session.freeze(true);
  coming = {sample_at(12, turned(0, {1, 0, 0}, {1, 2, 3}))};
  session.advance(12);
  REQUIRE(session.actions().size() == 1);
  CHECK(session.actions().begin()->second == std::vector<Action>{{ActionKind::freeze}});
  CHECK(session.runner()->live().elapsed_s == Approx(1.9));

  INFO("what is left before its end is scored as far as it went, and that is the end of it");
  session.hand_in();
  REQUIRE(session.result());
  CHECK(session.shows_anatomy());
  CHECK(session.result()->provenance.mode == AttemptMode::exam);
  CHECK(session.result()->complete);
  CHECK_FALSE(session.result()->passed);
  CHECK(session.result()->steps[0].outcome == StepOutcome::scan_ended);
  session.start_over();
  session.practise();
  CHECK(still_the_exam());
  CHECK(session.result());
}

TEST_CASE("what a scenario locks of the machine stays as it is in an exam, and in no practice") {
  const auto loaded_case = [] {
    auto made = std::make_shared<LoadedCase>(*tiny_loaded_case());
    made->scenario->locked = {ActionKind::probe, ActionKind::depth, ActionKind::gain};
    return made;
  }();
  for (const ExamRules rules : {ExamRules::strict, ExamRules::open}) {
    const bool strict = rules == ExamRules::strict;
    CAPTURE(strict);
    std::vector<ProbeSample> coming{sample_at(10.1, Pose{})};
    Session session(
        loaded_case, [&] { return std::make_unique<HandFed>(coming); }, 0, rules);
    session.advance(10.2);
    CHECK(session.locks(ActionKind::depth) == strict);
    CHECK_FALSE(session.locks(ActionKind::frequency));
    const Machine before = session.machine();
    session.choose_probe("linear");
    session.set(ActionKind::depth, 55);
    session.set(ActionKind::gain, 7);
    session.set({ActionKind::time_gain, {4, 12}});
    session.set(ActionKind::dynamic_range, 40);
    session.set(ActionKind::frequency, 2.5);
    session.act({ActionKind::point, {1, 2}});
    coming = {sample_at(10.3, Pose{})};
    session.advance(10.3);
    const Machine& machine = session.runner()->machine();
    CHECK(machine.probe == (strict ? before.probe : "linear"));
    CHECK(machine.depth_mm == (strict ? before.depth_mm : 55));
    CHECK(machine.gain_db == (strict ? 0 : 7));
    CHECK(machine.frequency_mhz == 2.5);
    CHECK(session.machine().depth_mm == machine.depth_mm);
    CHECK(session.machine().time_gain_db[3] == (strict ? 0 : 12));
    CHECK(session.machine().dynamic_range_db == (strict ? before.dynamic_range_db : 40));
    CHECK(session.machine().probe == machine.probe);

    INFO("also while no sample comes, and no longer than the exam");
    session.set(ActionKind::gain, 9);
    session.advance(10.4);
    CHECK(session.machine().gain_db == (strict ? 0 : 9));
    session.hand_in();
    session.set(ActionKind::gain, 9);
    session.advance(10.5);
    CHECK(session.machine().gain_db == 9);
  }
}

TEST_CASE("an exam under strict rules that nobody has begun is not handed in") {
  std::vector<ProbeSample> coming;
  Session session(
      tiny_loaded_case(), [&] { return std::make_unique<HandFed>(coming); }, 0, ExamRules::strict);
  session.advance(1);
  session.hand_in();
  CHECK_FALSE(session.result());
  session.start_over();  // nothing was seen of it yet
  CHECK(session.activity() == Activity::exam);
}

TEST_CASE("a motion that finds no skin leaves the probe where it is, and is reported for a moment") {
  Session session(tiny_loaded_case(), replay_of(searching_scan()));
  session.advance(0);
  session.take_probe();
  session.advance(0.1);
  const Pose before = *session.shown_pose();
  session.move_probe([](const ProbeHand&, const Pose&) { return std::nullopt; });
  session.advance(0.5);
  CHECK(session.stopped_at_edge());
  CHECK(*session.shown_pose() == before);
  session.move_probe([](const ProbeHand&, const Pose& from) { return Pose{from.rotation, from.point({7, 0, 0})}; });
  session.advance(0.6);
  CHECK_FALSE(session.stopped_at_edge());
  session.move_probe([](const ProbeHand&, const Pose&) { return std::nullopt; });
  session.advance(5);
  CHECK_FALSE(session.stopped_at_edge());
}
