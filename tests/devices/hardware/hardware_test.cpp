// What trackers on a bus do, with a bus that the test holds in its hand.
#include "scripted_bus.h"
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <string>

#include "devices/auto/best_source.h"
#include "devices/crc16.h"
#include "devices/hydra/hydra_report.h"
#include "devices/hydra/hydra_tracker.h"
#include "devices/live/probe_buttons.h"
#include "devices/osvr/osvr_tracker.h"
#include "devices/polhemus/polhemus_tracker.h"
#include "devices/registry.h"
#include "devices/spacemouse/spacemouse_tracker.h"
#include "sim/core/input_error.h"
#include "tests/devices/golden_reports.h"

using namespace insonate;
using Report = ScriptedBus::Report;

namespace {

const AttachedDevice kHydra{0x1532, 0x0300, "Razer Hydra", "A1", "/dev/hidraw3", 0};
const AttachedDevice kViper{0x0f44, 0xbf01, "", "V7", "bus 1, address 4", -1};
const AttachedDevice kLiberty{0x0f44, 0xff20, "", "L2", "bus 1, address 5", -1};

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

template <std::size_t N>
Report bytes(const std::uint8_t (&array)[N]) {
  return {array, array + N};
}

/// The golden report with another sequence number and another place of the first handset (mm).
Report hydra_report(std::uint8_t sequence, std::int16_t x, std::uint8_t buttons = 0x80) {
  Report report = bytes(golden::kHydra);
  report[7] = sequence;
  report[8] = std::uint8_t(x);
  report[9] = std::uint8_t(x >> 8);
  report[22] = buttons;
  const std::uint16_t crc = crc16_1021(Bytes(report).first(50), 0x1d0f);
  report[50] = std::uint8_t(crc);
  report[51] = std::uint8_t(crc >> 8);
  return report;
}

Report liberty_record(std::uint8_t station, std::uint8_t frame, std::uint8_t distortion) {
  Report record = bytes(golden::kLiberty);
  record[2] = station;
  record[12] = frame;
  record[16] = distortion;
  return record;
}

/// A source on a scripted bus and a clock that the test moves.
template <typename Source>
struct Bench {
  template <typename... Arguments>
  explicit Bench(const Arguments&... arguments) : source(bus, "", arguments..., [this] { return now_s; }) {}

  /// Reads until nothing comes any more.
  LiveBatch read_all() {
    LiveBatch all;
    do {
      LiveBatch batch;
      source.read(std::chrono::milliseconds(20), batch);
      all.samples.insert(all.samples.end(), batch.samples.begin(), batch.samples.end());
      all.note = batch.note;
    } while (!bus->reports.empty());
    return all;
  }

  double now_s = 100;
  std::shared_ptr<ScriptedBus> bus = std::make_shared<ScriptedBus>();
  Source source;
};

std::string absent(const AttachedDevices& attached, const std::string& serial) {
  constexpr DeviceKind::Model models[] = {{0x1532, 0x0300, "Gadget"},
                                          {0x0f44, 0xbf01, "Gadget"},
                                          {0x0f44, 0x0001, "Gadget", "waits for its firmware", {}, false}};
  try {
    find_device({.name = "Gadget", .models = models, .interface_number = 0}, serial, attached);
    return "";
  } catch (const TransportError& error) {
    CHECK(error.fault() == TransportFault::absent);
    return error.what();
  }
}

const Pose kStart{glm::mat3_cast(glm::angleAxis(0.5, glm::normalize(glm::dvec3(1, 2, 3)))), {10, 20, 30}};

}  // namespace

TEST_CASE("a device is found by its numbers and its serial, and what is there instead is said") {
  AttachedDevice second = kHydra, mouse_part = kHydra, stranger = kHydra;
  second.serial = "B2";
  second.path = "/dev/hidraw5";
  mouse_part.interface_number = 1;
  mouse_part.path = "/dev/hidraw1";
  stranger.product = 1;
  constexpr DeviceKind::Model models[] = {{0x1532, 0x0300, "Gadget"}};
  const DeviceKind kind{.name = "Gadget", .models = models, .interface_number = 0};
  const AttachedDevices two{{stranger, mouse_part, kHydra, second}, ""};
  CHECK(find_device(kind, "", two).path == "/dev/hidraw3");
  CHECK(find_device(kind, "B2", two).path == "/dev/hidraw5");
  CHECK(absent(two, "C3") == "No Gadget has the serial number C3: plugged in is A1, B2.");
  CHECK(absent({{stranger, mouse_part}, ""}, "") == "The Gadget is not plugged in.");
  CHECK(contains(absent({{}, "no bus"}, ""), "no bus"));
  AttachedDevice waiting = kViper;
  waiting.product = 0x0001;
  CHECK(contains(absent({{waiting}, ""}, ""), "waits for its firmware"));
}

TEST_CASE("a device that may not be opened comes with the rule that allows it") {
  CHECK(contains(forbidden(kHydra).what(), R"(KERNEL=="hidraw*", ATTRS{idVendor}=="1532", ATTRS{idProduct}=="0300")"));
  CHECK(contains(forbidden(kViper).what(), R"(SUBSYSTEM=="usb", ATTR{idVendor}=="0f44", ATTR{idProduct}=="bf01")"));
  CHECK(contains(forbidden(kViper).what(), "tools/install-udev-rule"));
  CHECK(forbidden(kViper).fault() == TransportFault::forbidden);
  CHECK(contains(busy(kHydra).what(), "close the other program"));
}

TEST_CASE("reports are followed by the device's own numbers") {
  ReportTally tally;
  ReportNumbers numbers(256);
  for (const int number : {250, 251, 254, 255, 0, 1}) CHECK(numbers.is_new(std::uint64_t(number), tally));
  CHECK(tally.missed == 2);
  CHECK_FALSE(numbers.is_new(1, tally));
  CHECK(tally.repeated == 1);
  CHECK_FALSE(numbers.is_new(0, tally));
  CHECK(tally.late == 1);
  CHECK(numbers.is_new(2, tally));
  // A device that begins to count anew is believed after some reports, and nothing counts as missed.
  std::uint64_t number = 200;
  for (; !numbers.is_new(number, tally); ++number) REQUIRE(number < 210);
  CHECK(number == 207);
  CHECK(numbers.is_new(208, tally));
  CHECK(tally.missed == 2);
  CHECK(tally.late == 8);
  numbers.restart();
  CHECK(numbers.is_new(100, tally));
  CHECK(tally.missed == 2);
  CHECK(tally.incidents_in_words() == "1 repeated, 8 late, 2 missed");
}

TEST_CASE("a Hydra is started, begins where the probe does, and is let go as a gamepad") {
  Bench<HydraSource> bench(std::size_t{0}, Placement(kStart, false));
  bench.bus->attached.devices = {kHydra};
  bench.source.open();
  const auto poses = hydra_mode(true), gamepad = hydra_mode(false);
  REQUIRE(bench.bus->sent.size() == 1);
  CHECK(bench.bus->sent[0] == Report(poses.begin(), poses.end()));

  bench.bus->reports = {hydra_report(1, 100), hydra_report(2, 107, 0x80 | 1 | 4 | 8)};
  const LiveBatch batch = bench.read_all();
  REQUIRE(batch.samples.size() == 2);
  CHECK(batch.note.empty());
  CHECK(batch.samples[0].time_s == 100);
  CHECK(batch.samples[0].status == PoseStatus::ok);
  CHECK(glm::distance(batch.samples[0].patient_from_probe.translation, kStart.translation) < 1e-9);
  // Moved along the base's x; in the handset's frame that is what its rotation makes of it.
  const glm::dmat3 turned = glm::mat3_cast(glm::dquat(0.5, 0.5, -0.5, 0.5));
  const glm::dvec3 moved = kStart.rotation * (glm::transpose(turned) * glm::dvec3(7, 0, 0));
  CHECK(glm::distance(batch.samples[1].patient_from_probe.translation, kStart.translation + moved) < 1e-9);
  CHECK(batch.samples[0].buttons == 0);
  CHECK(batch.samples[1].buttons == (kFreezeButton | kEventMarkerButton | kContinueButton));

  bench.source.close();
  CHECK(bench.bus->sent.back() == Report(gamepad.begin(), gamepad.end()));
  CHECK(bench.bus->open_now == 0);
}

TEST_CASE("a Hydra's other handset, and the base's own frame, on demand") {
  Bench<HydraSource> bench(std::size_t{1}, Placement(kStart, true));
  bench.bus->attached.devices = {kHydra};
  bench.source.open();
  bench.bus->reports = {bytes(golden::kHydra)};
  const LiveBatch batch = bench.read_all();
  REQUIRE(batch.samples.size() == 1);
  CHECK(glm::distance(batch.samples[0].patient_from_probe.translation, glm::dvec3(-1, 2, -3)) < 1e-9);
}

TEST_CASE("short, corrupt, repeated, late and missing reports are counted, reported, and never a sample") {
  Bench<HydraSource> bench(std::size_t{0}, Placement({}, true));
  bench.bus->attached.devices = {kHydra};
  bench.source.open();
  // A gamepad's reports before it has started are nobody's fault.
  bench.bus->reports = {Report(7, 0), hydra_report(9, 0)};
  CHECK(bench.read_all().note.empty());
  Report corrupt = hydra_report(11, 500);
  corrupt[8] ^= 1;
  Report cut = hydra_report(11, 500);
  cut.resize(30);
  bench.bus->reports = {hydra_report(10, 1), corrupt, cut, hydra_report(10, 500), hydra_report(9, 500),
                        hydra_report(14, 2)};
  const LiveBatch batch = bench.read_all();
  REQUIRE(batch.samples.size() == 2);
  CHECK(batch.samples[0].patient_from_probe.translation.x == 1);
  CHECK(batch.samples[1].patient_from_probe.translation.x == 2);
  const ReportTally& tally = bench.source.tally();
  CHECK(tally.cut == 2);
  CHECK(tally.corrupt == 1);
  CHECK(tally.repeated == 1);
  CHECK(tally.late == 1);
  CHECK(tally.missed == 3);
  CHECK(contains(batch.note, "damaged or lost"));
  bench.now_s += 2.5;
  bench.bus->reports = {hydra_report(15, 2)};
  CHECK(bench.read_all().note.empty());
}

TEST_CASE("a device that says nothing is started again and again, and people are informed") {
  Bench<HydraSource> bench(std::size_t{0}, Placement({}, true));
  bench.bus->attached.devices = {kHydra};
  bench.source.open();
  bench.now_s += 4.9;
  CHECK(bench.read_all().note.empty());
  CHECK(bench.bus->sent.size() == 1);
  bench.now_s += 0.2;
  CHECK(contains(bench.read_all().note, "sends no poses, and was started 2 times"));
  CHECK(bench.bus->sent.size() == 2);
  bench.now_s += 4.9;
  bench.read_all();
  CHECK(bench.bus->sent.size() == 2);
  bench.bus->reports = {hydra_report(1, 0)};
  CHECK(bench.read_all().note.empty());
}

TEST_CASE("a device that is pulled out is lost with a sentence, and comes back where it was") {
  Bench<HydraSource> bench(std::size_t{0}, Placement(kStart, false));
  CHECK_THROWS_WITH(bench.source.open(), "The Razer Hydra is not plugged in.");
  bench.bus->attached.devices = {kHydra};
  bench.bus->refuses = forbidden(kHydra);
  CHECK_THROWS_AS(bench.source.open(), TransportError);
  bench.bus->refuses.reset();
  bench.source.open();
  bench.bus->reports = {hydra_report(77, 100)};
  bench.read_all();
  bench.bus->pulled = true;
  CHECK_THROWS_WITH(bench.read_all(), Catch::Contains("was lost (Input/output error)"));
  bench.source.close();
  CHECK(bench.bus->open_now == 0);
  bench.bus->pulled = false;
  bench.source.open();
  bench.bus->reports = {hydra_report(3, 100)};
  const LiveBatch batch = bench.read_all();
  REQUIRE(batch.samples.size() == 1);
  CHECK(glm::distance(batch.samples[0].patient_from_probe.translation, kStart.translation) < 1e-9);
  CHECK(bench.source.tally().incidents() == 0);
}

TEST_CASE("a Liberty is set up in its own words, and one of its sensors is followed") {
  Bench<PolhemusSource> bench(1u, Placement({}, true));
  bench.bus->attached.devices = {kLiberty};
  bench.source.open();
  CHECK(bench.bus->endpoints.out == 0x04);
  CHECK(bench.bus->endpoints.in == 0x88);
  std::string commands;
  for (const Report& command : bench.bus->sent) commands.append(command.begin(), command.end());
  CHECK(commands == "P\rF1\rU1\rO*,8,9,11,3,7\r@B0\rC\r");

  const Report first = liberty_record(2, 5, 20), second = liberty_record(2, 6, 21), third = liberty_record(2, 9, 0);
  Report half(second.begin(), second.begin() + 20), rest(second.begin() + 20, second.end());
  bench.bus->reports = {first, liberty_record(1, 5, 0), half, rest, third};
  const LiveBatch batch = bench.read_all();
  REQUIRE(batch.samples.size() == 3);
  CHECK(batch.samples[0].status == PoseStatus::ok);
  CHECK(glm::distance(batch.samples[0].patient_from_probe.translation, glm::dvec3(105, -22.5, 310)) < 1e-9);
  CHECK(batch.samples[0].distortion == 20u);
  CHECK(batch.samples[1].distortion == 21u);
  CHECK(batch.samples[2].distortion == 0u);
  CHECK(bench.source.tally().missed == 2);
  bench.source.close();
  CHECK(bench.bus->sent.back() == Report{'P', '\r'});
}

TEST_CASE("a Polhemus sensor that is missing is reported with those that are, and text between records is counted") {
  Bench<PolhemusSource> bench(2u, Placement({}, true));
  bench.bus->attached.devices = {kLiberty};
  bench.source.open();
  bench.bus->reports = {{'o', 'k', '\r'}, liberty_record(1, 5, 0), liberty_record(4, 5, 0)};
  CHECK(bench.read_all().note.empty());
  bench.now_s += PolhemusSource::kSensorMissing_s + 0.1;
  bench.bus->reports = {liberty_record(1, 6, 0)};
  CHECK(bench.read_all().note ==
        "The Polhemus tracker sends sensor 1, 4 but not sensor 3: plug that in, or follow another, as in "
        "'polhemus:?sensor=1'.");
  bench.bus->reports = {liberty_record(3, 7, 0)};
  CHECK(bench.read_all().note.empty());
  CHECK(bench.source.tally().incidents() == 0);
  bench.bus->reports = {{'o', 'k'}, {'\r'}, liberty_record(3, 8, 0)};
  CHECK(contains(bench.read_all().note, "1 foreign"));
  CHECK(bench.source.tally().foreign == 1);
}

TEST_CASE("a tracker that nobody has calibrated says so in its name") {
  CHECK(open_tracker("hydra:")->state().name ==
        "Razer Hydra, not calibrated: the probe began where the sensor was first seen");
  CHECK(contains(open_tracker("polhemus:")->state().name, "not calibrated"));
  CHECK(open_tracker("hydra:?raw=1")->state().name == "Razer Hydra");
  CHECK(open_tracker("spacemouse:")->state().name == "SpaceMouse");
}

TEST_CASE("a Viper is set to its units and to send, and a frame that fails its checksum is counted") {
  Bench<PolhemusSource> bench(1u, Placement({}, true));
  bench.bus->attached.devices = {kViper};
  bench.source.open();
  CHECK(bench.bus->endpoints.in == 0x81);
  REQUIRE(bench.bus->sent.size() == 2);
  CHECK(bench.bus->sent[0] == viper::command(viper::kUnits, viper::kSet, {2, 2}));
  CHECK(bench.bus->sent[1] == bytes(golden::kViperStart));
  Report corrupt = bytes(golden::kViper);
  corrupt[40] ^= 4;
  bench.bus->reports = {bytes(golden::kViper), corrupt};
  const LiveBatch batch = bench.read_all();
  REQUIRE(batch.samples.size() == 1);
  CHECK(bench.source.tally().foreign == 0);
  CHECK(batch.samples[0].buttons == kFreezeButton);
  CHECK(bench.source.tally().corrupt == 1);
  bench.source.close();
  CHECK(bench.bus->sent.back() == viper::command(viper::kContinuous, viper::kReset));
}

TEST_CASE("a SpaceMouse moves the probe at a rate, as seen on the screen, and stops when it falls silent") {
  Bench<SpaceMouseSource> bench(kStart, 2.0);
  bench.bus->attached.devices = {{0x256f, 0xc635, "", "", "/dev/hidraw0", 0}};
  bench.source.open();
  const auto after = [&](double seconds, const Report& report) {
    bench.now_s += seconds;
    bench.bus->reports.clear();
    if (!report.empty()) bench.bus->reports = {report};
    const LiveBatch batch = bench.read_all();
    REQUIRE(batch.samples.size() == 1);
    CHECK(batch.samples[0].time_s == bench.now_s);
    return batch.samples[0];
  };
  CHECK(after(1, {}).patient_from_probe.translation == kStart.translation);
  // Pressed down at half the travel, 60 mm/s at speed 2.
  after(1, {1, 0, 0, 0, 0, 175, 0});
  const glm::dvec3 pressed = after(0.05, {1, 94, 1, 0, 0, 0, 0}).patient_from_probe.translation;
  CHECK(glm::distance(pressed, kStart.point({0, 3, 0})) < 1e-9);
  // Then to the right, away from the marker, for a tenth of a second: after that it counts as let go.
  const Pose right = after(0.05, {}).patient_from_probe;
  CHECK(glm::distance(right.translation, kStart.point({-6, 3, 0})) < 1e-9);
  after(0.05, {});
  CHECK(glm::distance(after(7, {}).patient_from_probe.translation, kStart.point({-12, 3, 0})) < 1e-9);
  // Turned about the axis that points down: about the beam, at 2 rad/s.
  after(1, {1, 0, 0, 0, 0, 0, 0});
  after(0.01, {2, 0, 0, 0, 0, 94, 1});
  const ProbeSample turned = after(0.1, {3, 3});
  CHECK(angle_between_deg(turned.patient_from_probe, kStart) == Approx(glm::degrees(0.2)));
  CHECK(glm::distance(turned.patient_from_probe.rotation[1], kStart.rotation[1]) < 1e-9);
  CHECK(glm::dot(turned.patient_from_probe.rotation[2], kStart.rotation[0]) > 0);
  CHECK(turned.buttons == (kFreezeButton | kEventMarkerButton));
  CHECK(after(0.01, {23, 80}).buttons == (kFreezeButton | kEventMarkerButton));
  CHECK(bench.source.tally().incidents() == 0);
}

TEST_CASE("a SpaceMouse whose cap is held down for minutes keeps the probe within reach, and brings it back") {
  Bench<SpaceMouseSource> bench(kStart, 10.0);
  bench.bus->attached.devices = {{0x256f, 0xc635, "", "", "/dev/hidraw0", 0}};
  bench.source.open();
  const auto held = [&](int tenths, const Report& report) {
    glm::dvec3 last(0);
    for (int i = 0; i < tenths; ++i) {
      bench.now_s += 0.1;
      bench.bus->reports = {report};
      const LiveBatch batch = bench.read_all();
      if (!batch.samples.empty()) last = batch.samples.back().patient_from_probe.translation;
    }
    return glm::distance(last, kStart.translation);
  };
  CHECK(held(3000, {1, 0, 0, 0, 0, 94, 1}) == Approx(SpaceMouseSource::kRange_mm));
  CHECK(held(20, {1, 0, 0, 0, 0, 0xa2, 0xfe}) < SpaceMouseSource::kRange_mm - 500);
}

TEST_CASE("an OSVR tracker turns the probe on the spot") {
  Bench<OsvrSource> bench(kStart);
  bench.bus->attached.devices = {{0x1532, 0x0b00, "", "", "/dev/hidraw0", 0}};
  bench.source.open();
  // A quarter of a turn about the sensor's own y, which points up: about the beam, backwards.
  Report quarter = bytes(golden::kOsvr);
  quarter[1] = 10;
  const glm::dquat turned = glm::dquat(0.5, 0.5, -0.5, 0.5) * glm::angleAxis(std::acos(0.0), glm::dvec3(0, 1, 0));
  const double parts[] = {turned.x, turned.y, turned.z, turned.w};
  for (std::size_t i = 0; i < 4; ++i) {
    const int number = int(std::lround(parts[i] * 16384));
    quarter[2 + 2 * i] = std::uint8_t(number);
    quarter[3 + 2 * i] = std::uint8_t(number >> 8);
  }
  bench.bus->reports = {bytes(golden::kOsvr), quarter, quarter};
  const LiveBatch batch = bench.read_all();
  REQUIRE(batch.samples.size() == 2);
  CHECK(angle_between_deg(batch.samples[0].patient_from_probe, kStart) < 1e-5);
  // 14 bits of a quaternion leave 0.01 degrees.
  CHECK(angle_between_deg(batch.samples[1].patient_from_probe, kStart) == Approx(90).margin(0.02));
  CHECK(glm::distance(batch.samples[1].patient_from_probe.rotation[0], kStart.rotation[2]) < 1e-3);
  CHECK(batch.samples[1].patient_from_probe.translation == kStart.translation);
  CHECK(bench.source.tally().repeated == 1);
}

TEST_CASE("the best of several devices is the first that opens, and what keeps one from opening is said") {
  const auto first = std::make_shared<ScriptedBus>(), second = std::make_shared<ScriptedBus>();
  const auto best = [&] {
    std::vector<std::unique_ptr<RawSource>> sources;
    sources.push_back(std::make_unique<HydraSource>(first, "", 0, Placement({}, true)));
    sources.push_back(std::make_unique<SpaceMouseSource>(second, "", Pose{}, 1.0));
    return BestSource(std::move(sources));
  };
  BestSource source = best();
  CHECK_THROWS_WITH(source.open(), "No tracker that is known here is plugged in.");
  first->attached.devices = {kHydra};
  first->refuses = forbidden(kHydra);
  CHECK_THROWS_WITH(source.open(), Catch::Contains("may not be opened"));
  second->attached.devices = {{0x046d, 0xc626, "", "", "/dev/hidraw0", 0}};
  source.open();
  CHECK(second->open_now == 1);
  source.close();
  first->refuses.reset();
  source.open();
  CHECK(first->open_now == 1);
  CHECK(second->open_now == 0);
  source.close();
}

TEST_CASE("trackers on a bus open by their URI, with or without the device") {
  for (const char* uri : {"hydra:", "hydra:A1?handset=2&raw=1", "polhemus:?sensor=3&distortion=40",
                          "spacemouse:?speed=3", "osvr:", "auto:"}) {
    const auto tracker = open_tracker(uri);
    CHECK(tracker->live());
    CHECK(tracker->state().condition == TrackerCondition::waiting);
  }
  for (const char* uri : {"hydra:?handset=3", "hydra:?sensor=1", "polhemus:?sensor=0", "polhemus:?distortion=x",
                          "replay:x?distortion=3", "spacemouse:?speed=0", "osvr:?raw=1", "auto:x", "auto:?raw=1"})
    CHECK_THROWS_AS(open_tracker(uri), InputError);
}
