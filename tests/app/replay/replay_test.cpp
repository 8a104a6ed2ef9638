#include "app/replay/replay.h"

#include <catch2/catch.hpp>

#include "app/replay/replay_source.h"
#include "devices/live/probe_buttons.h"
#include "devices/sequence/sequence.h"
#include "scenarios/caliper.h"
#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/case.h"
#include "tests/app/session/tiny_session.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

/// A scan that finds the ball after `search_s`, with losses of tracking, a mark, and knobs turned on the way.
RecordedScan scan(double search_s, double first_s = 0) {
  RecordedScan scan;
  scan.samples = samples_of(search_s + 5, 60, [&](double t) {
    const double off = 30 * std::max(0.0, 1 - t / search_s) + 1;
    return turned(off, {1, 0.4, 0}, {4 * std::sin(0.7 * t), 0.5, off});
  });
  for (ProbeSample& sample : scan.samples) {
    if (std::fmod(sample.time_s + 1, 2.3) < 0.35) sample.status = PoseStatus::missing;
    if (std::abs(sample.time_s - 1) < 0.2 && sample.status == PoseStatus::ok) sample.buttons = kEventMarkerButton;
    sample.time_s += first_s;
  }
  scan.recording.file = "scan.igs.mha";
  const auto act = [&](std::size_t frame, const char* what) {
    scan.recording.actions[scan.samples[frame].time_s] = what;
  };
  act(31, "depth 120; gain 4");
  act(60, "freeze");
  act(75, "caliper 1 0 40 0 80");
  act(100, "unfreeze; frequency 5");
  act(150, "probe :linear");
  act(200, "probe :curvilinear; depth 140");
  return scan;
}

/// All that the screen shows of a session at its time against what a replay says of that time.
void check_same(const Session& session, const PictureTools& tools, const Replay& replay) {
  const RunMoment& moment = replay.moment();
  REQUIRE(moment.shown_pose.has_value() == session.shown_pose().has_value());
  if (moment.shown_pose) CHECK(*moment.shown_pose == *session.shown_pose());
  REQUIRE(moment.newest_pose.has_value() == session.newest_pose().has_value());
  if (moment.newest_pose) CHECK(*moment.newest_pose == *session.newest_pose());
  CHECK(replay.machine() == session.machine());
  CHECK(replay.annotations() == shown_annotations(session, tools));
  if (!session.runner() || session.runner()->live().finished) return;
  const LiveExam& live = session.runner()->live();
  CHECK(moment.step == live.step);
  CHECK(moment.on_skin == live.on_skin);
  CHECK(moment.within_tolerance == live.within_tolerance);
  REQUIRE(moment.view.has_value() == live.view.has_value());
  if (!live.view) return;
  for (const ViewValues::Field& field : ViewValues::fields())
    CHECK(moment.view.value().*field.value == *live.view.*field.value);
}

}  // namespace

TEST_CASE("a replay at a time is what a session that played the log until then shows, however the time was come to") {
  const auto loaded_case = tiny_loaded_case();
  // An origin as of a tracker whose clock counts since 1970: the run's own times begin with 0 all the same.
  for (const double first_s : {0.0, 1.7e9}) {
    const RecordedScan log = scan(3, first_s);
    const RecordedRun run = play_through(loaded_case, log);
    Replay scrubbed(run), played(run);
    Session session(loaded_case, [&] {
      return std::make_unique<ReplayTracker>("a log", log.samples, ReplayTracker::Options{}, log.recording);
    });
    PictureTools tools;
    session.advance(0);
    tools.see(session);
    played.advance(0);
    played.toggle();
    // 23 frames a second: no frame falls together with samples.
    for (int frame = 1; frame / 23.0 < run.duration_s(); ++frame) {
      const double now_s = frame / 23.0;
      CAPTURE(first_s, now_s);
      session.advance(now_s);
      tools.see(session);
      played.advance(now_s);
      check_same(session, tools, played);
      for (std::uint32_t jump = 0; jump < 5; ++jump)
        scrubbed.seek(run.duration_s() * (double(unit_float(hash(std::uint32_t(frame), jump)))));
      scrubbed.seek(played.time_s());
      check_same(session, tools, scrubbed);
      CHECK(run.lost_for_s(scrubbed.time_s()).has_value() == session.lost_for_s().has_value());
      CHECK(run.index_at(scrubbed.time_s()) == run.index_at(played.time_s()));
    }
  }
}

TEST_CASE("a replayed run has its score, its steps, and what was done besides moving") {
  const auto loaded_case = tiny_loaded_case();
  const RecordedScan log = scan(3);
  const RecordedRun run = play_through(loaded_case, log);
  Runner runner(*loaded_case->scenario, loaded_case->subject, loaded_case->tissues);
  runner.feed(log.samples, parse_action_log(log.recording.actions, "a log"));
  runner.end();
  REQUIRE(run.result);
  ExamResult result = *run.result;
  result.provenance = runner.result().provenance;
  CHECK(to_json(result) == to_json(runner.result()));

  REQUIRE(run.moments.size() == log.samples.size());
  REQUIRE(run.stretches.size() == 2);
  CHECK(run.stretches[0].start_s == 0);
  CHECK(run.stretches[0].end_s == run.stretches[1].start_s);
  // The next step begins with the sample that ends the hold.
  CHECK(run.stretches[1].start_s == Approx(run.result->steps[1].start_s));
  CHECK(run.stretches[1].end_s == run.duration_s());
  // The sample that ends the exam is not measured itself, and shows what the one before did.
  const RunMoment& last = run.moments[run.index_at(run.result->steps[1].end_s)];
  REQUIRE(last.view.has_value());
  CHECK_FALSE(run.moments[run.index_at(last.time_s) + 1].view.has_value());

  std::vector<std::string> words;
  for (const RunEvent& event : run.events) words.push_back(event.words);
  CHECK(words == std::vector<std::string>{"Depth 12.0 cm", "Gain +4 dB", "Mark 1", "Freeze", "Caliper 1", "Live",
                                          "Frequency 5.0 MHz", "Probe Linear", "Probe Curvilinear", "Depth 14.0 cm"});
  CHECK(run.machine_at(log.samples[30].time_s).depth_mm != 120);
  CHECK(run.machine_at(log.samples[31].time_s).depth_mm == 120);
}

TEST_CASE("a replay has what lay over its pictures, from when it was placed until it was gone") {
  auto loaded_case = std::make_shared<LoadedCase>(*tiny_loaded_case(false));
  const std::string measure =
      "[[step]]\nkind = \"measure\"\ntitle = \"Volume\"\ninstruction = \"Measure.\"\nview = \"ball\"\n"
      "tool = \"volume\"\nwalls = \"outer to outer\"\n[[step.target]]\nstructures = [\"ball\"]\n";
  const std::string point =
      "[[step]]\nkind = \"mark_point\"\ntitle = \"Top\"\ninstruction = \"Point.\"\nlandmark = \"top\"\n";
  const std::string labels =
      "[[step]]\nkind = \"label_structures\"\ntitle = \"Names\"\ninstruction = \"Name.\"\n"
      "structures = [\"rib\", \"ball\"]\n";
  RecordedScan log;
  log.samples = samples_of(6, 60, [](double t) { return turned(0, {1, 0, 0}, {t, 0, 0}); });
  const Action first{ActionKind::caliper, {1, 0, 40, 0, 80}}, moved{ActionKind::caliper, {1, 0, 40, 0, 70}},
      second{ActionKind::caliper, {2, -20, 60, 20, 60}}, third{ActionKind::caliper, {3, -10, 50, 10, 50}};
  const Action place{ActionKind::point, {3, 45}}, ball{ActionKind::label, {0, 60}, "ball"},
      rib{ActionKind::label, {30, 16}, "rib"};
  const auto act = [&](std::size_t frame, const std::vector<Action>& actions) {
    log.recording.actions[log.samples[frame].time_s] = to_text(actions);
  };
  act(20, {{ActionKind::freeze}});
  act(30, {first});
  act(40, {moved});
  act(50, {take_back(first)});
  act(60, {first, second});
  act(70, {{ActionKind::unfreeze}});
  act(80, {{ActionKind::freeze}});
  act(90, {third});
  act(100, {{ActionKind::go_on}});
  act(110, {place});
  act(120, {{ActionKind::go_on}});
  act(130, {ball, rib});
  act(140, {take_back(rib)});

  RecordedRun run;
  const auto at = [&](std::size_t frame) -> const ShownAnnotations& {
    return run.annotations_at(log.samples[frame].time_s);
  };
  const auto placed = [&](std::size_t frame) {
    std::vector<Action> actions;
    for (const ShownAnnotations::Placed& annotation : at(frame).placed) actions.push_back(annotation.action);
    return actions;
  };
  using Actions = std::vector<Action>;
  using Value = ShownAnnotations::Value;
  using Of = ShownAnnotations::Value::Of;
  const Value length_1{"1   Length", value_text(first)}, length_2{"2   Depth", value_text(second)},
      length_3{"3   Width", value_text(third)};

  SECTION("in an exam: until it is taken back, the picture moves on or the step ends") {
    loaded_case->scenario =
        parse_scenario("format = 2\ntitle = \"Tools\"\ncase = \"tiny\"\npass_mark_percent = 50\ntime_limit_s = 600\n" +
                           measure + point + labels + "[[criterion]]\nmetric = \"time_s\"\nfull = 10\nzero = 100\n",
                       "exam.toml");
    run = play_through(loaded_case, log);
    CHECK(at(29) == ShownAnnotations{});
    CHECK(placed(30) == Actions{first});
    CHECK(at(30).values == std::vector{length_1});
    CHECK(run.annotations_at(log.samples[30].time_s - 0.001) == ShownAnnotations{});
    CHECK(placed(39) == Actions{first});
    CHECK(placed(40) == Actions{moved});
    CHECK(at(50) == ShownAnnotations{});
    CHECK(placed(69) == Actions{first, second});
    INFO("the values of a step that is measured in several pictures stay");
    const Value elsewhere_1{"1   Length", value_text(first), Of::other_picture},
        elsewhere_2{"2   Depth", value_text(second), Of::other_picture};
    CHECK(placed(70).empty());
    CHECK(at(70).values == std::vector{elsewhere_1, elsewhere_2});
    CHECK(placed(80).empty());
    CHECK(placed(99) == Actions{third});
    CHECK(at(99).values == std::vector{elsewhere_1, elsewhere_2, length_3, Value{"Volume", "17 ml"}});
    CHECK(at(100) == ShownAnnotations{});
    CHECK(placed(110) == Actions{place});
    CHECK(at(120) == ShownAnnotations{});
    CHECK(placed(130) == Actions{ball, rib});
    CHECK(placed(140) == Actions{ball});
    CHECK(run.annotations_at(run.duration_s()) == ShownAnnotations{});
  }
  SECTION("without one: until the picture moves on") {
    run = play_through(loaded_case, log);
    CHECK(placed(69) == Actions{first, second});
    const Value distance_1{"1   Distance", value_text(first)}, distance_2{"2   Distance", value_text(second)};
    CHECK(at(69).values == std::vector{distance_1, distance_2});
    CHECK(at(70) == ShownAnnotations{});
    CHECK(placed(80).empty());
    CHECK(placed(90) == Actions{third});
  }
}

TEST_CASE("an expert's run lies beside another step by step") {
  const auto loaded_case = tiny_loaded_case();
  const RecordedRun slow = play_through(loaded_case, scan(4)), fast = play_through(loaded_case, scan(1));
  REQUIRE(slow.stretches.size() == 2);
  REQUIRE(fast.stretches.size() == 2);
  Replay replay(slow, fast);
  const double boundary = slow.stretches[1].start_s, expert_boundary = fast.stretches[1].start_s;
  REQUIRE(boundary > expert_boundary + 1);
  replay.seek(0.5);
  CHECK(replay.expert_time_s() == 0.5);
  INFO("who was done sooner waits at their step's end");
  replay.seek(boundary - 0.1);
  CHECK(replay.expert_time_s() == fast.stretches[0].end_s);
  INFO("both begin the next step together");
  replay.seek(boundary);
  CHECK(replay.expert_time_s() == expert_boundary);
  CHECK(replay.beside_s(expert_boundary).value() == Approx(boundary));
  CHECK(replay.beside_s(0.5) == 0.5);
  INFO("what the expert did when the learner had gone on is not to be seen");
  Replay other(fast, slow);
  CHECK_FALSE(other.beside_s(boundary - 0.1));
  CHECK(other.expert_time_s(0.25) == 0.25);
  CHECK_FALSE(Replay(slow).expert_time_s());
}

TEST_CASE("an expert who took the steps in another order, or left one out, lies beside the same steps") {
  const auto run_of = [](std::vector<RunStretch> stretches) {
    RecordedRun run;
    run.moments.resize(2);
    run.moments.back().time_s = stretches.back().end_s;
    run.stretches = std::move(stretches);
    return run;
  };
  const RecordedRun learner = run_of({{0, 0, 2}, {1, 2, 8}});
  const Replay other_order(learner, run_of({{1, 0, 3}, {0, 3, 7}}));
  CHECK(other_order.expert_time_s(0.5) == 3.5);
  CHECK(other_order.expert_time_s(2.5) == 0.5);
  CHECK(other_order.expert_time_s(6) == 3);  // where the expert had gone on
  INFO("what the expert did up to the very end of the learner's step is beside it, and nothing later");
  CHECK(other_order.beside_s(5) == 2);
  CHECK_FALSE(other_order.beside_s(5.001));
  const Replay left_out(learner, run_of({{1, 0, 3}, {2, 3, 4}}));
  CHECK_FALSE(left_out.expert_time_s(0.5));
  CHECK(left_out.expert_time_s(2.5) == 0.5);
  CHECK_FALSE(left_out.beside_s(3.5));
}

TEST_CASE("a replay plays, pauses, steps by samples, and keeps to its ends") {
  Replay replay(play_through(tiny_loaded_case(false), scan(2, 500)));
  CHECK_FALSE(replay.run().result);
  CHECK(replay.run().stretches.size() == 1);
  const double end_s = replay.run().duration_s();
  replay.advance(100);
  replay.advance(101);
  CHECK(replay.time_s() == 0);
  replay.toggle();
  replay.advance(101.5);
  CHECK(replay.time_s() == Approx(0.5));
  replay.advance(101.2);  // nothing goes back with a clock that does
  CHECK(replay.time_s() == Approx(0.5));
  replay.advance(101.5);
  replay.seek(0.5);
  replay.change_speed(+1);
  CHECK(replay.speed() == 2);
  replay.advance(102);
  CHECK(replay.time_s() == Approx(1.5));
  replay.change_speed(-9);
  CHECK(replay.speed() == 0.25);
  replay.advance(103);
  CHECK(replay.time_s() == Approx(1.75));
  replay.step(1);
  CHECK_FALSE(replay.playing());
  const double at_s = replay.time_s();
  replay.step(1);
  CHECK(replay.time_s() - at_s == Approx(1 / 60.0).margin(1e-6));
  replay.step(-1);
  CHECK(replay.time_s() == at_s);
  replay.step(-100000);
  CHECK(replay.time_s() == 0);
  replay.seek(1e9);
  CHECK(replay.time_s() == end_s);
  replay.seek(-1);
  CHECK(replay.time_s() == 0);
  replay.seek(end_s);
  replay.change_speed(+9);
  CHECK(replay.speed() == 8);
  replay.toggle();
  CHECK(replay.time_s() == 0);
  replay.advance(103.01);
  replay.advance(200);
  CHECK(replay.time_s() == end_s);
  CHECK_FALSE(replay.playing());
}

TEST_CASE("a recording of another patient is refused, and without steps nothing is measured") {
  const TemporaryFolder folder;
  const auto loaded_case = tiny_loaded_case();
  Case subject = loaded_case->subject;
  for (const char* name : {"this", "other"}) {
    subject.name = name;
    write_case(folder.path / name, subject);
  }
  const RecordedScan taken = scan(3);
  const ActionLog actions{{taken.samples.front().time_s, {Action{ActionKind::patient, {}, "this"}}}};
  write_file(folder.path / "run.igs.mha", write_sequence(taken.samples, to_texts(actions)));
  ReplaySource source;
  source.log = folder.path / "run.igs.mha";
  CHECK(recorded_patient(source.log) == "this");
  CaseSource patient;
  patient.scenario = folder.path / "exam.toml";
  write_file(patient.scenario, loaded_case->scenario->text);
  const auto load = [&](const char* name) {
    patient.case_folder = folder.path / name;
    return load_replay(source, patient, [](std::string_view, double) {});
  };
  CHECK_THROWS_WITH(load("other"), Catch::Contains("it was recorded on 'this', not on 'other'"));
  CHECK(load("this").replay->run().result.has_value());
  source.beside_log = folder.path / "beside.igs.mha";
  write_file(
      source.beside_log,
      write_sequence(taken.samples,
                     to_texts(ActionLog{{taken.samples.front().time_s, {Action{ActionKind::patient, {}, "other"}}}})));
  CHECK_THROWS_WITH(load("this"), Catch::Contains("it was recorded on 'other', not on 'this'"));
  source.beside_log.clear();
  source.without_steps = true;
  CHECK_FALSE(load("this").replay->run().result.has_value());
}

// Its actions are read before its poses: when a pose is refused, they have to be given back once (tools/check-braces).
TEST_CASE("an attempt whose log is damaged is refused in a sentence that names it and the frame") {
  const RecordedScan taken = scan(3);
  std::string log = write_sequence(taken.samples, taken.recording.actions);
  const std::string matrix = "Seq_Frame0300_ProbeToPatientTransform = ";
  const std::size_t number = log.find(matrix) + matrix.size();
  REQUIRE(log.find(matrix) != std::string::npos);
  log.replace(number, log.find(' ', number) - number, "2.5");

  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  Attempt attempt = made_attempt("L-01", tiny_exam(0), log);
  database.add(attempt);
  ReplaySource source;
  source.database = database.file();
  source.attempt = attempt.number;
  CHECK_THROWS_WITH(load_replay(source, CaseSource(), [](std::string_view, double) {}),
                    Catch::StartsWith("attempt 1: frame 300: ProbeToPatientTransform: "));
}
