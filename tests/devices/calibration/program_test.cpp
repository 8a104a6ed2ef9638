// insonate-devices calibrate as a person runs it, on the recording of a made-up set-up; and what its file then does.
#include <catch2/catch.hpp>

#include "devices/calibrated_tracker.h"
#include "devices/calibration/setup_input.h"
#include "devices/calibration/utc.h"
#include "devices/replay/replay_tracker.h"
#include "devices/sequence/sequence.h"
#include "sim/core/input_error.h"
#include "tests/core/run_program.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/calibration/hand.h"

using namespace insonate;
using Catch::Contains;

namespace {

ProgramOutcome run(const std::string& arguments, const std::string& input = "</dev/null ") {
  return run_program(input + INSONATE_DEVICES_PROGRAM + " calibrate " + arguments + " 2>&1");
}

LandmarkList patient() {
  return read_landmark_list(std::string(INSONATE_ASSETS_FOLDER) + "/calibration/abdomen.toml");
}

/// A recorded set-up, and how a command line names it.
std::string recorded(const TemporaryFolder& folder, const std::string& name, const Hand& hand) {
  return "'replay:" + folder.put(name, write_sequence(as_raw(hand.samples()))).string() + "?speed=1000'";
}

Hand whole_set_up(const Lab& lab) {
  Hand hand(lab, 11);
  hand.axes();
  hand.pivot(14);
  hand.face();
  hand.landmarks(patient().landmarks, 0.3);
  hand.knocks(0.05);
  return hand;
}

}  // namespace

TEST_CASE("insonate-devices calibrate makes the whole set-up from a recording, and the tracker then finds the probe") {
  const TemporaryFolder folder;
  const Lab lab;
  const std::string out = (folder.path / "lab.toml").string();
  const ProgramOutcome made =
      run("--tracker " + recorded(folder, "setup.igs.mha", whole_set_up(lab)) + " --out " + out);
  CAPTURE(made.output);
  REQUIRE(made.code == 0);
  for (const char* words : {"no axis is mirrored", "residual 0.", "accuracy", " ms late"})
    CHECK_THAT(made.output, Contains(words));
  const Calibration calibration = read_calibration(out);
  CHECK(calibration.tracker == TrackerIdentity{"replay", ""});

  // A scan by that probe, replayed through the file.
  std::vector<ProbeSample> truth, scan;
  Dice dice(12);
  for (int i = 0; i < 50; ++i) {
    truth.push_back({i * 0.1, i % 9 ? PoseStatus::ok : PoseStatus::missing, dice.pose(100), std::uint32_t(i % 3)});
    ProbeSample raw = truth.back();
    raw.patient_from_probe = lab.ct_from_tracker.inverse() * raw.patient_from_probe * lab.sensor_from_face.inverse();
    scan.push_back(raw);
  }
  CalibratedTracker tracker(
      SensorTracker(std::make_unique<ReplayTracker>("a scan", scan, ReplayTracker::Options{},
                                                    Recording{"scan.igs.mha", "0", "SensorToTracker"})),
      calibration, "lab.toml");
  std::vector<ProbeSample> samples;
  tracker.poll(0, samples);
  tracker.poll(100, samples);
  REQUIRE(samples.size() == truth.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CHECK(samples[i].time_s == truth[i].time_s);
    CHECK(samples[i].status == truth[i].status);
    CHECK(samples[i].buttons == truth[i].buttons);
    if (samples[i].status != PoseStatus::ok) continue;
    // Landmarks were touched with 0.5 mm of error, RMS.
    CHECK(glm::distance(samples[i].patient_from_probe.translation, truth[i].patient_from_probe.translation) < 1.5);
    CHECK(angle_between_deg(samples[i].patient_from_probe, truth[i].patient_from_probe) < 0.6);
  }
  CHECK(tracker.state().condition == TrackerCondition::finished);
  CHECK(tracker.state().name == "a scan, calibrated " + utc_text(made_s(calibration)).substr(0, 10));
  CHECK_THAT(tracker.recording()->transform, Contains("SensorToTracker through lab.toml"));
  CHECK_THROWS_AS(CalibratedTracker(SensorTracker(std::make_unique<ReplayTracker>("x", scan, ReplayTracker::Options{})),
                                    Calibration(), "x"),
                  std::invalid_argument);
}

TEST_CASE("insonate-devices calibrate makes one step at a time and keeps the others") {
  const TemporaryFolder folder;
  const Lab lab;
  const std::string out = (folder.path / "lab.toml").string(), to = " --out " + out + " --tracker ";
  Hand pivot(lab, 1), face(lab, 2), landmarks(lab, 3);
  pivot.pivot(14);
  face.face();
  landmarks.landmarks(patient().landmarks, 0.3);
  const ProgramOutcome first = run("landmarks" + to + recorded(folder, "3.igs.mha", landmarks));
  CHECK(first.code == 2);
  CHECK_THAT(first.output, Contains("make the step Probe tip ('pivot') first"));
  CHECK_THAT(run("pivot" + to + recorded(folder, "1.igs.mha", pivot)).output,
             Contains("the step 'face' is still to be made"));
  CHECK_THAT(run("face" + to + recorded(folder, "2.igs.mha", face)).output, Contains("the step 'landmarks' is still"));
  const ProgramOutcome last = run("landmarks" + to + recorded(folder, "3.igs.mha", landmarks));
  CHECK(last.code == 0);
  CHECK_FALSE(Catch::Contains("still to be made").match(last.output));
  CHECK(why_incomplete(read_calibration(out)).empty());

  // The file of one tracker is not another's.
  const ProgramOutcome other = run("pivot" + to + "synthetic:3");
  CHECK(other.code == 2);
  CHECK_THAT(other.output, Contains("another tracker (replay)"));
}

TEST_CASE("insonate-devices calibrate marks by the keyboard as well") {
  const TemporaryFolder folder;
  // A sample at every poll, so that two marks never fall between the same two samples, however busy the machine is.
  Lab fast;
  fast.rate_hz = 1000;
  Hand still(fast, 4);
  still.hold(Pose{}, 5);
  // Two marks without a move between them: too short, which shows that both arrived.
  const ProgramOutcome typed = run(
      "axes --out " + (folder.path / "lab.toml").string() +
          " --tracker 'replay:" + folder.put("still.igs.mha", write_sequence(as_raw(still.samples()))).string() + "'",
      "(sleep 0.2; echo; sleep 0.3; echo) | ");
  CHECK(typed.code == 2);
  CHECK_THAT(typed.output, Contains("That was too short"));
}

TEST_CASE("insonate-devices calibrate refuses what it cannot use in a sentence, and leaves the file as it was") {
  const TemporaryFolder folder;
  const Lab lab;
  const std::string out = (folder.path / "lab.toml").string(), to = " --out " + out + " --tracker ";
  Hand pivot(lab, 1), slipping(lab, 2);
  pivot.pivot(4);
  slipping.pivot(14, 5);
  const std::string cut = recorded(folder, "cut.igs.mha", pivot), slipped = recorded(folder, "slip.igs.mha", slipping);
  const std::pair<std::string, const char*> wrong[] = {
      {"pivot" + to + cut, "it ended before the step was done"},
      {"pivot" + to + slipped, "strayed by"},
      {"pivot" + to + "mouse:", "has no sensor"},
      {"pivot --tracker " + cut, "--out is required"},
      {"pivto" + to + cut, "pivto"},
      {"face --drawing /nowhere.toml" + to + cut, "/nowhere.toml: there is no such file"},
      {"landmarks --moved" + to + cut, "Probe tip ('pivot') first"},
  };
  for (const auto& [arguments, says] : wrong) {
    const ProgramOutcome refused = run(arguments);
    CAPTURE(arguments, refused.output);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.output, Contains(says));
    CHECK_FALSE(std::filesystem::exists(out));
  }
  folder.put("lab.toml", "kind = 1\n");
  CHECK_THAT(run("pivot" + to + cut).output, Contains("lab.toml: line 1"));
}

TEST_CASE("trackers are distinguished by kind and by what their URI names, recordings are not") {
  CHECK(tracker_identity("hydra:17") == TrackerIdentity{"hydra", "17"});
  CHECK(tracker_identity("hydra:17?handset=2") == TrackerIdentity{"hydra", "17", 2});
  CHECK(tracker_identity("polhemus:?sensor=3&raw=1") == TrackerIdentity{"polhemus", "", 3});
  CHECK(tracker_identity("polhemus:?sensor=1") == tracker_identity("polhemus:"));
  CHECK(tracker_identity("polhemus:V7?sensor=3").words() == "polhemus, serial V7, sensor 3");
  CHECK_THROWS_AS(tracker_identity("polhemus:?sensor=0"), InputError);
  CHECK(tracker_identity("replay:a.igs.mha?speed=2") == tracker_identity("replay:b.igs.mha"));
  CHECK(can_store_setup("hydra:17"));
  CHECK_FALSE(can_store_setup("mouse:"));
  CHECK_FALSE(can_store_setup("hydrra:"));  // opening it is what refuses it
  CHECK_THROWS_WITH(check_can_be_calibrated("mouse:"), Contains("'mouse:': it moves the probe in the patient"));
  CHECK_THROWS_WITH(check_can_be_calibrated("auto:"),
                    Contains("tracker 'auto:': a calibration belongs to one tracker, not to the best; name it"));
  CHECK_NOTHROW(check_can_be_calibrated("replay:a.igs.mha"));
}

TEST_CASE("a tracker that places the probe by itself is asked for its sensor, filtered only to scan with") {
  CHECK(sensor_uri("hydra:17", false) == "hydra:17?raw=1");
  CHECK(sensor_uri("hydra:17?handset=2", true) == "hydra:17?handset=2&raw=1&filter=1euro,outlier");
  CHECK(sensor_uri("polhemus:?distortion=20", true) == "polhemus:?distortion=20&raw=1&filter=1euro,outlier,distortion");
  CHECK(sensor_uri("polhemus:?filter=off", true) == "polhemus:?filter=off&raw=1");
  CHECK(sensor_uri("hydra:?raw=1", true) == "hydra:?raw=1");
  CHECK(sensor_uri("igtl://localhost", true) == "igtl://localhost");
}
