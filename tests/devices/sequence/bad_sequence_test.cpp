// What happens to sequence files that are damaged, cut short or made up: a sentence, never a crash.
#include "sequence_promises.h"
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "devices/sequence/sequence_file.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/core/system_faults.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

const std::vector<std::string> kGolden = {"plus_images.igs.mha", "plus_compressed.igs.mha", "plus_transforms.igs.mha",
                                          "slicer_transforms.seq.mha", "itk_crlf.mha"};

std::string golden_bytes(const std::string& name) {
  return read_file(std::string(INSONATE_SEQUENCES_FOLDER) + "/" + name);
}

/// The sentence that comes of the bytes, or "" when they are taken.
std::string refusal(const std::string& bytes) {
  try {
    probe_samples(parse_sequence(bytes, "scan.igs.mha"));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

const std::string kGood =
    "ObjectType = Image\n"
    "NDims = 3\n"
    "BinaryData = True\n"
    "CompressedData = False\n"
    "DimSize = 0 0 2\n"
    "ElementType = MET_UCHAR\n"
    "Kinds = domain domain list\n"
    "Seq_Frame0000_ProbeToTrackerTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
    "Seq_Frame0000_ProbeToTrackerTransformStatus = OK\n"
    "Seq_Frame0000_Timestamp = 1.5\n"
    "Seq_Frame0001_ProbeToTrackerTransform = 1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n"
    "Seq_Frame0001_ProbeToTrackerTransformStatus = OK\n"
    "Seq_Frame0001_Timestamp = 2.5\n"
    "ElementDataFile = LOCAL\n";

struct Damage {
  std::string what, by;               ///< replaced in kGood
  std::vector<std::string> expected;  ///< words of the sentence
};

}  // namespace

TEST_CASE("every sequence file that is damaged in a way people meet is refused with the place and the reason") {
  REQUIRE(refusal(kGood).empty());
  const std::vector<Damage> damages = {
      {"ObjectType = Image\n", "", {}},  // what else is said first is still a MetaImage
      {"ObjectType = Image", "\x89PNG\r\n\x1a", {"line 1", "MetaImage", "give a sequence file"}},
      {"ObjectType = Image", "NRRD0004", {"line 2", "'name: value'"}},
      {"ObjectType = Image", "ObjectType = Mesh", {"header", "'Mesh' instead of an Image"}},
      {"ObjectType = Image", "", {}},
      {"NDims = 3\n", "", {"NDims is ''"}},
      {"NDims = 3", "NDims = 4", {"NDims is '4' and DimSize '0 0 2'"}},
      {"NDims = 3", "NDims = three", {"NDims is 'three'"}},
      {"NDims = 3", "NDims 3", {"line 2", "'NDims 3' is not of the form 'name = value'"}},
      {"NDims = 3", "NDims = 3\nNDims = 3", {"line 3", "NDims is given a second time"}},
      {"BinaryData = True", "BinaryData = False", {"image data is text"}},
      {"BinaryData = True", "BinaryData = maybe", {"BinaryData is 'maybe' instead of True or False"}},
      {"CompressedData = False", "CompressedData = 1", {"CompressedData is '1'"}},
      {"DimSize = 0 0 2\n", "", {"DimSize ''"}},
      {"DimSize = 0 0 2", "DimSize = 0 0", {"DimSize '0 0'"}},
      {"DimSize = 0 0 2", "DimSize = 0 0 -2", {"DimSize '0 0 -2'"}},
      {"DimSize = 0 0 2", "DimSize = 0 0 0", {"no frames"}},
      {"DimSize = 0 0 2", "DimSize = 0 0 1", {"1 frames", "frame 1"}},
      {"DimSize = 0 0 2", "DimSize = 0 0 3", {"frame 2", "no Timestamp"}},
      {"DimSize = 0 0 2", "DimSize = 0 0 4000000000", {"4000000000 frames", "frame 1"}},
      {"DimSize = 0 0 2", "DimSize = 100000 100000 100000", {"truncated", "1000000000000000 are there"}},
      {"DimSize = 0 0 2", "DimSize = 4000000000 4000000000 4000000000", {"more than any file holds"}},
      {"DimSize = 0 0 2", "DimSize = 99999999999999999999 1 2", {"DimSize '99999999999999999999 1 2'"}},
      {"DimSize = 0 0 2", "DimSize = 640 480 2", {"image data", "truncated", "0 bytes of 614400"}},
      {"ElementType = MET_UCHAR", "ElementType = MET_LARGE", {"ElementType is 'MET_LARGE'"}},
      {"Kinds = domain domain list", "Kinds = domain domain", {"Kinds is 'domain domain'", "3 dimensions"}},
      {"Kinds = domain domain list", "Kinds = domain domain domain", {"one of them is 'list'"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp = 1.5", {"frame 1", "Timestamp repeats", "1.5 s"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp = 0.5", {"frame 1", "Timestamp lies before"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp = 1.7e9", {"frame 1", "more than a day behind"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp = nan", {"frame 1", "'nan' instead of a finite"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp = inf", {"frame 1", "finite"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp = 1e999", {"frame 1", "finite"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp =", {"frame 1", "''"}},
      {"Seq_Frame0001_Timestamp = 2.5", "Seq_Frame0001_Timestamp = 2,5", {"frame 1", "'2,5'"}},
      {"Seq_Frame0001_Timestamp = 2.5\n", "", {"frame 1", "no Timestamp"}},
      {"Seq_Frame0001_Timestamp",
       "Seq_Frame0000_Timestamp",
       {"frame 0", "'Timestamp' is given a second time, in line 13"}},
      {"Seq_Frame0001_Timestamp", "Seq_Frame00x1_Timestamp", {"line 13", "names no frame"}},
      {"Seq_Frame0001_Timestamp", "Seq_Frame-001_Timestamp", {"line 13", "names no frame"}},
      {"Seq_Frame0001_Timestamp", "Seq_Frame0001_", {"line 13", "names no frame"}},
      {"Seq_Frame0001_Timestamp", "Seq_Frame0001", {"line 13", "names no frame"}},
      {"Seq_Frame0001_Timestamp", "Seq_Frame99999999999_Timestamp", {"line 13", "names no frame"}},
      {"Seq_Frame0001_Timestamp", "Seq_Frame4294967295_Timestamp", {"2 frames", "frame 4294967295"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 5 0 1 0 0 0 0 1 0 0 0 0", {"frame 1", "not 16 finite numbers"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 5 0 1 0 0 0 0 1 0 0 0 0 1 7", {"frame 1", "not 16 finite numbers"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " nan 0 1 0 0 0 0 1 0 0 0 0 1", {"frame 1", "not 16 finite numbers"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 5mm 0 1 0 0 0 0 1 0 0 0 0 1", {"frame 1", "not 16 finite numbers"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 5 0 0 0 0 0 0 1 0 0 0 0 1", {"frame 1", "ProbeToTracker", "singular"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 5 0 -1 0 0 0 0 1 0 0 0 0 1", {"frame 1", "mirrors"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 5 0 1.1 0 0 0 0 1 0 0 0 0 1", {"frame 1", "not orthonormal"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 5 0 1 0 0 0 0 1 0 0 0 0 2", {"frame 1", "last row"}},
      {" 5 0 1 0 0 0 0 1 0 0 0 0 1", " 1e9 0 1 0 0 0 0 1 0 0 0 0 1", {"frame 1", "reach"}},
      {"Seq_Frame0001_ProbeToTrackerTransform = 1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n", "", {"frame 1", "no matrix"}},
      {"Seq_Frame0001_ProbeToTrackerTransform =",
       "Seq_Frame0000_ProbeToTrackerTransform =",
       {"frame 0", "'ProbeToTrackerTransform' is given a second time, in line 11"}},
      {"Seq_Frame0001_ProbeToTrackerTransformStatus",
       "Seq_Frame0000_ProbeToTrackerTransformStatus",
       {"frame 0", "given a second time, in line 12"}},
      {"Seq_Frame0001_Timestamp",
       "Seq_Frame0001_Buttons = -1\nSeq_Frame0001_Timestamp",
       {"frame 1", "Buttons is '-1'"}},
      {"Seq_Frame0001_Timestamp",
       "Seq_Frame0001_Distortion = 2.5\nSeq_Frame0001_Timestamp",
       {"frame 1", "Distortion is '2.5'"}},
      {"Seq_Frame0001_Timestamp",
       "Seq_Frame0001_Distortion = 2\nSeq_Frame0001_Distortion = 2\nSeq_Frame0001_Timestamp",
       {"frame 1", "'Distortion' is given a second time"}},
      {"Seq_Frame0001_Timestamp",
       "Seq_Frame0001_Rejected = JUMP\nSeq_Frame0001_Rejected = JUMP\nSeq_Frame0001_Timestamp",
       {"frame 1", "'Rejected' is given a second time, in line 14"}},
      {"Seq_Frame0001_Timestamp",
       "Seq_Frame0001_Actions = freeze\nSeq_Frame0001_Actions = freeze\nSeq_Frame0001_Timestamp",
       {"frame 1", "'Actions' is given a second time, in line 14"}},
      {"Kinds", "TrackerToPatientTransform = 1 2 3\nKinds", {"line 7", "'TrackerToPatientTransform' is not 16"}},
      {"Kinds",
       "TrackerToPatientTransform = 2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1\nKinds",
       {"header", "TrackerToPatientTransform", "orthonormal"}},
      {"ElementDataFile = LOCAL\n", "", {"header", "does not end", "'ElementDataFile = ...' is missing"}},
      {"ElementDataFile = LOCAL", "ElementDataFile = scan.raw", {"line 14", "'scan.raw'", "one .igs.mha"}},
      {"ElementDataFile = LOCAL", "ElementDataFile =", {"line 14", "''"}},
      {"Kinds = ", "\x01\x02 = ", {"line 7", "not of the form"}},
  };
  for (const Damage& damage : damages) {
    std::string bytes = kGood;
    const std::size_t at = bytes.find(damage.what);
    REQUIRE(at != std::string::npos);
    bytes.replace(at, damage.what.size(), damage.by);
    const std::string sentence = refusal(bytes);
    CAPTURE(damage.what, damage.by, sentence);
    CHECK(sentence.empty() == damage.expected.empty());
    if (!sentence.empty()) CHECK(sentence.starts_with("scan.igs.mha: "));
    for (const std::string& words : damage.expected) CHECK(sentence.find(words) != std::string::npos);
  }
}

TEST_CASE("an image without frames, and frames without the probe, are refused with what there is") {
  std::string image = kGood;
  image.erase(image.find("Seq_Frame0000"), image.find("ElementDataFile") - image.find("Seq_Frame0000"));
  CHECK(refusal(image).find("plain image") != std::string::npos);

  std::string times = image;
  times.insert(times.find("ElementDataFile"), "Seq_Frame0000_Timestamp = 1.5\nSeq_Frame0001_Timestamp = 2.5\n");
  CHECK(refusal(times) ==
        "scan.igs.mha: its frames have no transforms, so it does not tell where the probe was; record it with a "
        "tracker, so that its frames have ProbeToTrackerTransform.");

  std::string stylus = kGood;
  for (std::size_t at; (at = stylus.find("ProbeToTracker")) != std::string::npos;) stylus.replace(at, 5, "Stylus");
  CHECK(refusal(stylus).find("it has StylusToTracker") != std::string::npos);
  CHECK_NOTHROW(probe_samples(parse_sequence(stylus, "scan"), "StylusToTracker"));
  try {
    probe_samples(parse_sequence(stylus, "scan"), "StylosToTracker");
    FAIL("taken");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).find("did you mean 'StylusToTracker'?") != std::string::npos);
  }
}

TEST_CASE("a file with more transforms than any tracker has is refused before it takes its time") {
  std::string bytes = kGood;
  std::string fields;
  for (int i = 0; i < 300; ++i) fields += "Seq_Frame0001_Tool" + std::to_string(i) + "ToTrackerTransform = 0\n";
  bytes.insert(bytes.find("ElementDataFile"), fields);
  CHECK(refusal(bytes).find("more than 256 different transforms") != std::string::npos);
}

TEST_CASE("a file cut short anywhere is refused") {
  for (const std::string& name : kGolden) {
    const std::string bytes = golden_bytes(name);
    REQUIRE(refusal(bytes).empty());
    const std::size_t data = bytes.find("ElementDataFile = LOCAL") + std::string("ElementDataFile = LOCAL").size();
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const std::string sentence = refusal(bytes.substr(0, length));
      CAPTURE(name, length);
      // A transform-only file says all that matters in its header; its one pixel a frame may be missing as a whole.
      const bool whole_header = length >= data;
      if (name == "plus_transforms.igs.mha" && whole_header && length <= data + 3) continue;
      CHECK_FALSE(sentence.empty());
    }
  }
}

TEST_CASE("a sequence file that the system does not read, or whose header does not end, is refused with its name") {
  const TemporaryFolder folder;
  const auto file = folder.put("scan.igs.mha", kGood);
  {
    const NoFilesToOpen limit;
    CHECK_THROWS_WITH(read_sequence_file(file), Catch::Contains("scan.igs.mha: it cannot be read; check"));
  }
  CHECK_THROWS_WITH(read_sequence_file(kUnreadable),
                    Catch::Contains(kUnreadable) && Catch::Contains("it cannot be read to its end; copy it again"));
  // The header is read in pieces of 1 MiB, and the limit holds from one piece to the next.
  const std::string endless = "ObjectType = Image\nComment = " + std::string(3 << 20, 'x');
  const auto long_file = folder.put("endless.igs.mha", endless + "\nElementDataFile = LOCAL\n");
  CHECK_THROWS_WITH(read_sequence_file(long_file, 2 << 20),
                    Catch::Contains("endless.igs.mha: header: it does not end within 2097152 bytes; check"));
  CHECK(read_sequence_file(long_file).size > endless.size());
}

TEST_CASE("flipped bits are taken or refused, with rigid poses at rising times where they are taken") {
  int taken = 0, refused = 0;
  for (const std::string& name : kGolden) {
    const std::string bytes = golden_bytes(name);
    for (std::uint32_t trial = 0; trial < 2000; ++trial) {
      std::string flipped = bytes;
      const std::uint32_t flips = 1 + hash(trial, 0) % 4;
      for (std::uint32_t i = 1; i <= flips; ++i)
        flipped[hash(trial, i) % flipped.size()] ^= char(1 + hash(trial, i + 100) % 255);
      CAPTURE(name, trial);
      REQUIRE(broken_sequence_promise(flipped) == "");
      try {
        const auto samples = probe_samples(parse_sequence(flipped, name));
        ++taken;
        REQUIRE(!samples.empty());
        REQUIRE(samples.size() < 100);
        for (std::size_t i = 0; i < samples.size(); ++i) {
          REQUIRE_FALSE(why_not_rigid(samples[i].patient_from_probe.matrix()));
          if (i > 0) REQUIRE(samples[i].time_s > samples[i - 1].time_s);
        }
      } catch (const InputError& error) {
        ++refused;
        // The sentence itself must be fit for a terminal.
        const std::string sentence = error.what();
        REQUIRE(std::none_of(sentence.begin(), sentence.end(), [](unsigned char c) { return c < ' '; }));
      }
    }
  }
  // Either would mean that the trials do not try anything.
  CHECK(taken > 500);
  CHECK(refused > 2000);
}

TEST_CASE("lines and numbers of any length are read in a time in proportion to them") {
  std::string bytes = kGood;
  bytes.insert(bytes.find("Kinds"), "Comment = " + std::string(1 << 20, 'x') + "\n");
  CHECK(refusal(bytes).empty());
  bytes = kGood;
  bytes.replace(bytes.find(" 5 0 1"), 2, " " + std::string(1 << 20, '5'));
  CHECK(refusal(bytes).find("frame 1") != std::string::npos);
  CHECK_FALSE(refusal(std::string(1 << 20, '\n')).empty());
  CHECK_FALSE(refusal(std::string(1 << 20, '\0')).empty());
}
