// insonate-devices with the real hidapi and libusb, on a machine whose devices the test makes up.
#include "mocked_hid.h"
#include "mocked_usb.h"
#include "testbed.h"
#include <catch2/catch.hpp>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "devices/hydra/hydra_report.h"
#include "devices/polhemus/polhemus_stream.h"
#include "devices/record/recording_files.h"
#include "devices/replay/raw_replay.h"
#include "devices/sequence/probe_samples.h"
#include "sim/files/files.h"
#include "tests/devices/numbered_reports.h"
#include "tests/devices/test_samples.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

const MockedHid::Identity kHydra{0x1532, 0x0300, "Razer Hydra", "A1"};
const MockedUsb::Identity kViper{0x0f44, 0xbf01, "V7", 0x02, 0x81};

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

/// Whether this machine can have a test bed; says why not.
bool possible() {
  static const std::string why_not = Testbed::why_not();
  if (!why_not.empty()) std::printf("skipped: %s\n", why_not.c_str());
  return why_not.empty();
}

std::string output_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{INSONATE_DEVICES_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Child child(command);
  CHECK(pump([&] {
    child.listen();
    return child.ended();
  }));
  child.listen();
  return child.out;
}

/// `watch` of a tracker, in a test bed.
struct Watch {
  explicit Watch(const std::string& uri) : child({INSONATE_DEVICES_PROGRAM, "watch", uri}) {}
  Watch(const std::string& uri, const std::string& record, const std::string& record_raw)
      : child({INSONATE_DEVICES_PROGRAM, "watch", uri, "--record", record, "--record-raw", record_raw}) {}

  bool until(
      const std::function<bool()>& done, const std::function<void()>& each_time = [] {}) {
    const bool came = pump(
        [&] {
          child.listen();
          return done();
        },
        each_time);
    CAPTURE(child.out, child.err);
    CHECK(came);
    return came;
  }
  bool until_told(const std::string& words) {
    return until([&] { return contains(child.err, words); });
  }

  Child child;
};

}  // namespace

TEST_CASE("a Hydra is listed with its serial number") {
  if (!possible()) return;
  Testbed testbed;
  CHECK(contains(output_of({"list"}), "no tracker that is known here"));
  MockedHid hydra(testbed, kHydra, 0);
  const std::string listed = output_of({"list"});
  CHECK(contains(listed, "Razer Hydra"));
  CHECK(contains(listed, "1532:0300"));
  CHECK(contains(listed, "/dev/hidraw0"));
  CHECK(contains(listed, "serial A1"));
}

TEST_CASE("a Hydra that is plugged in late is started, and each of its reports comes once and in order") {
  if (!possible()) return;
  Testbed testbed;
  Watch watch("hydra:?raw=1");
  REQUIRE(watch.until_told("The Razer Hydra is not plugged in."));
  MockedHid hydra(testbed, kHydra, 0);
  REQUIRE(watch.until([&] { return !hydra.features().empty(); }));
  const auto start = hydra_mode(true);
  CHECK(hydra.features()[0] == Report(start.begin(), start.end()));

  std::deque<Report> reports;
  for (int x = 1; x <= 400; ++x) reports.push_back(hydra_report(x));
  REQUIRE(watch.until([&] { return places(watch.child.out).size() >= 400; }, [&] { hydra.send(reports); }));
  CHECK(places(watch.child.out) == counted(1, 400));

  // Corrupt, cut and repeated: none becomes a sample, and people are informed.
  Report corrupt = hydra_report(401), cut = hydra_report(402);
  corrupt[8] ^= 1;
  cut.resize(30);
  reports = {corrupt, cut, hydra_report(400), hydra_report(403)};
  REQUIRE(watch.until([&] { return places(watch.child.out).size() >= 401; }, [&] { hydra.send(reports); }));
  CHECK(places(watch.child.out).back() == 403);
  watch.until_told("were damaged or lost");
}

TEST_CASE("a Hydra that is pulled out is missed, and goes on when it is plugged in again") {
  if (!possible()) return;
  Testbed testbed;
  auto hydra = std::make_unique<MockedHid>(testbed, kHydra, 0);
  Watch watch("hydra:?raw=1");
  std::deque<Report> reports = {hydra_report(1), hydra_report(2)};
  REQUIRE(watch.until([&] { return places(watch.child.out).size() == 2; }, [&] { hydra->send(reports); }));
  hydra->pull();
  REQUIRE(watch.until_told("was lost"));
  hydra.reset();
  REQUIRE(watch.until_told("The Razer Hydra is not plugged in."));
  REQUIRE(watch.until([&] { return contains(watch.child.out, "missing"); }));

  hydra = std::make_unique<MockedHid>(testbed, kHydra, 1);
  REQUIRE(watch.until([&] { return !hydra->features().empty(); }));
  reports = {hydra_report(3)};
  REQUIRE(watch.until([&] { return places(watch.child.out).size() == 3; }, [&] { hydra->send(reports); }));
  CHECK(places(watch.child.out) == counted(1, 3));
}

TEST_CASE("what a Hydra sent until the program was killed replays to the samples that were recorded, to the bit") {
  if (!possible()) return;
  const fs::path folder = fs::temp_directory_path() / ("insonate_mocked_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const fs::path poses = folder / "run.igs.mha", raw = folder / "run.raw";
  {
    Testbed testbed;
    auto hydra = std::make_unique<MockedHid>(testbed, kHydra, 0);
    Watch watch("hydra:", poses, raw);
    Report corrupt = hydra_report(7);
    corrupt[8] ^= 1;
    std::deque<Report> reports;
    for (int x = 1; x <= 100; ++x) reports.push_back(x == 7 ? corrupt : hydra_report(x));
    REQUIRE(watch.until([&] { return places(watch.child.out).size() >= 99; }, [&] { hydra->send(reports); }));
    hydra->pull();
    REQUIRE(watch.until([&] { return contains(watch.child.out, "missing"); }));
    hydra = std::make_unique<MockedHid>(testbed, kHydra, 1);
    reports = {hydra_report(120)};
    REQUIRE(watch.until([&] { return places(watch.child.out).size() >= 100; }, [&] { hydra->send(reports); }));
    // Its file is appended to behind the line that it printed.
    REQUIRE(watch.until([&] { return contains(read_file(working_file(poses)), "Seq_Frame0101_"); }));
  }
  const std::size_t recorded = recover_recording(poses);
  CHECK(recorded >= 101);
  const std::vector<ProbeSample> came = read_recorded_scan(poses).samples;
  std::vector<ProbeSample> replayed = parse_raw(read_file(raw), raw).samples;
  REQUIRE(replayed.size() >= recorded);
  replayed.resize(recorded);
  CHECK(same_bits(replayed, came));
  fs::remove_all(folder);
}

TEST_CASE("a Hydra that may not be opened is reported with the rule, and used as soon as it may") {
  if (!possible()) return;
  Testbed testbed;
  MockedHid hydra(testbed, kHydra, 0);
  hydra.node().allow(false);
  Watch watch("hydra:?raw=1");
  REQUIRE(watch.until_told(R"(ATTRS{idVendor}=="1532", ATTRS{idProduct}=="0300")"));
  CHECK(contains(watch.child.err, "tools/install-udev-rule"));
  hydra.node().allow(true);
  REQUIRE(watch.until([&] { return !hydra.features().empty(); }));
}

TEST_CASE("of two Hydras the one with the serial number is used") {
  if (!possible()) return;
  Testbed testbed;
  MockedHid first(testbed, kHydra, 0), second(testbed, {0x1532, 0x0300, "Razer Hydra", "B2"}, 1);
  Watch watch("hydra:B2?raw=1");
  REQUIRE(watch.until([&] { return !second.features().empty(); }));
  CHECK(first.features().empty());
  Watch other("hydra:C3");
  other.until_told("No Razer Hydra has the serial number C3: plugged in is A1, B2.");
}

TEST_CASE("a Viper is listed, set up, and its frames come whole however the transfers cut them") {
  if (!possible()) return;
  Testbed testbed;
  Watch watch("polhemus:?sensor=2&raw=1");
  REQUIRE(watch.until_told("The Polhemus tracker is not plugged in."));
  MockedUsb viper(testbed, kViper, 4);
  REQUIRE(watch.until([&] { return viper.received().size() == 2; }));
  CHECK(viper.received()[0] == viper::command(viper::kUnits, viper::kSet, {2, 2}));
  CHECK(viper.received()[1] == viper::command(viper::kContinuous, viper::kSet));

  Report stream;
  for (int x = 1; x <= 100; ++x) {
    const Report frame = viper_frame(x);
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  Report corrupt = viper_frame(101);
  corrupt[30] ^= 1;
  stream.insert(stream.end(), corrupt.begin(), corrupt.end());
  const Report last = viper_frame(102);
  stream.insert(stream.end(), last.begin(), last.end());
  for (std::size_t begin = 0; begin < stream.size(); begin += 37)
    viper.send(
        {stream.begin() + std::ptrdiff_t(begin), stream.begin() + std::ptrdiff_t(std::min(begin + 37, stream.size()))});
  REQUIRE(watch.until([&] { return places(watch.child.out).size() >= 101; }));
  std::vector<int> expected = counted(1, 100);
  expected.push_back(102);
  CHECK(places(watch.child.out) == expected);
  watch.until_told("were damaged or lost");

  const std::string listed = output_of({"list"});
  CHECK(contains(listed, "Polhemus Viper"));
  CHECK(contains(listed, "serial V7"));
}

TEST_CASE("a Viper that is pulled out in mid-transfer is missed, and goes on when it is plugged in again") {
  if (!possible()) return;
  Testbed testbed;
  auto viper = std::make_unique<MockedUsb>(testbed, kViper, 4);
  Watch watch("polhemus:V7?sensor=2&raw=1");
  viper->send(viper_frame(1));
  REQUIRE(watch.until([&] { return places(watch.child.out).size() == 1; }));
  viper->pull();
  REQUIRE(watch.until_told("was lost"));
  viper.reset();
  REQUIRE(watch.until_told("The Polhemus tracker is not plugged in."));
  viper = std::make_unique<MockedUsb>(testbed, kViper, 5);
  viper->send(viper_frame(2));
  REQUIRE(watch.until([&] { return places(watch.child.out).size() == 2; }));
  CHECK(places(watch.child.out) == counted(1, 2));
}

TEST_CASE("a Viper that may not be opened, and one that waits for its firmware, are reported as such") {
  if (!possible()) return;
  Testbed testbed;
  {
    MockedUsb viper(testbed, kViper, 4);
    viper.node().allow(false);
    Watch watch("polhemus:");
    watch.until_told(R"(SUBSYSTEM=="usb", ATTR{idVendor}=="0f44", ATTR{idProduct}=="bf01")");
    viper.node().allow(true);
    watch.until([&] { return viper.received().size() == 2; });
  }
  MockedUsb waiting(testbed, {0x0f44, 0x0001, "", 0x02, 0x81}, 5);
  Watch watch("polhemus:");
  watch.until_told("waits for its firmware");
}

TEST_CASE("a Viper that another program has is reported as busy, and used as soon as it is free") {
  if (!possible()) return;
  Testbed testbed;
  MockedUsb viper(testbed, kViper, 4);
  viper.claim_elsewhere(true);
  Watch watch("polhemus:");
  REQUIRE(watch.until_told("is in use: close the other program that has it"));
  CHECK(viper.received().empty());
  viper.claim_elsewhere(false);
  REQUIRE(watch.until([&] { return viper.received().size() == 2; }));
}

TEST_CASE("a SpaceMouse moves the probe when it is there, and is taken when nothing better is") {
  if (!possible()) return;
  Testbed testbed;
  Watch watch("auto:");
  REQUIRE(watch.until_told("No tracker that is known here is plugged in."));
  MockedHid mouse(testbed, {0x256f, 0xc635, "SpaceMouse Compact", ""}, 0);
  // Pushed left at full travel, again and again, as a cap that is held there.
  std::deque<Report> reports;
  const auto push = [&] {
    if (reports.empty()) reports.push_back({1, 0xa2, 0xfe, 0, 0, 0, 0});
    mouse.send(reports);
  };
  REQUIRE(watch.until([&] { return !places(watch.child.out).empty() && places(watch.child.out).back() >= 20; }, push));
  // Every sample is at most the longest that a push lasts after the one before: 6 mm.
  const std::vector<int> path = places(watch.child.out);
  for (std::size_t i = 1; i < path.size(); ++i) CHECK(path[i] - path[i - 1] <= 7);
}
