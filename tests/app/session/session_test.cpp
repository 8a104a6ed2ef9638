#include "app/session/session.h"

#include <catch2/catch.hpp>

#include "devices/registry.h"
#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "tests/app/session/tiny_session.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

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
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "session.igs.mha";
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

TEST_CASE("the session says when the picture's beam lies where the CT ends") {
  const auto loaded_case = tiny_loaded_case();  // from -80 to 80 mm
  Session session(loaded_case,
                  [loaded_case] { return std::make_unique<MouseTracker>(loaded_case->surroundings.start); });
  session.practise();
  double now_s = 0;
  const auto at = [&](double z_mm, double tilt_deg = 0) {
    const double c = std::cos(glm::radians(tilt_deg)), s = std::sin(glm::radians(tilt_deg));
    const glm::dmat3 rotation(1, 0, 0, 0, c, s, 0, -s, c);  // the beam towards the head
    session.move_probe([&](const ProbeHand&, const Pose&) { return Pose{rotation, {0, 0, z_mm}}; });
    for (int i = 0; i < 3; ++i) session.advance(now_s += 0.1);
    return session.looks_past_ct();
  };
  CHECK_FALSE(at(0));
  CHECK_FALSE(at(74));
  CHECK(at(78));
  CHECK(at(-78));
  CHECK(at(120));
  CHECK_FALSE(at(0, 25));  // 140 mm end 59 mm towards the head
  CHECK(at(0, 60));        // more than a third of the beam lies beyond
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
  session.practise();
  session.start_over(Activity::practice);
  CHECK(session.runner() == nullptr);
  CHECK(session.activity() == Activity::practice);

  Session without(tiny_loaded_case(false), replay_of(searching_scan()));
  without.advance(0);
  run_until(without, 0, 10);
  CHECK(without.runner() == nullptr);
  CHECK_FALSE(without.result());
}
