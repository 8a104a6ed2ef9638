#include "app/recording/run_recorder.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <filesystem>

#include "devices/mouse/mouse_tracker.h"
#include "devices/replay/replay_tracker.h"
#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/test_samples.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A scan of the tiny ball with losses of tracking and a button on the way.
std::vector<ProbeSample> scan() {
  auto samples = samples_of(6, 60, [](double t) { return turned(10 * std::sin(t), {1, 0.4, 0}, {4 * t, 0.5, 3}); });
  for (ProbeSample& sample : samples) {
    if (std::fmod(sample.time_s, 2) < 0.2) sample = {sample.time_s, PoseStatus::missing, Pose{}, 0};
    if (std::fmod(sample.time_s, 1) > 0.9) sample.buttons = 2;
  }
  return samples;
}

std::shared_ptr<const LoadedCase> tiny_loaded_case() {
  auto loaded_case = std::make_shared<LoadedCase>();
  loaded_case->patient = "Tiny";
  loaded_case->subject = tiny_case();
  loaded_case->tissues = tiny_tissues();
  loaded_case->scenario = parse_scenario(kTinyScenario, "exam.toml");
  loaded_case->surroundings.start.translation = {0, 0, -40};
  return loaded_case;
}

Session replaying() {
  return Session(tiny_loaded_case(),
                 [] { return std::make_unique<ReplayTracker>("a log", scan(), ReplayTracker::Options{}); });
}

/// Advances at 30 Hz and records.
void run(Session& session, RunRecorder& recorder, double from_s, double to_s) {
  for (double now_s = from_s; now_s < to_s; now_s += 1.0 / 30) {
    session.advance(now_s);
    recorder.take(session);
  }
}

DrawnPicture picture(double time_s, int width, int height, std::uint8_t grey) {
  DrawnPicture made;
  made.grey = Image<std::uint8_t>(width, height, grey);
  made.geometry = {width, height, 120.0 / width, {-60, 1}};
  made.patient_from_probe = turned(10, {1, 2, 3}, {1, 2, 3});
  made.time_s = time_s;
  made.attempt = 1;
  return made;
}

}  // namespace

TEST_CASE("a recorded exam is the samples to the bit, and another attempt is another file") {
  const TemporaryFolder folder;
  Session session = replaying();
  RunRecorder recorder(false);
  run(session, recorder, 0, 1);  // before it records
  CHECK(recorder.file().empty());
  session.start_over();
  recorder.start(folder.path / "run.igs.mha", true);
  CHECK(recorder.running());
  run(session, recorder, 2, 10);
  CHECK(recorder.duration_s() == Approx(8).margin(0.1));
  REQUIRE(session.result());
  session.start_over();
  run(session, recorder, 20, 23);
  recorder.stop();
  CHECK_FALSE(recorder.running());
  recorder.wait();
  CHECK_NOTHROW(recorder.check());
  CHECK(recorder.file() == folder.path / "run-2.igs.mha");
  CHECK(recorder.take_finished() == std::vector{folder.path / "run.igs.mha", folder.path / "run-2.igs.mha"});
  CHECK(recorder.take_finished().empty());

  const auto recorded = [&](const char* name) { return read_recorded_scan(folder.path / name).samples; };
  CHECK(same_bits(recorded("run.igs.mha"), scan()));
  CHECK(recorded("run-2.igs.mha").size() > 170);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path))
    CHECK(entry.path().extension() == ".mha");

  INFO("a recording that is started again takes the next free name");
  session.start_over();
  recorder.start(folder.path / "run.igs.mha", false);
  run(session, recorder, 30, 31);
  recorder.stop();
  recorder.wait();
  CHECK(fs::exists(folder.path / "run-3.igs.mha"));
}

TEST_CASE("what the learner does is recorded with the samples, and from the middle on how the machine was set") {
  const TemporaryFolder folder;
  Session session(tiny_loaded_case(), [] { return std::make_unique<MouseTracker>(Pose{}); });
  RunRecorder recorder(false);
  recorder.start(folder.path / "whole.igs.mha", true);
  run(session, recorder, 0, 0.2);
  session.set(ActionKind::depth, 95);
  session.act({ActionKind::answer, {}, "a stone"});
  run(session, recorder, 0.2, 0.4);
  recorder.stop();
  recorder.wait();
  const auto recorded = [&](const char* name) {
    return parse_action_log(read_recorded_scan(folder.path / name).recording.actions, name);
  };
  ActionLog whole = recorded("whole.igs.mha");
  REQUIRE(!whole.empty());
  std::vector<Action>& first = whole.begin()->second;
  CHECK(first.front() == Action{ActionKind::patient, {}, session.patient()});
  first.erase(first.begin());
  if (first.empty()) whole.erase(whole.begin());
  CHECK(whole == session.actions());

  recorder.start(folder.path / "rest.igs.mha", true);
  run(session, recorder, 0.4, 0.6);
  recorder.stop();
  recorder.wait();
  CHECK_NOTHROW(recorder.check());
  const ActionLog rest = recorded("rest.igs.mha");
  REQUIRE(rest.size() == 1);
  Machine machine;
  for (const Action& action : rest.begin()->second) machine.apply(action, std::nullopt);
  CHECK(machine.depth_mm == 95);
  CHECK(machine.probe == session.machine().probe);
  CHECK(machine.frequency_mhz == session.machine().frequency_mhz);
}

TEST_CASE("pictures lie beside the samples, all of the first one's size and where they were") {
  const TemporaryFolder folder;
  Session session = replaying();
  RunRecorder recorder(true);
  recorder.start(folder.path / "run.igs.mha", true);
  CHECK(recorder.wants_pictures());
  run(session, recorder, 0, 1);
  recorder.take(picture(0.1, 12, 8, 40));
  recorder.take(picture(0.2, 24, 16, 80));  // of a window that was enlarged
  recorder.take(picture(0.2, 12, 8, 99));   // of the same time: the file has that one already
  DrawnPicture other = picture(0.3, 12, 8, 120);
  other.attempt = 2;  // of an attempt that this file is not of
  recorder.take(other);
  recorder.stop();
  recorder.wait();
  CHECK_NOTHROW(recorder.check());

  const std::string bytes = read_file(folder.path / "run-images.igs.mha");
  CHECK(bytes.find("DimSize = 12 8 2\n") != std::string::npos);
  const Sequence sequence = parse_sequence(bytes, "images");
  REQUIRE(sequence.frames.size() == 2);
  CHECK(sequence.has_images);
  CHECK(sequence.frames[1].time_s == 0.2);
  const int image = sequence.find("ImageToProbe");
  REQUIRE(image >= 0);
  // Pixels of 10 mm; of the larger picture each other column is taken, and the middle of two lies half a pixel further.
  CHECK(sequence.frames[0].find(image)->matrix[0][0] == Approx(10));
  CHECK(sequence.frames[1].find(image)->matrix[0][0] == Approx(10));
  CHECK(sequence.frames[0].find(image)->matrix[3][0] == Approx(-60));
  CHECK(sequence.frames[1].find(image)->matrix[3][0] == Approx(-57.5));
  CHECK(probe_samples(sequence)[0].patient_from_probe == picture(0, 1, 1, 0).patient_from_probe);
}

TEST_CASE("what cannot be recorded is reported once and ends the recording, and the next one goes on") {
  const TemporaryFolder folder;
  write_file(folder.path / "file", "no folder");
  Session session = replaying();
  RunRecorder recorder(false);
  recorder.start(folder.path / "file" / "run.igs.mha", true);
  run(session, recorder, 0, 1);
  recorder.wait();
  CHECK_THROWS_AS(recorder.check(), InputError);
  CHECK_FALSE(recorder.running());
  CHECK_NOTHROW(recorder.check());
  recorder.start(folder.path / "run.igs.mha", true);
  run(session, recorder, 1, 2);
  recorder.stop();
  recorder.wait();
  CHECK_NOTHROW(recorder.check());
  CHECK(read_recorded_scan(folder.path / "run.igs.mha").samples.size() > 50);
}
