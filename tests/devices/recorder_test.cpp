// Recordings: what comes back of them, when the run ends and when it is killed.
#include <catch2/catch.hpp>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "devices/record/append_only.h"
#include "devices/record/recording_files.h"
#include "devices/record/sequence_recorder.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence_file.h"
#include "devices/synthetic/synthetic_tracker.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "tests/core/system_faults.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/test_samples.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A folder of its own for a test.
struct Folder : TemporaryFolder {
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }
};

/// A hand's samples; some are not ok, and some have buttons held.
std::vector<ProbeSample> hand(double seconds = 10) {
  SyntheticTracker tracker(7, 60, {});
  std::vector<ProbeSample> samples = poll_until(tracker, seconds, 30);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % 50 == 7) samples[i].buttons = 5;
    if (i % 3 > 0) samples[i].distortion = std::uint32_t(i);
    if (i % 97 == 5) samples[i].status = PoseStatus::out_of_view;
    if (i % 41 == 9) {
      samples[i].status = PoseStatus::invalid;
      samples[i].rejected = Rejection(i % 4);
    }
    if (samples[i].status != PoseStatus::ok) samples[i].patient_from_probe = Pose{};
  }
  return samples;
}

constexpr int kWidth = 12, kHeight = 7;

Image<std::uint8_t> picture(std::size_t index) {
  Image<std::uint8_t> made(kWidth, kHeight);
  for (std::size_t i = 0; i < made.pixels.size(); ++i)
    made.pixels[i] = std::uint8_t(hash(std::uint32_t(index), std::uint32_t(i)));
  return made;
}

const glm::dmat4 kProbeFromPixel(0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, -3, 0.25, 0, 1);

std::vector<ProbeSample> read_samples(const fs::path& file) {
  return probe_samples(parse_sequence(read_file(file), file.string()));
}

/// All pictures of a file one after the other.
std::vector<std::uint8_t> read_pictures(const fs::path& file) {
  const std::string bytes = read_file(file);
  const Sequence sequence = parse_sequence(bytes, file.string());
  REQUIRE(sequence.has_images);
  std::vector<std::uint8_t> pixels(sequence.frames.size() * kWidth * kHeight + 1);
  uLongf size = pixels.size();
  // Z_OK also says that the stream's own checksum holds.
  REQUIRE(uncompress(pixels.data(), &size, reinterpret_cast<const Bytef*>(bytes.data() + sequence.image_offset),
                     uLong(bytes.size() - sequence.image_offset)) == Z_OK);
  REQUIRE(sequence.image_offset + sequence.image_bytes == bytes.size());
  pixels.resize(size);
  return pixels;
}

std::vector<std::uint8_t> pictures(std::size_t count) {
  std::vector<std::uint8_t> pixels;
  for (std::size_t i = 0; i < count; ++i) {
    const auto one = picture(i).pixels;
    pixels.insert(pixels.end(), one.begin(), one.end());
  }
  return pixels;
}

void record(const fs::path& file, const std::vector<ProbeSample>& samples, bool with_pictures) {
  SequenceRecorder recorder(file, with_pictures ? kWidth : 0, with_pictures ? kHeight : 0);
  for (std::size_t i = 0; i < samples.size(); ++i)
    with_pictures ? recorder.add(samples[i], picture(i), kProbeFromPixel) : recorder.add(samples[i]);
  recorder.finish();
}

void cut(const fs::path& file, std::size_t bytes) {
  fs::resize_file(file, bytes);
}

/// The working files of a recording that was never finished: a child process is killed once it has flushed `flushed`
/// samples and added a few more.
void record_and_be_killed(const fs::path& file, const std::vector<ProbeSample>& samples, std::size_t flushed,
                          bool with_pictures) {
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    SequenceRecorder recorder(file, with_pictures ? kWidth : 0, with_pictures ? kHeight : 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i == flushed) {
        recorder.flush();
        if (write(ready[1], "x", 1) != 1) _exit(1);
      }
      with_pictures ? recorder.add(samples[i], picture(i), kProbeFromPixel) : recorder.add(samples[i]);
    }
    for (;;) pause();
  }
  char byte;
  REQUIRE(read(ready[0], &byte, 1) == 1);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  close(ready[0]);
  close(ready[1]);
}

}  // namespace

TEST_CASE("a recording of poses is the file that would be written at once") {
  const Folder folder;
  const auto samples = hand();
  record(folder.path / "a" / "scan.igs.mha", samples, false);  // in a folder that is not there yet
  CHECK(read_file(folder.path / "a" / "scan.igs.mha") == write_sequence(samples));
  CHECK(same_bits(read_samples(folder.path / "a" / "scan.igs.mha"), samples));
  CHECK(std::distance(fs::directory_iterator(folder.path / "a"), fs::directory_iterator()) == 1);
}

TEST_CASE("a recording with pictures gives back poses and pixels to the bit, and where the pixels lie") {
  const Folder folder;
  const auto samples = hand(3);
  const fs::path file = folder.path / "scan.igs.mha";
  record(file, samples, true);
  CHECK(same_bits(read_samples(file), samples));
  CHECK(read_pictures(file) == pictures(samples.size()));
  const Sequence sequence = parse_sequence(read_file(file), "scan");
  const SequenceTransform* place = sequence.frames[3].find(sequence.find("ImageToProbe"));
  REQUIRE(place);
  CHECK(place->status == PoseStatus::ok);
  CHECK(place->matrix == kProbeFromPixel);
  CHECK(folder.files() == 1);
}

TEST_CASE("a recording that is killed keeps everything it had flushed") {
  const Folder folder;
  const auto samples = hand(3);
  for (const bool with_pictures : {false, true}) {
    CAPTURE(with_pictures);
    const fs::path file = folder.path / (with_pictures ? "pictures.igs.mha" : "poses.igs.mha");
    record_and_be_killed(file, samples, 100, with_pictures);
    CHECK_FALSE(fs::exists(file));
    CHECK_THROWS_WITH(SequenceRecorder(file), Catch::Contains("insonate-devices recover"));
    CHECK(recover_recording(file) == 100);
    CHECK(same_bits(read_samples(file), {samples.begin(), samples.begin() + 100}));
    if (with_pictures) CHECK(read_pictures(file) == pictures(100));
  }
  CHECK(folder.files() == 2);
}

TEST_CASE("a recording that is still running is not recovered, nor recorded over") {
  const Folder folder;
  const fs::path file = folder.path / "scan.igs.mha";
  SequenceRecorder recorder(file);
  recorder.add(hand(1)[0]);
  recorder.flush();
  CHECK_THROWS_WITH(recover_recording(file), Catch::Contains("still being recorded to"));
  CHECK_THROWS_WITH(SequenceRecorder(file), Catch::Contains("another recording is under way"));
  CHECK_FALSE(fs::exists(file));
  recorder.add(hand(1)[1]);
  recorder.finish();
  CHECK(read_samples(file).size() == 2);
}

TEST_CASE("working files beside the very file that they make are removed, and beside any other they stay") {
  const Folder folder;
  const auto samples = hand(3);
  for (const bool with_pictures : {false, true})
    for (const bool pictures_are_gone : {false, true}) {
      CAPTURE(with_pictures, pictures_are_gone);
      const fs::path file = folder.path / "scan.igs.mha", kept = folder.path / "kept.igs.mha";
      record_and_be_killed(file, samples, 50, with_pictures);
      for (const auto& name : {working_file, images_file})
        if (fs::exists(name(file))) fs::copy_file(name(file), name(kept));
      CHECK(recover_recording(kept) == 50);
      const std::string whole = read_file(kept);
      if (pictures_are_gone) fs::remove(images_file(file));

      std::string other = whole;
      other[other.size() / 3] ^= 1;
      write_file(file, other);
      CHECK_THROWS_WITH(recover_recording(file), Catch::Contains("such a file already"));
      CHECK(fs::exists(working_file(file)));

      write_file(file, whole);
      CHECK(recover_recording(file) == 50);
      CHECK(read_file(file) == whole);
      CHECK(folder.files() == 2);
      fs::remove(file);
      fs::remove(kept);
    }
}

TEST_CASE("what the disk has no room for leaves the file as it was, and may be written when there is some") {
  const Folder folder;
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    AppendOnlyFile file(folder.path / "some.txt");
    file.append("a line\n");
    rlimit before{}, narrow{};
    getrlimit(RLIMIT_FSIZE, &before);
    narrow = before;
    narrow.rlim_cur = 10;
    setrlimit(RLIMIT_FSIZE, &narrow);
    bool refused = false;
    try {
      file.append("another line\n");
    } catch (const InputError&) {
      refused = true;
    }
    const bool as_before = fs::file_size(file.path()) == 7 && file.size() == 7;
    setrlimit(RLIMIT_FSIZE, &before);
    file.append("another line\n");
    _exit(refused && as_before ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  CHECK(read_file(folder.path / "some.txt") == "a line\nanother line\n");
}

TEST_CASE("pictures that cannot be read as far as their size promises are refused, and nothing is removed") {
  const Folder folder;
  const fs::path file = folder.path / "scan.igs.mha";
  record_and_be_killed(file, hand(1), 10, true);
  fs::remove(images_file(file));
  fs::create_symlink(kShorterThanItClaims, images_file(file));
  CHECK_THROWS_WITH(recover_recording(file),
                    Catch::Contains("scan.igs.mha.recording.images: it cannot be read; check its permissions"));
  CHECK(fs::exists(working_file(file)));
  CHECK_FALSE(fs::exists(file));
}

TEST_CASE("what is whole of a recording stays if its file cannot be made") {
  const Folder folder;
  const fs::path file = folder.path / "scan.igs.mha";
  // A file beside it with a longer name cannot be made: names have at most 255 bytes.
  const fs::path long_name = folder.path / (std::string(232, 's') + ".igs.mha");
  record_and_be_killed(file, hand(1), 10, false);
  fs::copy_file(working_file(file), working_file(long_name));
  CHECK_THROWS_WITH(recover_recording(long_name),
                    Catch::Contains("s.igs.mha: it cannot be written (File name too long); check the folder's"));
  CHECK(fs::exists(working_file(long_name)));
  {
    // The recording and the new file can be opened, but not the recording once more.
    const NoFilesToOpen limit(2);
    CHECK_THROWS_WITH(
        recover_recording(file),
        Catch::Contains("scan.igs.mha.recording: it cannot be read again, or has changed meanwhile; close "
                        "other programs, and try again."));
  }
  CHECK_FALSE(fs::exists(file));
  CHECK(recover_recording(file) == 10);
}

TEST_CASE("a program that is only just dying is waited for") {
  const Folder folder;
  const fs::path file = folder.path / "scan.igs.mha";
  const auto samples = hand(1);
  record_and_be_killed(file, samples, 10, false);
  const int held = ::open(working_file(file).c_str(), O_RDONLY | O_CLOEXEC);
  REQUIRE(::flock(held, LOCK_EX | LOCK_NB) == 0);
  std::jthread death([held] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::close(held);
  });
  CHECK(recover_recording(file) == 10);
}

TEST_CASE("a pause of hours is recorded and read back, and a clock that was set is not recorded") {
  const Folder folder;
  const fs::path file = folder.path / "scan.igs.mha";
  std::vector<ProbeSample> samples = hand(1);
  for (std::size_t i = 30; i < samples.size(); ++i) samples[i].time_s += 5 * 3600;
  record(file, samples, false);
  CHECK(same_bits(read_samples(file), samples));
  SequenceRecorder recorder(folder.path / "set.igs.mha");
  recorder.add(samples[0]);
  samples[1].time_s = 1.7e9;
  CHECK_THROWS_AS(recorder.add(samples[1]), std::invalid_argument);
}

TEST_CASE("of a file with pictures only the header is kept, wherever its end falls among the pieces that are read") {
  const Folder folder;
  const auto samples = hand(1);
  const fs::path file = folder.path / "scan.igs.mha";
  record(file, samples, true);
  const std::string text = read_file(file);
  const std::size_t end = text.find("ElementDataFile");
  // Blank lines of a header mean nothing, so that it can be made any length; pieces have 1 MiB.
  for (const std::size_t header :
       {end + 24, std::size_t(1 << 20) - 5, std::size_t(1 << 20), std::size_t(1 << 20) + 9}) {
    CAPTURE(header);
    std::string longer = text;
    longer.insert(end, header - (end + 24), '\n');
    write_file(folder.path / "longer.igs.mha", longer);
    const SequenceFile read = read_sequence_file(folder.path / "longer.igs.mha");
    CHECK(read.size == longer.size());
    CHECK(read.digest == digest_of(longer));
    CHECK(read.front == longer.substr(0, read.front.size()));
    const Sequence sequence = parse_sequence(read.bytes(), "longer");
    CHECK(sequence.image_offset == header);
    CHECK(sequence.image_bytes == longer.size() - header);
    CHECK(same_bits(probe_samples(sequence), samples));
  }
}

TEST_CASE("working files that end anywhere are read up to their last whole frame") {
  const Folder folder;
  const auto all = hand(1);
  const std::vector<ProbeSample> samples(all.begin(), all.begin() + 4);
  const fs::path file = folder.path / "scan.igs.mha";
  record_and_be_killed(file, all, 4, true);
  const std::string text = read_file(working_file(file)), images = read_file(images_file(file));
  std::size_t recovered[5] = {};
  const auto recover = [&](std::size_t text_bytes, std::size_t image_bytes) {
    CAPTURE(text_bytes, image_bytes);
    fs::remove(file);
    write_file(working_file(file), text);
    write_file(images_file(file), images);
    cut(working_file(file), text_bytes);
    cut(images_file(file), image_bytes);
    std::size_t frames = 0;
    try {
      frames = recover_recording(file);
    } catch (const InputError&) {
      CHECK(fs::exists(working_file(file)));
      CHECK_FALSE(fs::exists(file));
    }
    ++recovered[frames];
    if (frames == 0) return;
    CHECK(same_bits(read_samples(file), {samples.begin(), samples.begin() + std::ptrdiff_t(frames)}));
    CHECK(read_pictures(file) == pictures(frames));
  };
  for (std::size_t bytes = 0; bytes <= text.size(); bytes += 5) recover(bytes, images.size());
  for (std::size_t bytes = 0; bytes <= images.size(); ++bytes) recover(text.size(), bytes);
  recover(text.size(), images.size());
  for (const std::size_t count : recovered) CHECK(count > 0);
}

TEST_CASE("a working file that is none, or was tampered with, is refused") {
  const Folder folder;
  const fs::path file = folder.path / "scan.igs.mha";
  const auto refusal = [&](const std::string& text) {
    write_file(working_file(file), text);
    try {
      recover_recording(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  CHECK_THROWS_WITH(recover_recording(file), Catch::Contains("there is no such file"));
  for (const char* text : {"x", "insonate recording 1\nframe 0 1\n", "insonate recording 1 -3 4\nframe 0 1\n",
                           "insonate recording 1 99999999 99999999\nframe 0 1\n", "insonate recording 2 0 0\n"})
    CHECK_THAT(refusal(text), Catch::Contains("not the working file"));
  for (const char* text : {"insonate recording 1 0 0\n", "insonate recording 1 0 0\nframe 7 1\n",
                           "insonate recording 1 0 0\nframe 0 99999999999\n", "insonate recording 1 4 4\nframe 9 1\n"})
    CHECK_THAT(refusal(text), Catch::Contains("no whole frame"));
}

TEST_CASE(
    "a recording overwrites nothing, takes no name that nobody would read, and leaves nothing when it was empty") {
  const Folder folder;
  const fs::path file = folder.path / "scan.igs.mha";
  CHECK_THROWS_WITH(SequenceRecorder(folder.path / "scan.txt"), Catch::Contains(".igs.mha"));
  { const SequenceRecorder nothing(file); }
  CHECK(folder.files() == 0);
  {
    SequenceRecorder recorder(file);
    recorder.add(hand(1)[0]);
    CHECK_THROWS_AS(recorder.add(hand(1)[0]), std::invalid_argument);  // the same time again
    ProbeSample crooked = hand(1)[1];
    crooked.status = PoseStatus::ok;
    crooked.patient_from_probe.rotation[0] *= 2;
    CHECK_THROWS_AS(recorder.add(crooked), std::invalid_argument);
    CHECK_THROWS_AS(recorder.add(hand(1)[1], picture(0), kProbeFromPixel), std::invalid_argument);
  }
  CHECK(read_samples(file).size() == 1);
  CHECK_THROWS_WITH(SequenceRecorder(file), Catch::Contains("already"));
  CHECK(read_samples(file).size() == 1);
  CHECK_THROWS_WITH(SequenceRecorder("/proc/none/scan.igs.mha"), Catch::Contains("cannot be written"));
}
