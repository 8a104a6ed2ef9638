// Sequence files of the NRRD flavour: as PLUS and 3D Slicer write them, and damaged.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"

using namespace insonate;

namespace {

const std::string kImages = "plus_images.seq.nrrd", kTransforms = "slicer_transforms.seq.nrrd";

std::string golden(const std::string& name) {
  return read_file(std::string(INSONATE_SEQUENCES_FOLDER) + "/" + name);
}

/// The sentence that comes of the bytes, or "" when they are taken.
std::string refusal(const std::string& bytes) {
  try {
    const auto samples = probe_samples(parse_sequence(bytes, "scan.seq.nrrd"));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      REQUIRE_FALSE(why_not_rigid(samples[i].patient_from_probe.matrix()));
      if (i > 0) REQUIRE(samples[i].time_s > samples[i - 1].time_s);
    }
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a compressed NRRD of PLUS with images: statuses, times since 1970, and the way on to the patient") {
  const Sequence sequence = parse_sequence(golden(kImages), kImages);
  CHECK(sequence.has_images);
  CHECK(sequence.image_offset + sequence.image_bytes == golden(kImages).size());
  const auto samples = probe_samples(sequence);
  REQUIRE(samples.size() == 5);
  const PoseStatus statuses[] = {PoseStatus::ok, PoseStatus::ok, PoseStatus::out_of_view, PoseStatus::missing,
                                 PoseStatus::ok};
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(samples[i].status == statuses[i]);
    CHECK(samples[i].time_s == Approx(1700000000.25 + 0.05 * double(i)).epsilon(1e-15));
  }
  // The header's TrackerToPatient moves by 100 mm.
  CHECK(samples[4].patient_from_probe.translation == glm::dvec3(113.25, -200.25, 30));
}

TEST_CASE("a raw NRRD of 3D Slicer with transforms alone, from zero on") {
  const Sequence sequence = parse_sequence(golden(kTransforms), kTransforms);
  CHECK_FALSE(sequence.has_images);
  const auto samples = probe_samples(sequence);
  REQUIRE(samples.size() == 3);
  CHECK(samples[0].time_s == 0);
  CHECK(samples[0].patient_from_probe.translation == glm::dvec3(0, 0, 3));
  CHECK(samples[1].status == PoseStatus::invalid);
  CHECK(samples[2].patient_from_probe.translation == glm::dvec3(2, -4, 3));
}

TEST_CASE("a NRRD's key says nothing of the field that is called the same") {
  const auto samples = probe_samples(parse_sequence(golden(kTransforms), kTransforms));
  std::string both = golden(kTransforms);
  const std::size_t second = both.find('\n') + 1;
  both.insert(second, "type:=a sequence\nsizes:=9 9 9\nencoding:=none\ndata file:=elsewhere.raw\n");
  const auto same = probe_samples(parse_sequence(both, kTransforms));
  REQUIRE(same.size() == samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) CHECK(same[i].time_s == samples[i].time_s);
}

TEST_CASE("a NRRD and a MetaImage of the same frames give the same samples") {
  std::string header = golden(kTransforms);
  std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = 0 0 3\nKinds = domain domain list\n";
  for (std::size_t at = 0; (at = header.find("Seq_Frame", at)) != std::string::npos;) {
    const std::size_t end = header.find('\n', at);
    std::string line = header.substr(at, end - at);
    meta += line.replace(line.find(":="), 2, " = ") + "\n";
    at = end;
  }
  meta += "ElementDataFile = LOCAL\n";
  const auto a = probe_samples(parse_sequence(golden(kTransforms), "a")), b = probe_samples(parse_sequence(meta, "b"));
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].time_s == b[i].time_s);
    CHECK(a[i].patient_from_probe == b[i].patient_from_probe);
  }
}

TEST_CASE("every NRRD that is damaged in a way people meet is refused with the place and the reason") {
  struct Damage {
    std::string what, by;
    std::vector<std::string> expected;
  };
  const std::vector<Damage> damages = {
      {"NRRD0005", "NRRD0001", {}},
      {"NRRD0005", "NRRD0009", {"line 1", "not an NRRD file of version 1 to 5"}},
      {"NRRD0005", "NRRD", {"line 1", "not an NRRD file of version 1 to 5"}},
      {"type: uint8", "type uint8", {"line 4", "not of the form"}},
      {"type: uint8", ": uint8", {"line 4", "not of the form"}},
      {"type: uint8", "type: block", {"type is 'block'"}},
      {"type: uint8", "type: uint8\ntype: uint8", {"line 5", "type is given a second time"}},
      {"dimension: 4", "dimension: 3", {"dimension is '3' and sizes '1 1 1 3'"}},
      {"sizes: 1 1 1 3", "sizes: 1 1 1 -3", {"sizes '1 1 1 -3'"}},
      {"sizes: 1 1 1 3", "sizes: 1 1 1 nan", {"sizes '1 1 1 nan'"}},
      {"sizes: 1 1 1 3", "sizes: 1 1 1 0", {"no frames"}},
      {"sizes: 1 1 1 3", "sizes: 1 1 1 2", {"2 frames", "frame 2"}},
      {"sizes: 1 1 1 3", "sizes: 1 1 1 4", {"truncated"}},
      {"sizes: 1 1 1 3", "sizes: 0 0 1 4", {"frame 3", "no Timestamp"}},
      {"sizes: 1 1 1 3", "sizes: 0 0 1 4000000000", {"4000000000 frames"}},
      {"sizes: 1 1 1 3", "sizes: 640 480 1 3", {"truncated", "3 bytes of 921600"}},
      {"sizes: 1 1 1 3", "sizes: 4000000000 4000000000 4000000000 3", {"more than any file holds"}},
      {"kinds: domain domain domain list", "kinds: domain list", {"kinds is 'domain list'", "4 dimensions"}},
      {"kinds: domain domain domain list", "kinds: list domain domain domain", {"1 frames"}},
      {"encoding: raw", "encoding: bzip2", {"encoding is 'bzip2'", "gzip or raw"}},
      {"encoding: raw", "data file: scan.raw", {"line 10", "'scan.raw'", "one .seq.nrrd"}},
      {"encoding: raw", "encoding: raw\nbyte skip: -1", {"byte skip is '-1'"}},
      {"Seq_Frame0001_Timestamp:=0.1", "Seq_Frame0001_Timestamp:=nan", {"frame 1", "'nan'"}},
      {"Seq_Frame0001_Timestamp:=0.1", "Seq_Frame0001_Timestamp:=0", {"frame 1", "repeats"}},
      {"Seq_Frame0001_Timestamp:=0.1", "Seq_FrameX_Timestamp:=0.1", {"names no frame"}},
      {"0.866025 2 0", "inf 2 0", {"frame 2", "not 16 finite numbers"}},
  };
  const std::string good = golden(kTransforms);
  REQUIRE(refusal(good).empty());
  for (const Damage& damage : damages) {
    std::string bytes = good;
    const std::size_t at = bytes.find(damage.what);
    REQUIRE(at != std::string::npos);
    bytes.replace(at, damage.what.size(), damage.by);
    const std::string sentence = refusal(bytes);
    CAPTURE(damage.what, damage.by, sentence);
    CHECK(sentence.empty() == damage.expected.empty());
    for (const std::string& words : damage.expected) CHECK(sentence.find(words) != std::string::npos);
  }
  std::string forged = golden(kImages);
  forged.replace(forged.find("sizes: 4 3 5"), 12, "sizes: 4 4 5");
  CHECK(refusal(forged).find("not a gzip stream of 80 bytes") != std::string::npos);
}

TEST_CASE("a NRRD cut short anywhere is refused") {
  for (const std::string& name : {kImages, kTransforms}) {
    const std::string bytes = golden(name);
    REQUIRE(refusal(bytes).empty());
    const std::size_t data = bytes.find("\n\n") + 2;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      CAPTURE(name, length);
      // Transforms alone are all in the header; their one pixel a frame may be missing as a whole.
      if (name == kTransforms && length >= data && length <= data + 2) continue;
      CHECK_FALSE(refusal(bytes.substr(0, length)).empty());
    }
  }
}

TEST_CASE("flipped bits of a NRRD are taken or refused, never worse") {
  int taken = 0, refused = 0;
  for (const std::string& name : {kImages, kTransforms}) {
    const std::string bytes = golden(name);
    for (std::uint32_t trial = 0; trial < 2000; ++trial) {
      std::string flipped = bytes;
      for (std::uint32_t i = 0; i <= hash(trial, 0) % 4; ++i)
        flipped[hash(trial, i + 1) % flipped.size()] ^= char(1 + hash(trial, i + 100) % 255);
      CAPTURE(name, trial);
      ++(refusal(flipped).empty() ? taken : refused);
    }
  }
  // Either would mean that the trials do not try anything.
  CHECK(taken > 200);
  CHECK(refused > 1000);
}
