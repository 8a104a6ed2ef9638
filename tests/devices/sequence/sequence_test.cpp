#include "devices/sequence/sequence.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <string>

#include "devices/sequence/probe_samples.h"
#include "devices/synthetic/synthetic_tracker.h"
#include "sim/files/files.h"
#include "tests/devices/test_samples.h"

using namespace insonate;

namespace {

Sequence golden(const std::string& name) {
  return parse_sequence(read_file(std::string(INSONATE_SEQUENCES_FOLDER) + "/" + name), name);
}

glm::dmat3 turned(double degrees, const glm::dvec3& axis) {
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis));
}

}  // namespace

TEST_CASE("a sequence with images is read as PLUS writes it") {
  const Sequence sequence = golden("plus_images.igs.mha");
  CHECK(sequence.transform_names == std::vector<std::string>{"ProbeToTracker", "ReferenceToTracker"});
  CHECK(sequence.has_images);
  CHECK(sequence.image_bytes == 60);
  REQUIRE(sequence.frames.size() == 5);

  const std::vector<ProbeSample> samples = probe_samples(sequence, "ProbeToTracker");
  REQUIRE(samples.size() == 5);
  const PoseStatus statuses[] = {PoseStatus::ok, PoseStatus::ok, PoseStatus::out_of_view, PoseStatus::missing,
                                 PoseStatus::ok};
  for (int i = 0; i < 5; ++i) {
    const ProbeSample& sample = samples[std::size_t(i)];
    CAPTURE(i);
    CHECK(sample.time_s == Approx(12.25 + 0.05 * i));
    CHECK(sample.status == statuses[i]);
    if (sample.status != PoseStatus::ok) continue;
    CHECK(sample.patient_from_probe.translation == glm::dvec3(10.5 + i, -200.25, 30 + 0.125 * i));
    const Pose expected{turned(10 * i, {0, 0, 1}) * turned(5 * i, {1, 0, 0}), {}};
    // 16 digits stand in the file.
    CHECK(angle_between_deg(sample.patient_from_probe, expected) < 1e-12);
  }
}

TEST_CASE("a compressed sequence is read though its images are not, with times since 1970") {
  const Sequence sequence = golden("plus_compressed.igs.mha");
  CHECK(sequence.has_images);
  CHECK(sequence.image_offset + sequence.image_bytes ==
        read_file(std::string(INSONATE_SEQUENCES_FOLDER) + "/plus_compressed.igs.mha").size());
  const auto samples = probe_samples(sequence);
  REQUIRE(samples.size() == 4);
  CHECK(samples[0].status == PoseStatus::invalid);
  CHECK(samples[3].status == PoseStatus::ok);
  CHECK(samples[3].time_s == 1381234567.65);
}

TEST_CASE("a transform-only sequence is read as PLUS writes it, with a held switch as a button") {
  const Sequence sequence = golden("plus_transforms.igs.mha");
  CHECK_FALSE(sequence.has_images);
  const auto samples = probe_samples(sequence);
  REQUIRE(samples.size() == 4);
  CHECK(samples[0].buttons == 0);
  CHECK(samples[1].status == PoseStatus::switched);
  CHECK(samples[1].buttons == 2);
}

TEST_CASE("a transform-only sequence is read as 3D Slicer writes it, without its last line end") {
  const Sequence sequence = golden("slicer_transforms.seq.mha");
  CHECK_FALSE(sequence.has_images);
  const auto samples = probe_samples(sequence);
  REQUIRE(samples.size() == 3);
  CHECK(samples[1].status == PoseStatus::invalid);
  CHECK(samples[2].status == PoseStatus::ok);
  CHECK(samples[2].patient_from_probe.translation == glm::dvec3(2, -4, 3));
  // Six digits stand in the file; what they leave is made orthonormal.
  const Pose& pose = samples[2].patient_from_probe;
  CHECK(angle_between_deg(pose, {turned(60, {0, 1, 0}), {}}) < 1e-4);
  CHECK(glm::length((glm::transpose(pose.rotation) * pose.rotation)[0] - glm::dvec3(1, 0, 0)) < 1e-14);
}

TEST_CASE("an ITK header with CR LF, blank lines and fields of its own is read, and its calibration is chained") {
  const Sequence sequence = golden("itk_crlf.mha");
  CHECK(sequence.image_bytes == 16);
  const auto samples = probe_samples(sequence);
  REQUIRE(samples.size() == 2);
  // TrackerToPatient turns x to y and y to -x, and moves by (100, 200, 300).
  CHECK(glm::distance(samples[0].patient_from_probe.translation, glm::dvec3(100 - 2, 200 + 1, 300 + 3)) < 1e-12);
  CHECK(glm::distance(samples[1].patient_from_probe.translation, glm::dvec3(100 - 5, 200 + 4, 300 + 6)) < 1e-12);
  CHECK(glm::distance(samples[0].patient_from_probe.direction({1, 0, 0}), glm::dvec3(0, 1, 0)) < 1e-12);
}

TEST_CASE("what is written reads back to the same bits") {
  SyntheticTracker hand(5, 250, {});
  std::vector<ProbeSample> samples = poll_until(hand, 20, 10);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time_s += 1.7e9;
    samples[i].status = i % 17 == 3 ? PoseStatus(i / 17 % 7) : PoseStatus::ok;
    if (samples[i].status != PoseStatus::ok) samples[i].patient_from_probe = {};
    samples[i].buttons = i % 5 == 0 ? std::uint32_t(i * 0x9e3779b9u) : 0;
  }
  samples[1].patient_from_probe = Pose{glm::dmat3(1.0), {-0.0, 5e-324, 0.1}};
  const auto read = probe_samples(parse_sequence(write_sequence(samples), "written"));
  CHECK(same_bits(read, samples));
}

TEST_CASE("a sequence that nobody could read back is not written") {
  std::vector<ProbeSample> samples(2);
  samples[1].time_s = 1;
  CHECK_NOTHROW(write_sequence(samples));
  CHECK_THROWS_AS(write_sequence({}), std::invalid_argument);
  samples[1].time_s = 0;
  CHECK_THROWS_AS(write_sequence(samples), std::invalid_argument);
  samples[1] = {1, PoseStatus::ok, Pose{glm::dmat3(2.0), {}}, 0};
  CHECK_THROWS_AS(write_sequence(samples), std::invalid_argument);
}

TEST_CASE("the words for a status are read in any case and from any version, and an unheard one is unknown") {
  CHECK(status_from_igsio("OK") == PoseStatus::ok);
  CHECK(status_from_igsio("ok") == PoseStatus::ok);
  CHECK(status_from_igsio("TOOL_OUT_OF_VOLUME") == PoseStatus::out_of_volume);
  CHECK(status_from_igsio("TR_MISSING") == PoseStatus::missing);
  CHECK(status_from_igsio("REQ_TIMEOUT") == PoseStatus::missing);
  CHECK(status_from_igsio("SWITCH3_IS_ON") == PoseStatus::switched);
  CHECK(status_from_igsio("OKAY") == PoseStatus::unknown);
  CHECK(status_from_igsio("") == PoseStatus::unknown);
}

namespace {

/// A sequence of one frame a second with these lines for each, where %d stands for the frame.
std::string sequence_of(int frames, const std::string& header, std::vector<std::string> frame_fields) {
  std::string text = "ObjectType = Image\nNDims = 3\nDimSize = 0 0 " + std::to_string(frames) + "\n" + header;
  frame_fields.emplace_back("Timestamp = %d");
  for (int f = 0; f < frames; ++f)
    for (std::string field : frame_fields) {
      if (const auto at = field.find("%d"); at != std::string::npos) field.replace(at, 2, std::to_string(f));
      text += "Seq_Frame000" + std::to_string(f) + "_" + field + "\n";
    }
  return text + "ElementDataFile = LOCAL\n";
}

const std::string kAtX = " = 1 0 0 %d 0 1 0 0 0 0 1 0 0 0 0 1";

}  // namespace

TEST_CASE("the probe's transform is the one named, else to the patient, the reference or the tracker") {
  const std::string all = sequence_of(
      2, "",
      {"ProbeToTrackerTransform = 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1", "ProbeToTrackerTransformStatus = OK",
       "ProbeToReferenceTransform = 1 0 0 2 0 1 0 0 0 0 1 0 0 0 0 1", "ProbeToReferenceTransformStatus = OK",
       "ProbeToPatientTransform = 1 0 0 3 0 1 0 0 0 0 1 0 0 0 0 1", "ProbeToPatientTransformStatus = OK",
       "StylusToTrackerTransform = 1 0 0 4 0 1 0 0 0 0 1 0 0 0 0 1", "StylusToTrackerTransformStatus = OK"});
  const auto x = [&](const std::string& text, std::string_view transform) {
    return probe_samples(parse_sequence(text, "log"), transform)[0].patient_from_probe.translation.x;
  };
  const auto without = [](std::string text, const std::string& name) {
    for (std::size_t at; (at = text.find(name)) != std::string::npos;)
      text.replace(at, name.size(), "Not" + std::to_string(name.size()) + "ToBe");
    return text;
  };
  CHECK(x(all, "") == 3);
  CHECK(x(without(all, "ProbeToPatient"), "") == 2);
  CHECK(x(without(without(all, "ProbeToPatient"), "ProbeToReference"), "") == 1);
  // The tracker's frame leads on to the patient's, back along ProbeToTracker.
  CHECK(x(all, "StylusToTracker") == 4 - 1 + 3);
  CHECK(x(without(all, "ProbeToPatient"), "StylusToTrackerTransform") == 4);
}

TEST_CASE(
    "PLUS's single frame, whose header counts it but does not list it, and its colours, which it lists but does not "
    "count") {
  const std::string frame =
      "Seq_Frame0000_ProbeToTrackerTransform = 1 0 0 7 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0000_ProbeToTrackerTransformStatus = OK\nSeq_Frame0000_Timestamp = 1109.6\n"
      "Seq_Frame0000_ImageStatus = OK\nElementDataFile = LOCAL\n";
  const auto samples_of = [&](const std::string& head, const std::string& rest) {
    return probe_samples(parse_sequence("ObjectType = Image\n" + head + rest, "log"));
  };
  const std::string grey = "NDims = 3\nDimSize = 4                      3\nKinds = domain                  domain\n";
  const auto single = samples_of(grey, frame + std::string(12, 'x'));
  REQUIRE(single.size() == 1);
  CHECK(single[0].patient_from_probe.translation.x == 7);
  CHECK_THROWS_WITH(samples_of(grey, frame + std::string(11, 'x')), Catch::Contains("11 bytes of 12"));
  std::string second = frame;
  second.insert(0, "Seq_Frame0001_Timestamp = 1109.7\n");
  CHECK_THROWS_WITH(samples_of(grey, second + std::string(12, 'x')), Catch::Contains("1 frames"));

  const std::string colour =
      "NDims = 3\nElementNumberOfChannels = 3\nDimSize = 3 4 3      2\nKinds = vector domain domain list\n";
  std::string two = frame;
  two.insert(0, "Seq_Frame0001_Timestamp = 1109.7\n");
  CHECK(samples_of(colour, two + std::string(72, 'x')).size() == 2);
  CHECK_THROWS_WITH(samples_of(colour, two + std::string(71, 'x')), Catch::Contains("71 bytes of 72"));
  CHECK_THROWS_WITH(samples_of("NDims = 2\nDimSize = 4 3\n", frame), Catch::Contains("NDims is '2'"));
}

TEST_CASE("a chain is as good as its worse link") {
  const std::string text = sequence_of(
      3, "",
      {"ProbeToTrackerTransform" + kAtX, "ProbeToTrackerTransformStatus = OK",
       "TrackerToPatientTransform = 1 0 0 0 0 1 0 7 0 0 1 0 0 0 0 1", "TrackerToPatientTransformStatus = OK"});
  std::string lost = text;
  lost.replace(lost.find("Seq_Frame0001_TrackerToPatientTransformStatus = OK"),
               std::string("Seq_Frame0001_TrackerToPatientTransformStatus = OK").size(),
               "Seq_Frame0001_TrackerToPatientTransformStatus = OUT_OF_VIEW");
  const std::string probe_status = "Seq_Frame0000_ProbeToTrackerTransformStatus = ";
  lost.replace(lost.find(probe_status + "OK"), probe_status.size() + 2, probe_status + "MISSING");
  const auto samples = probe_samples(parse_sequence(lost, "log"));
  CHECK(samples[0].status == PoseStatus::missing);
  CHECK(samples[1].status == PoseStatus::out_of_view);
  CHECK(samples[2].status == PoseStatus::ok);
  CHECK(samples[2].patient_from_probe.translation == glm::dvec3(2, 7, 0));
}

TEST_CASE("a frame without a status is unknown, one without the transform is missing, and neither has a pose") {
  const std::string text = sequence_of(3, "", {"ProbeToTrackerTransform" + kAtX, "ProbeToTrackerTransformStatus = OK"});
  std::string changed = text;
  changed.erase(changed.find("Seq_Frame0001_ProbeToTrackerTransformStatus"),
                std::string("Seq_Frame0001_ProbeToTrackerTransformStatus = OK\n").size());
  const std::size_t begin = changed.find("Seq_Frame0002_");
  changed.erase(begin, changed.find("Seq_Frame0002_Timestamp") - begin);
  const auto samples = probe_samples(parse_sequence(changed, "log"));
  CHECK(samples[0].status == PoseStatus::ok);
  CHECK(samples[1].status == PoseStatus::unknown);
  CHECK(samples[1].patient_from_probe.translation == glm::dvec3(0));
  CHECK(samples[2].status == PoseStatus::missing);
}

TEST_CASE("a frame that is not OK may hold any matrix") {
  for (const char* matrix : {"0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0", "nan inf 0", "", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1"})
    for (const char* status : {"INVALID", "MISSING", "OUT_OF_VIEW", "SWITCH1_IS_ON", "whatever"}) {
      const auto samples =
          probe_samples(parse_sequence(sequence_of(1, "",
                                                   {std::string("ProbeToTrackerTransform = ") + matrix,
                                                    std::string("ProbeToTrackerTransformStatus = ") + status}),
                                       "log"));
      CHECK(samples[0].status != PoseStatus::ok);
      CHECK(samples[0].patient_from_probe.matrix() == glm::dmat4(1.0));
    }
}
