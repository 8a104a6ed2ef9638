// What trackers send, as bytes: golden reports, every truncation, every flipped bit, and damage of all kinds.
#include "golden_reports.h"
#include "report_promises.h"
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "devices/crc16.h"
#include "devices/hydra/hydra_report.h"
#include "devices/osvr/osvr_report.h"
#include "devices/polhemus/polhemus_stream.h"
#include "devices/spacemouse/spacemouse_report.h"
#include "sim/core/hash.h"
#include "sim/files/files.h"

using namespace insonate;

namespace {

using Report = std::vector<std::uint8_t>;

Report copy(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

/// (1, 1, -1, 1) / 2, a third of a turn about (1, -1, 1), as the golden reports hold it.
const glm::dmat3 kTurned = glm::mat3_cast(glm::dquat(0.5, 0.5, -0.5, 0.5));

void check_pose(const SensorReading& reading, const glm::dvec3& mm, const glm::dmat3& rotation) {
  CHECK(reading.status == PoseStatus::ok);
  // Float and int16 hold these numbers exactly but for the Hydra's 32767 / 32768.
  CHECK(glm::distance(reading.tracker_from_sensor.translation, mm) < 1e-9);
  CHECK(angle_between_deg(reading.tracker_from_sensor, {rotation, mm}) < 1e-5);
}

std::vector<PolhemusRecord> records_of(Bytes bytes) {
  PolhemusStream stream;
  std::vector<PolhemusRecord> records;
  stream.add(bytes, records);
  return records;
}

Report operator+(Report a, Bytes b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("the checksums are the catalogued ones") {
  const std::string text = "123456789";
  const Bytes bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  CHECK(crc16_1021(bytes, 0) == 0x31c3);
  CHECK(crc16_1021(bytes, 0xffff) == 0x29b1);
  CHECK(crc16_arc(bytes) == 0xbb3d);
}

TEST_CASE("a Hydra's report holds both handsets") {
  const auto hydra = parse_hydra(golden::kHydra);
  REQUIRE(hydra.fault == ReportFault::none);
  CHECK(hydra.report.sequence == 0x2a);
  const auto& [first, second] = hydra.report.handsets;
  check_pose(first.reading, {100, -200, 300}, kTurned);
  CHECK(first.reading.sensor == 0);
  CHECK(first.reading.buttons == 0x21);
  CHECK(first.stick_x == 0.5);
  CHECK(first.stick_y == -1);
  CHECK(first.trigger == 1);
  check_pose(second.reading, {-1, 2, -3}, glm::dmat3(1));
  CHECK(second.reading.sensor == 1);
  CHECK(second.reading.buttons == 0);
}

TEST_CASE("a Hydra's report that is cut, prolonged or has any bit flipped is distinguished from a whole one") {
  const Report whole = copy(golden::kHydra);
  for (std::size_t length = 0; length < whole.size(); ++length)
    CHECK(parse_hydra(Bytes(whole).first(length)).fault == ReportFault::length);
  CHECK(parse_hydra(whole + Bytes(whole).first(1)).fault == ReportFault::length);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Report flipped = whole;
    flipped[bit / 8] ^= std::uint8_t(1 << bit % 8);
    const bool in_header = bit / 8 < 7 || bit / 8 == 28;
    CHECK(parse_hydra(flipped).fault == (in_header ? ReportFault::header : ReportFault::checksum));
  }
}

TEST_CASE("a Hydra's handset whose numbers are not a rotation is invalid, the other one stays") {
  Report report = copy(golden::kHydra);
  for (std::size_t i = 14; i < 22; ++i) report[i] = 0;
  const std::uint16_t crc = crc16_1021(Bytes(report).first(50), 0x1d0f);
  report[50] = std::uint8_t(crc);
  report[51] = std::uint8_t(crc >> 8);
  const auto hydra = parse_hydra(report);
  REQUIRE(hydra.fault == ReportFault::none);
  CHECK(hydra.report.handsets[0].reading.status == PoseStatus::invalid);
  CHECK(hydra.report.handsets[1].reading.status == PoseStatus::ok);
}

TEST_CASE("a Hydra is made to send poses, and to be a gamepad again") {
  const auto poses = hydra_mode(true), gamepad = hydra_mode(false);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CHECK(poses[i] == (i == 6 ? 1 : i == 8 ? 4 : i == 9 ? 3 : i == 89 ? 6 : 0));
    CHECK(gamepad[i] == (i == 6 ? 1 : i == 8 ? 4 : i == 89 ? 5 : 0));
  }
}

TEST_CASE("Liberty's and Patriot's records are read in centimetres, with their frame and distortion") {
  for (const char* tag : {"LY", "PA"}) {
    Report bytes = copy(golden::kLiberty);
    std::copy(tag, tag + 2, bytes.begin());
    const auto records = records_of(bytes);
    REQUIRE(records.size() == 1);
    CHECK(records[0].frame == 77);
    CHECK(records[0].reading.sensor == 1);
    CHECK(records[0].reading.distortion == 3);
    CHECK(records[0].reading.buttons == 0);
    check_pose(records[0].reading, {105, -22.5, 310}, kTurned);
  }
  Report flagged = copy(golden::kLiberty);
  flagged[4] = 'a';
  REQUIRE(records_of(flagged).size() == 1);
  CHECK(records_of(flagged)[0].reading.status == PoseStatus::invalid);
}

TEST_CASE("a Viper's frame holds its own units") {
  const auto records = records_of(golden::kViper);
  REQUIRE(records.size() == 1);
  CHECK(records[0].frame == 88);
  CHECK(records[0].reading.sensor == 1);
  CHECK(records[0].reading.buttons == 1);
  CHECK(records[0].reading.distortion == 9);
  check_pose(records[0].reading, {105, -22.5, 310}, kTurned);

  const auto with_info = [](std::uint8_t units) {
    Report bytes = copy(golden::kViper);
    bytes[25] = units;
    const std::uint16_t crc = crc16_arc(Bytes(bytes).first(56));
    bytes[56] = std::uint8_t(crc);
    bytes[57] = std::uint8_t(crc >> 8);
    return records_of(bytes);
  };
  check_pose(with_info(0x58)[0].reading, glm::dvec3(10.5, -2.25, 31) * 25.4, kTurned);
  check_pose(with_info(0x59)[0].reading, glm::dvec3(10.5, -2.25, 31) * 304.8, kTurned);
  // 31 m is farther than any tracker reaches; Euler angles are not a quaternion.
  CHECK(with_info(0x5b)[0].reading.status == PoseStatus::invalid);
  CHECK(with_info(0x52)[0].reading.status == PoseStatus::invalid);
}

TEST_CASE("a Viper's frame with any bit flipped gives nothing, and the frame behind it comes whole") {
  for (std::size_t bit = 0; bit < 8 * std::size(golden::kViper); ++bit) {
    Report bytes = copy(golden::kViper);
    bytes[bit / 8] ^= std::uint8_t(1 << bit % 8);
    // A size that grew may take in what follows, so enough follows for the largest frame.
    Report stream = bytes;
    for (int i = 0; i < 12; ++i) stream = stream + golden::kViper;
    CAPTURE(bit);
    CHECK(records_of(bytes).empty());
    CHECK(records_of(stream).size() == 12);
  }
}

TEST_CASE("Polhemus records come whole however the bytes are cut, with anything in between") {
  Report stream;
  for (int i = 0; i < 4; ++i)
    stream = stream + golden::kLiberty + Bytes(golden::kLiberty).first(std::size_t(i * 15)) + golden::kViper +
             golden::kViperStart;
  // A cut Liberty record has no checksum: its first bytes and the Viper frame behind it can make a false record of 48
  // bytes, whose quaternion is not a rotation here. So every whole one must come.
  const std::size_t expected = records_of(stream).size();
  CHECK(expected == 8);
  for (std::size_t portion = 1; portion < 130; ++portion) {
    PolhemusStream cut;
    std::vector<PolhemusRecord> records;
    for (std::size_t begin = 0; begin < stream.size(); begin += portion)
      cut.add(Bytes(stream).subspan(begin, std::min(portion, stream.size() - begin)), records);
    CHECK(records.size() == expected);
  }
  PolhemusStream again;
  std::vector<PolhemusRecord> records;
  again.add(Bytes(golden::kLiberty).first(20), records);
  again.restart();
  again.add(golden::kLiberty, records);
  CHECK(records.size() == 1);
  CHECK(again.foreign() == 0);
  again.add(Bytes(golden::kViperStart), records);
  again.add(golden::kLiberty, records);
  CHECK(records.size() == 2);
  CHECK(again.foreign() == 1);
}

TEST_CASE("a Viper's commands carry their size and checksum") {
  CHECK(viper::command(viper::kContinuous, viper::kSet) == copy(golden::kViperStart));
  const Report units = viper::command(viper::kUnits, viper::kSet, {2, 2});
  REQUIRE(units.size() == 40);
  CHECK(u32_at(units, 4) == 32);
  CHECK(u32_at(units, 28) == 2);
  CHECK(crc16_arc(Bytes(units).first(36)) == u32_at(units, 36));
}

TEST_CASE("a SpaceMouse reports push, rotation and buttons, together or one by one") {
  const auto push = parse_spacemouse(golden::kSpaceMousePush);
  REQUIRE(push.fault == ReportFault::none);
  CHECK(push.report.push == glm::dvec3(1, -0.5, 0));
  CHECK_FALSE(push.report.turn);
  CHECK_FALSE(push.report.buttons);
  CHECK(parse_spacemouse(Report{2, 0, 0, 0xa2, 0xfe, 0xff, 0x7f}).report.turn == glm::dvec3(0, -1, 1));
  const auto both = parse_spacemouse(Report{1, 0, 0, 0, 0, 0x5e, 1, 0, 0, 0x00, 0x80, 0, 0});
  CHECK(both.report.push == glm::dvec3(0, 0, 1));
  CHECK(both.report.turn == glm::dvec3(0, -1, 0));
  CHECK(parse_spacemouse(Report{3, 2}).report.buttons == 2u);
  CHECK(parse_spacemouse(Report{3, 1, 2, 3, 4, 5, 6}).report.buttons == 0x04030201u);
  for (const Report& wrong : {Report{}, Report{1}, Report{1, 0, 0, 0, 0, 0}, Report{2, 0, 0, 0, 0, 0, 0, 0}, Report{3},
                              Report{3, 0, 0, 0, 0, 0, 0, 0}, Report(13, 2)})
    CHECK(parse_spacemouse(wrong).fault == ReportFault::length);
  CHECK(parse_spacemouse(Report{23, 80}).fault == ReportFault::header);
}

TEST_CASE("an OSVR report holds orientation, and is refused when it is none") {
  const auto osvr = parse_osvr(golden::kOsvr);
  REQUIRE(osvr.fault == ReportFault::none);
  CHECK(osvr.report.sequence == 9);
  CHECK(osvr.report.world_from_sensor == glm::dquat(0.5, 0.5, -0.5, 0.5));
  CHECK(osvr.report.rad_per_s == glm::dvec3(1, -0.5, 2));
  const Report whole = copy(golden::kOsvr);
  CHECK(parse_osvr(whole + Report(16, 0)).fault == ReportFault::none);
  for (std::size_t length = 0; length < whole.size(); ++length)
    CHECK(parse_osvr(Bytes(whole).first(length)).fault == ReportFault::length);
  Report no_rotation = whole, other_version = whole;
  for (std::size_t i = 2; i < 10; ++i) no_rotation[i] = 0;
  other_version[0] = 4;
  CHECK(parse_osvr(no_rotation).fault == ReportFault::checksum);
  CHECK(parse_osvr(other_version).fault == ReportFault::header);
}

TEST_CASE("parsers keep their promises whatever bytes come") {
  std::vector<Report> seeds = {copy(golden::kHydra), copy(golden::kLiberty), copy(golden::kViper), copy(golden::kOsvr),
                               copy(golden::kSpaceMousePush)};
  for (const auto& entry : std::filesystem::directory_iterator(INSONATE_CORPUS_FOLDER)) {
    if (entry.path().filename().string().starts_with(".")) continue;
    const std::string text = read_file(entry.path());
    seeds.emplace_back(text.begin(), text.end());
  }
  CHECK(seeds.size() > 20);
  for (std::uint32_t s = 0; s < seeds.size(); ++s) {
    CHECK(broken_promise(seeds[s]) == "");
    for (std::uint32_t trial = 0; trial < 200; ++trial) {
      std::uint32_t draws = 0;
      const auto random = [&](std::size_t below) { return std::size_t(hash(s, trial, ++draws, 7)) % below; };
      Report bytes = seeds[s] + seeds[random(seeds.size())];
      for (std::size_t change = random(4); change-- > 0 && !bytes.empty();) {
        const std::size_t at = random(bytes.size());
        if (random(3) == 0)
          bytes.erase(bytes.begin() + std::ptrdiff_t(at));
        else if (random(2) == 0)
          bytes.insert(bytes.begin() + std::ptrdiff_t(at), std::uint8_t(random(256)));
        else
          bytes[at] = std::uint8_t(bytes[at] ^ 1u << random(8));
      }
      bytes.erase(bytes.end() - std::ptrdiff_t(random(bytes.size() + 1) / 4), bytes.end());
      const std::string broken = broken_promise(bytes);
      if (broken.empty()) continue;
      CAPTURE(s, trial);
      FAIL_CHECK(broken);
    }
  }
}
