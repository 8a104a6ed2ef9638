// What a tracker's device sent, written down and replayed through the same parser.
#include "scripted_bus.h"
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "devices/auto/best_source.h"
#include "devices/calibrated_tracker.h"
#include "devices/crc16.h"
#include "devices/hydra/hydra_tracker.h"
#include "devices/igtl/igtl_message.h"
#include "devices/live/sample_conditioner.h"
#include "devices/polhemus/polhemus_tracker.h"
#include "devices/record/raw_recorder.h"
#include "devices/registry.h"
#include "devices/replay/raw_replay.h"
#include "devices/replay/read_log.h"
#include "devices/sequence/sequence.h"
#include "devices/spacemouse/spacemouse_tracker.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "tests/devices/golden_reports.h"
#include "tests/devices/raw_text.h"
#include "tests/devices/test_samples.h"

using namespace insonate;
using Report = ScriptedBus::Report;
namespace fs = std::filesystem;

namespace {

const AttachedDevice kHydra{0x1532, 0x0300, "Razer Hydra", "A1", "/dev/hidraw3", 0};
const AttachedDevice kMouse{0x256f, 0xc635, "", "", "/dev/hidraw0", 0};
const AttachedDevice kViper{0x0f44, 0xbf01, "", "V7", "bus 1, address 4", -1};
const Pose kStart{glm::mat3_cast(glm::angleAxis(0.5, glm::normalize(glm::dvec3(1, 2, 3)))), {10, -90, 30}};

template <std::size_t N>
Report bytes(const std::uint8_t (&array)[N]) {
  return {array, array + N};
}

Report hydra_report(int number) {
  Report report = bytes(golden::kHydra);
  report[7] = report[8] = std::uint8_t(number);
  const std::uint16_t crc = crc16_1021(Bytes(report).first(50), 0x1d0f);
  report[50] = std::uint8_t(crc);
  report[51] = std::uint8_t(crc >> 8);
  return report;
}

/// A file of its own for a test, which is not there yet.
struct File {
  fs::path path = fs::temp_directory_path() / ("insonate_raw_" + std::to_string(getpid()) + ".raw");
  File() { fs::remove(path); }
  ~File() { fs::remove(path); }
};

/// A source on a scripted bus, recorded, read as a live tracker's thread reads it but by the test's clock.
class Recorded {
public:
  template <typename Make>
  Recorded(const File& file, const std::string& uri, const FilterSettings& filters, const AttachedDevice& device,
           const Make& make)
      : recorder_(std::make_shared<RawRecorder>(file.path, uri, kStart)),
        conditioner_(filters),
        source_(make(bus, [this] { return now_s += 0.1 / 3; })) {
    bus->attached.devices = {device};
    source_->record_raw(recorder_);
    source_->open();
  }

  void read(const std::vector<Report>& reports) {
    bus->reports.assign(reports.begin(), reports.end());
    for (std::size_t i = 0; i < std::max<std::size_t>(reports.size(), 1); ++i) {
      LiveBatch batch;
      source_->read(std::chrono::milliseconds(20), batch);
      for (const ProbeSample& sample : batch.samples) publish(sample);
    }
  }
  void silence() {
    recorder_->silent(now_s);
    publish(silence_at(now_s));
  }
  void reopen() {
    source_->close();
    source_->open();
  }

  double now_s = 0.1;
  std::shared_ptr<ScriptedBus> bus = std::make_shared<ScriptedBus>();
  std::vector<ProbeSample> samples;

private:
  void publish(ProbeSample sample) {
    conditioner_.apply(sample, source_->origin());
    samples.push_back(sample);
  }
  std::shared_ptr<RawRecorder> recorder_;
  SampleConditioner conditioner_;
  std::unique_ptr<RawSource> source_;
};

const std::string kGood =
    "insonate raw 1\n"
    "tracker spacemouse:\n"
    "start 1 0 0 0 1 0 0 0 1 10 -90 40\n"
    "open 12.25 256f:c635\n"
    "read 12.5 015e0151ff0000\n"
    "read 12.75\n"
    "silent 13.5\n";

std::string refusal(const std::string& text) {
  try {
    parse_raw(text, "scan.raw");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a raw recording replays to the samples that came, to the bit, whatever was sent") {
  const File file;
  Recorded run(file, "hydra:A1", FilterSettings::usual(), kHydra, [](auto bus, auto clock) {
    return std::make_unique<HydraSource>(bus, "A1", 0, Placement(kStart, false), clock);
  });
  Report corrupt = hydra_report(5), cut = hydra_report(6);
  corrupt[9] ^= 1;
  cut.resize(20);
  run.read({hydra_report(1), hydra_report(2), corrupt, cut, hydra_report(2), hydra_report(9), {}, hydra_report(10)});
  run.now_s += 6;  // silent for so long that it is started again
  run.read({});
  run.silence();
  run.read({hydra_report(11)});
  run.reopen();
  run.read({hydra_report(4), hydra_report(5)});
  REQUIRE(run.samples.size() == 8);

  const RawScan scan = parse_raw(read_file(file.path), "scan.raw");
  CHECK(scan.tracker == "hydra:A1");
  CHECK(same_bits(scan.samples, run.samples));
  INFO("the filters were at work: without them it is another scan");
  std::string text = read_file(file.path);
  text.replace(text.find("hydra:A1"), 8, "hydra:A1?filter=off");
  CHECK_FALSE(same_bits(parse_raw(text, "scan.raw").samples, run.samples));

  INFO("through its URI it is a recorded scan");
  const auto tracker = open_tracker("raw:" + file.path.string());
  REQUIRE(tracker->recording());
  CHECK(tracker->recording()->transform == "reports of hydra:A1");
  CHECK(same_bits(poll_until(*tracker, 60, 10), run.samples));
  CHECK(tracker_identity("raw:" + file.path.string()) == TrackerIdentity{"raw", ""});
}

TEST_CASE("a raw recording is read wherever a log is, by its name or as a URI") {
  const File file;
  write_file(file.path, kGood);
  const std::vector<ProbeSample> samples = parse_raw(kGood, "scan.raw").samples;
  for (const std::string& named : {file.path.string(), "raw:" + file.path.string()}) {
    const RecordedScan scan = read_log(named);
    CHECK(same_bits(scan.samples, samples));
    CHECK(scan.recording.transform == "reports of spacemouse:");
    CHECK(scan.recording.digest == digest_of(kGood));
    CHECK_NOTHROW(check_is_of_probe(scan.recording));
    CHECK_THROWS_WITH(read_log(named, {.transform = "ProbeToTracker"}),
                      Catch::Contains("has no transforms to choose from"));
  }
  CHECK(is_raw_log(file.path));
  CHECK_THROWS_WITH(read_log("replay:" + file.path.string()), Catch::Contains(file.path.string()));

  const std::string sequence = write_sequence(samples);
  write_file(file.path, sequence);
  CHECK_FALSE(is_raw_log(file.path));
  for (const std::string& named : {file.path.string(), "replay:" + file.path.string()})
    CHECK(same_bits(read_log(named).samples, samples));
  CHECK_THROWS_WITH(read_log("raw:" + file.path.string()), Catch::Contains("does not begin with 'insonate raw 1'"));
  CHECK_THROWS_WITH(read_log("raw:/nowhere"), Catch::Contains("there is no such file"));
}

TEST_CASE("what was recorded through a calibration is the sensor's, and scored only through it") {
  const File file;
  Recorded run(file, "hydra:A1?raw=1&filter=off", FilterSettings(), kHydra, [](auto bus, auto clock) {
    return std::make_unique<HydraSource>(bus, "A1", 0, Placement(kStart, true), clock);
  });
  run.read({hydra_report(1), hydra_report(2)});
  const RecordedScan scan = read_log(file.path);
  CHECK_THROWS_WITH(check_is_of_probe(scan.recording), Catch::Contains("--calibration"));

  Calibration calibration;
  calibration.face = Dated<FaceSetup>{FaceSetup{{Pose{glm::dmat3(1.0), {0, 5, 0}}, 0, 0}, "touch", 0}, 0};
  calibration.mannequin = Dated<MannequinSetup>{MannequinSetup(), 0};
  calibration.mannequin->value.ct_from_mannequin = kStart;
  const RecordedScan of_probe = calibrated(scan, calibration, "lab.toml");
  CHECK_NOTHROW(check_is_of_probe(of_probe.recording));
  CHECK_THAT(of_probe.recording.transform, Catch::Contains("through lab.toml"));
  CalibratedTracker tracker(SensorTracker(open_tracker("raw:" + file.path.string())), calibration, "lab.toml");
  CHECK(tracker.recording()->transform == of_probe.recording.transform);
  CHECK_FALSE(tracker.recording()->of_sensor);
  CHECK(same_bits(poll_until(tracker, 60, 10), of_probe.samples));
  CHECK_FALSE(same_bits(of_probe.samples, scan.samples));
  CHECK_THROWS_AS(calibrated(scan, Calibration(), "x"), std::invalid_argument);
}

TEST_CASE("a rate and a stream that is cut anywhere replay to the bit too") {
  {
    const File file;
    Recorded run(file, "auto:?filter=off", FilterSettings(), kMouse, [](auto bus, auto clock) {
      std::vector<std::unique_ptr<RawSource>> sources;
      sources.push_back(std::make_unique<HydraSource>(bus, "", 0, Placement(kStart, false), clock));
      sources.push_back(std::make_unique<SpaceMouseSource>(bus, "", kStart, 1.0, clock));
      return std::make_unique<BestSource>(std::move(sources));
    });
    run.read({bytes(golden::kSpaceMousePush), {}, {}, {2, 94, 1, 0, 0, 0, 0}, {}, {3, 1}});
    REQUIRE(run.samples.size() == 6);
    CHECK(same_bits(parse_raw(read_file(file.path), "scan.raw").samples, run.samples));
  }
  const File file;
  Recorded run(file, "polhemus:?sensor=2&filter=off", FilterSettings(), kViper, [](auto bus, auto clock) {
    return std::make_unique<PolhemusSource>(bus, "", 1u, Placement(kStart, false), clock);
  });
  const Report frame = bytes(golden::kViper);
  run.read({{frame.begin(), frame.begin() + 11}, {frame.begin() + 11, frame.end()}, {'o', 'k'}});
  REQUIRE(run.samples.size() == 1);
  CHECK(same_bits(parse_raw(read_file(file.path), "scan.raw").samples, run.samples));
}

TEST_CASE("a raw recording of OpenIGTLink holds the stream, and ends a connection where it ended") {
  const Pose there{glm::dmat3(1.0), {1, 2, 3}};
  const std::string transform = hex(igtl::make_transform("Probe", 0, there));
  const std::string head = raw_igtl_head("igtl://somewhere?filter=off", 1);
  const RawScan scan =
      parse_raw(head + "read 2 " + transform.substr(0, 60) + "\nread 3 " + transform.substr(60) + transform +
                    "\nread 4 " + std::string(200, '7') + "\nopen 5 0000:0000\nread 6 " + transform + "\n",
                "scan.raw");
  REQUIRE(scan.samples.size() == 3);
  CHECK(scan.samples[0].time_s == 3);
  CHECK(scan.samples[2].time_s == 6);
  CHECK(scan.samples[2].patient_from_probe == there);
  CHECK_THAT(refusal(head + "read 4 " + std::string(200, '7') + "\nread 6 " + transform + "\n"),
             Catch::Contains("line 6: something is read, but no device is open"));
}

TEST_CASE("a raw recording that is damaged is refused with the place and the reason, and a cut last line is left out") {
  REQUIRE(refusal(kGood).empty());
  const std::size_t whole = parse_raw(kGood, "scan.raw").samples.size();
  REQUIRE(whole == 3);
  CHECK(parse_raw(kGood + "read 14 015e01", "scan.raw").samples.size() == whole);
  const struct {
    std::string what, by, expected;
  } damages[] = {
      {"insonate raw 1", "insonate raw 2", "line 1: it does not begin with 'insonate raw 1'"},
      {"tracker ", "", "line 2: 'spacemouse:' does not begin with 'tracker '"},
      {"spacemouse:", "spacemouse", "line 2: its tracker cannot be made again"},
      {"spacemouse:", "nothing:", "line 2: its tracker cannot be made again"},
      {"spacemouse:", "replay:x.igs.mha", "its samples do not come of a device's bytes"},
      {"spacemouse:", "raw:scan.raw", "its samples do not come of a device's bytes"},
      {"spacemouse:", "spacemouse:?speed=999", "option 'speed'"},
      {"spacemouse:", "spacemouse:?filter=x", "option 'filter'"},
      {"start 1 0", "start 2 0", "line 3: 'start' is not followed by the 12 numbers of a pose"},
      {"start 1 0", "start nan 0", "line 3: 'start'"},
      {"start 1 0", "start 1", "line 3: 'start'"},
      {"256f:c635", "256f-c635", "line 4: '256f-c635' are not USB numbers"},
      {"256f:c635", "256f:c63g", "are not USB numbers"},
      {"256f:c635", "1532:0300", "line 4: a device 1532:0300 is none of 'spacemouse:'"},
      {"open 12.25", "open inf", "line 4: 'open inf 256f:c635' is not an event with its time"},
      {"open 12.25", "close 12.25", "line 4: 'close 12.25 256f:c635' is none of"},
      {"open 12.25 256f:c635\n", "", "line 4: something is read, but no device is open"},
      {"12.75", "12.25", "line 6: its time lies before that of the line before it"},
      {"015e", "015", "line 5: what was read is not in pairs of hexadecimal digits"},
      {"015e", "01 5e", "line 5: 'read 12.5 01 5e"},
      {"015e", "015E", "line 5: what was read is not in pairs"},
      {"silent 13.5", "silent 13.5 1", "line 7: 'silent 13.5 1' is none of"},
      {"silent 13.5", "", "line 7: '' is not an event with its time"},
  };
  for (const auto& damage : damages) {
    std::string text = kGood;
    REQUIRE(text.find(damage.what) != std::string::npos);
    text.replace(text.find(damage.what), damage.what.size(), damage.by);
    CAPTURE(damage.what, damage.by);
    CHECK_THAT(refusal(text), Catch::Contains(damage.expected));
  }
  for (std::size_t length = 0; length < kGood.size(); ++length) {
    // Until the first sample is there nothing can be replayed; from then on, all whole lines.
    const bool any = length >= kGood.find("read 12.75");
    CAPTURE(length);
    CHECK(refusal(kGood.substr(0, length)).empty() == any);
  }
  CHECK(refusal(kGood.substr(0, 20)) == "scan.raw: line 2: the recording ends in its first lines; record it again.");
}

TEST_CASE("a raw recording with any bytes changed is refused or gives samples that can be recorded") {
  int taken = 0, refused = 0;
  for (std::uint32_t trial = 0; trial < 3000; ++trial) {
    std::string text = kGood;
    for (std::uint32_t i = 1; i <= 1 + hash(trial, 0) % 3; ++i)
      text[hash(trial, i) % text.size()] = "0123456789abcdef .:\n"[hash(trial, i + 100) % 20];
    CAPTURE(text);
    try {
      double before_s = -HUGE_VAL;
      for (const ProbeSample& sample : parse_raw(text, "scan.raw").samples) {
        REQUIRE(sample.time_s > before_s);
        REQUIRE_FALSE(why_not_rigid(sample.patient_from_probe.matrix()));
        before_s = sample.time_s;
      }
      ++taken;
    } catch (const InputError&) {
      ++refused;
    }
  }
  // Either would mean that the trials do not try anything.
  CHECK(taken > 100);
  CHECK(refused > 1000);
}

TEST_CASE("only what has a device is recorded raw, and into a new file") {
  const File file;
  for (const char* uri : {"synthetic:1", "synthetic:1?live=1", "mouse:"}) {
    const auto tracker = open_tracker(uri);
    CHECK_THROWS_WITH(record_raw(*tracker, file.path, uri), Catch::Contains("no device that sends bytes"));
  }
  CHECK_FALSE(fs::exists(file.path));
  const auto tracker = open_tracker("hydra:");
  CHECK(record_raw(*tracker, file.path, "hydra:", kStart)->problem().empty());
  CHECK_THAT(refusal(read_file(file.path)), Catch::Contains("nothing in it became a sample"));
  CHECK_THROWS_WITH(record_raw(*tracker, file.path, "hydra:"), Catch::Contains("cannot be written"));
}
