// Recordings as other programs write them: coordinate frames to be chained, frames without times or out of order.
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "devices/log_report.h"
#include "devices/registry.h"
#include "devices/replay/read_log.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/transform_path.h"
#include "sim/core/input_error.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/test_samples.h"

using namespace insonate;
using Catch::Contains;

namespace {

/// A translation by x and y, in the form of a file.
std::string moved(int x, int y) {
  return "1 0 0 " + std::to_string(x) + " 0 1 0 " + std::to_string(y) + " 0 0 1 0 0 0 0 1";
}

struct Field {
  std::string name, value;
};

/// The fields of a transform and its status.
std::vector<Field> transform(const std::string& name, const std::string& matrix, const std::string& status = "OK") {
  return {{name + "Transform", matrix}, {name + "TransformStatus", status}};
}

std::string text_of(const std::vector<std::vector<Field>>& frames, const std::string& header = "") {
  std::string text = "ObjectType = Image\nNDims = 3\nDimSize = 0 0 " + std::to_string(frames.size()) + "\n" + header;
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (const Field& field : frames[f])
      text += "Seq_Frame000" + std::to_string(f) + "_" + field.name + " = " + field.value + "\n";
  return text + "ElementDataFile = LOCAL\n";
}

std::vector<Field> joined(std::vector<std::vector<Field>> parts) {
  std::vector<Field> all;
  for (const std::vector<Field>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<Field> at(const std::string& time, const std::vector<std::vector<Field>>& parts) {
  std::vector<Field> all = joined(parts);
  all.push_back({"Timestamp", time});
  return all;
}

ProbeTrack track_of(const std::string& text, const RecordingOptions& options = {}) {
  return probe_track(parse_sequence(text, "log"), options);
}

std::string refusal(const std::string& text, const RecordingOptions& options = {}) {
  try {
    track_of(text, options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

glm::dvec3 first(const ProbeTrack& track) {
  return track.samples[0].patient_from_probe.translation;
}

}  // namespace

TEST_CASE("a transform's name is split at the first 'To' before a capital letter") {
  CHECK(frames_of("ProbeToTracker").from == "Probe");
  CHECK(frames_of("ProbeToTracker").to == "Tracker");
  CHECK(frames_of("ToolToTracker").from == "Tool");
  CHECK(frames_of("StopTopToTotal").to == "Total");
  CHECK(frames_of("Stylus").from.empty());
  CHECK(frames_of("ToTracker").from.empty());
  CHECK(frames_of("ProbeTo").from.empty());
}

TEST_CASE("the way from the probe leads through the transforms of frames and header, in both directions") {
  const auto probe = transform("ProbeToTracker", moved(1, 0)),
             reference = transform("ReferenceToTracker", moved(10, 3));
  const ProbeTrack to_reference = track_of(text_of({at("1", {probe, reference})}));
  CHECK(to_reference.transform == "ProbeToTracker, TrackerToReference");
  CHECK(first(to_reference) == glm::dvec3(-9, -3, 0));

  // Two transforms of the header, one of them backwards, lead on to the patient.
  const ProbeTrack to_patient =
      track_of(text_of({at("1", {probe, reference})}, "RoomToReferenceTransform = " + moved(100, 0) +
                                                          "\nRoomToPatientTransform = " + moved(7, 0) + "\n"));
  CHECK(to_patient.transform == "ProbeToTracker, TrackerToReference, ReferenceToRoom, RoomToPatient");
  CHECK(first(to_patient) == glm::dvec3(-102, -3, 0));

  // A direct way is shorter.
  const ProbeTrack direct =
      track_of(text_of({at("1", {probe, reference, transform("ProbeToReference", moved(5, 0))})}));
  CHECK(direct.transform == "ProbeToReference");

  CHECK(first(track_of(text_of({at("1", {probe, reference})}), {.transform = "ProbeToTracker"})) ==
        glm::dvec3(1, 0, 0));
  CHECK(first(track_of(text_of({at("1", {probe, reference})}), {.transform = "TrackerToReferenceTransform"})) ==
        glm::dvec3(-10, -3, 0));
}

TEST_CASE("the only transform of the probe is taken, whatever it leads to") {
  const auto stepper = transform("ProbeToStepperHome", moved(4, 0));
  CHECK(track_of(text_of({at("1", {stepper, transform("StylusToTracker", moved(2, 0))})})).transform ==
        "ProbeToStepperHome");
  CHECK_THAT(refusal(text_of({at("1", {stepper, transform("ProbeTipToStepper", moved(2, 0))})})),
             Contains("it has ProbeToStepperHome, ProbeTipToStepper") &&
                 Contains("such as ProbeToStepperHome: by --transform"));
  // Of transforms that hold for all frames alone nothing can be followed.
  CHECK_THAT(refusal(text_of({at("1", {transform("StylusToTracker", moved(2, 0))})},
                             "ProbeToPatientTransform = " + moved(0, 0) + "\n")),
             Contains("such as StylusToTracker: by --transform"));
}

TEST_CASE("every link of a way has to be OK in its frame") {
  const auto text = [](const std::string& probe, const std::string& reference) {
    return text_of({at("1", {transform("ProbeToTracker", moved(1, 0)), transform("ReferenceToTracker", moved(1, 0))}),
                    at("2", {transform("ProbeToTracker", moved(1, 0), probe),
                             transform("ReferenceToTracker", moved(1, 0), reference)})});
  };
  CHECK(track_of(text("OK", "OK")).samples[1].status == PoseStatus::ok);
  CHECK(track_of(text("MISSING", "OK")).samples[1].status == PoseStatus::missing);
  CHECK(track_of(text("OK", "OUT_OF_VIEW")).samples[1].status == PoseStatus::out_of_view);
  CHECK(track_of(text("OK", "OUT_OF_VIEW")).samples[1].patient_from_probe == Pose{});
}

TEST_CASE("a transform without a status in any frame is passed by, unless it leads to the patient") {
  const std::vector<Field> probe = transform("ProbeToTracker", moved(1, 0));
  const auto text = [&](const std::string& other) {
    return text_of({at("1", {probe, {{other + "Transform", moved(1, 0)}}})});
  };
  CHECK(track_of(text("ReferenceToTracker")).transform == "ProbeToTracker");
  const ProbeTrack to_patient = track_of(text("TrackerToPatient"));
  CHECK(to_patient.transform == "ProbeToTracker, TrackerToPatient");
  CHECK(to_patient.samples[0].status == PoseStatus::unknown);
  const LogReport report = check_log(recorded_scan(parse_sequence(text("TrackerToPatient"), "log")));
  CHECK_THAT(report.findings().front(), Contains("none has the status OK for ProbeToTracker, TrackerToPatient"));
}

TEST_CASE("a pose that is not rigid is refused by the name of the link that is at fault") {
  const std::string stretched = "1 0 0 0 0 2.5 0 0 0 0 1 0 0 0 0 1";
  CHECK_THAT(refusal(text_of(
                 {at("1", {transform("ProbeToTracker", moved(1, 0)), transform("ReferenceToTracker", stretched)})})),
             Contains("frame 0: ReferenceToTrackerTransform: the rotation is not orthonormal"));
  CHECK_THAT(refusal(text_of({at("1", {transform("ProbeToTracker", moved(1, 0))})},
                             "TrackerToPatientTransform = " + stretched + "\n")),
             Contains("header: TrackerToPatientTransform") && Contains("; correct the header, or calibrate"));
}

TEST_CASE("a way may lead through a frame that is not in mm") {
  const std::string pixels = "0.2 0 0 0 0 0.25 0 0 0 0 1 0 0 0 0 1", elsewhere = "0.2 0 0 9 0 0.25 0 0 0 0 1 0 0 0 0 1";
  const ProbeTrack track =
      track_of(text_of({at("1", {transform("ImageToProbe", pixels), transform("ImageToReference", elsewhere)})}));
  CHECK(track.transform == "ProbeToImage, ImageToReference");
  CHECK(glm::distance(first(track), glm::dvec3(9, 0, 0)) < 1e-12);
}

TEST_CASE("rotations are rounded up to 2e-3, counted, and refused beyond") {
  const auto text = [](const std::string& entry) {
    return text_of({at("1", {transform("ProbeToTracker", entry + " 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1")})});
  };
  const ProbeTrack exact = track_of(text("1.00005"));
  CHECK(exact.repairs.rounded_rotations == 0);
  const ProbeTrack rounded = track_of(text("1.0009"));
  CHECK(rounded.repairs.rounded_rotations == 1);
  CHECK(rounded.repairs.worst_rotation_error == Approx(1.0009 * 1.0009 - 1));
  CHECK(orthonormal_error(rounded.samples[0].patient_from_probe.rotation) < 1e-15);
  CHECK_THAT(refusal(text("1.0011")), Contains("frame 0") && Contains("its columns are 1.0011, 1 and 1 long, not 1"));
}

TEST_CASE("a refused pose reaches the caller that reads a file, and nothing else happens") {
  TemporaryFolder folder;
  const std::filesystem::path file = folder.put(
      "scan.igs.mha", text_of({at("1", {transform("ProbeToPatient", "2.5 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")})}));
  // The actions and names of the recording are made before its samples are refused.
  CHECK_THROWS_WITH(read_recorded_scan(file), Contains("ProbeToPatientTransform: the rotation is not orthonormal"));
  CHECK_THROWS_WITH(read_log(file), Contains("frame 0"));
}

TEST_CASE("frames without times are refused, but can be looked at and replayed at a rate") {
  const std::vector<Field> frame = transform("ProbeToTracker", moved(1, 0));
  const std::string text = text_of({frame, frame, frame});
  CHECK_THAT(refusal(text), Contains("no Timestamp") && Contains("'replay:FILE?rate=HZ'"));
  const ProbeTrack track = track_of(text, {.rate_hz = 4});
  CHECK(track.samples[2].time_s == 0.5);

  const RecordedScan scan = recorded_scan(parse_sequence(text, "log"), {.rate_hz = 4});
  CHECK(scan.recording.assumed_rate_hz == 4.0);
  CHECK_THROWS_WITH(check_has_times(scan.recording), Contains("an exam is not scored by an assumed rate"));

  const LogReport report = check_log(recorded_scan(parse_sequence(text, "log"), {.without_times = true}));
  CHECK_FALSE(report.has_times);
  CHECK(report.usable == 3);
  CHECK(report.duration_s == 0);
  CHECK(report.gaps.empty());
  REQUIRE(report.findings().size() == 1);
  CHECK_THAT(report.findings()[0], Contains("?rate=HZ") && Contains("exam"));

  CHECK_THAT(refusal(text_of({at("1", {frame})}), {.rate_hz = 4}), Contains("leave '?rate=' out"));
  CHECK_THAT(refusal(text_of({at("1", {frame}), frame})), Contains("frame 1: it has no Timestamp"));
}

TEST_CASE("a replay takes the rate of a recording without times") {
  TemporaryFolder folder;
  const std::vector<Field> frame = transform("ProbeToTracker", moved(1, 0));
  const std::filesystem::path file = folder.put("scan.igs.mha", text_of({frame, frame, frame}));
  const auto tracker = open_tracker("replay:" + file.string() + "?rate=10", {});
  const std::vector<ProbeSample> samples = poll_until(*tracker, 5, 100);
  REQUIRE(samples.size() == 3);
  CHECK(samples[2].time_s == Approx(0.2));
  CHECK(tracker->recording()->assumed_rate_hz == 10.0);
  CHECK_THROWS_WITH(open_tracker("replay:" + file.string(), {}), Contains("no Timestamp"));
  CHECK_THROWS_WITH(open_tracker("replay:" + file.string() + "?rate=0", {}), Contains("rate"));
}

TEST_CASE("frames are sorted by their times within 50 ms, counted, and refused beyond") {
  const auto frame = [](const std::string& time, int x) {
    return at(time, {transform("ProbeToTracker", moved(x, 0))});
  };
  const Sequence sequence = parse_sequence(text_of({frame("1", 0), frame("1.06", 1), frame("1.02", 2)}), "log");
  CHECK(sequence.frames_out_of_order == 1);
  CHECK(sequence.worst_disorder_s == Approx(0.04));
  CHECK(sequence.frames[1].number == 2);
  const ProbeTrack track = probe_track(sequence);
  CHECK(track.samples[1].time_s == 1.02);
  CHECK(track.samples[1].patient_from_probe.translation.x == 2);
  CHECK(track.repairs.frames_out_of_order == 1);
  CHECK_THAT(refusal(text_of({frame("1", 0), frame("1.06", 1), frame("1.009", 2)})),
             Contains("frame 2: its Timestamp lies before that of the frame before it (1.0089999999999999 s after"));
  CHECK_THAT(refusal(text_of({frame("1", 0), frame("1.06", 1), frame("1", 2)})), Contains("lies before"));
  CHECK_THAT(refusal(text_of({frame("1", 0), frame("1.03", 1), frame("1", 2)})),
             Contains("frame 2: its Timestamp repeats"));
}
