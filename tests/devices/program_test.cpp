// insonate-devices as a person runs it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "devices/known_trackers.h"

using namespace insonate;

namespace {

struct Run {
  int exit_code;
  std::string output;
};

Run run(const std::string& arguments) {
  FILE* pipe = popen((std::string(INSONATE_DEVICES_PROGRAM) + " " + arguments).c_str(), "r");
  REQUIRE(pipe);
  Run result{0, ""};
  std::array<char, 4096> part;
  while (const std::size_t got = std::fread(part.data(), 1, part.size(), pipe)) result.output.append(part.data(), got);
  result.exit_code = WEXITSTATUS(pclose(pipe));
  return result;
}

const std::string kLog = std::string(INSONATE_SEQUENCES_FOLDER) + "/plus_images.igs.mha";

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("insonate-devices list names every kind of tracker, with or without a bus to ask") {
  const Run listed = run("list");
  CHECK(listed.exit_code == 0);
  for (const char* words : {"replay:FILE", "synthetic:", "mouse:", "Plugged in:"})
    CHECK(contains(listed.output, words));
  CHECK(run("list --all").exit_code == 0);
}

TEST_CASE("insonate-devices check reports a log in words and in JSON") {
  const Run words = run("check " + kLog);
  CHECK(words.exit_code == 0);
  CHECK(contains(words.output, "frames    5, 3 of them usable (60.0 %)"));
  CHECK(contains(words.output, "1 frames out of view in 1 spells"));

  const Run json = run("check --json " + kLog);
  CHECK(json.exit_code == 0);
  const auto report = nlohmann::json::parse(json.output);
  CHECK(report["frames"] == 5);
  CHECK(report["usable_frames"] == 3);
  CHECK(report["rate_hz"].get<double>() == Approx(20));
  CHECK(report["dropouts"]["missing"]["frames"] == 1);
  CHECK(report["jumps"].empty());
  CHECK(nlohmann::json::parse(run("check --json --transform ReferenceToTracker " + kLog).output)["usable_frames"] == 5);
}

TEST_CASE("insonate-devices watch prints every sample of a log, once and in order") {
  const Run watched = run("watch 'replay:" + kLog + "?speed=4' 2>/dev/null");
  CHECK(watched.exit_code == 0);
  CHECK(std::count(watched.output.begin(), watched.output.end(), '\n') == 1 + 5);
  CHECK(contains(watched.output, "12.350000 out of view"));
  const std::size_t first = watched.output.find("12.250000 ok"), last = watched.output.find("12.450000 ok");
  CHECK(first < last);
  CHECK(last != std::string::npos);

  const Run endless = run("watch synthetic:3?rate=100 --seconds 0.3 2>/dev/null");
  CHECK(endless.exit_code == 0);
  CHECK(std::count(endless.output.begin(), endless.output.end(), '\n') == 1 + 31);
}

TEST_CASE("insonate-devices says what is wrong in one line and exits with 2") {
  const std::pair<const char*, const char*> wrong[] = {
      {"check /nowhere/scan.igs.mha", "/nowhere/scan.igs.mha: there is no such file"},
      {"check /dev/null", "no ordinary file"},
      {"watch replai:x", "did you mean 'replay'?"},
      {"watch mouse:?x=1", "no options"},
  };
  for (const auto& [arguments, expected] : wrong) {
    const Run refused = run(std::string(arguments) + " 2>&1");
    CAPTURE(arguments, refused.output);
    CHECK(refused.exit_code == 2);
    CHECK(contains(refused.output, expected));
    CHECK(std::count(refused.output.begin(), refused.output.end(), '\n') == 1);
  }
  CHECK(run("2>/dev/null").exit_code == 2);
  CHECK(run("chek x 2>/dev/null").exit_code == 2);
  CHECK(run("--help").exit_code == 0);
}

TEST_CASE("trackers are known by their numbers, the more particular name first") {
  CHECK(known_tracker(Bus::hid, 0x1532, 0x0300)->name == "Razer Hydra");
  CHECK(known_tracker(Bus::hid, 0x256f, 0xc635)->name == "3Dconnexion SpaceMouse Compact");
  CHECK(known_tracker(Bus::hid, 0x256f, 0xffff)->name == "3Dconnexion SpaceMouse");
  CHECK(known_tracker(Bus::usb, 0x0f44, 0xbf01)->note.empty());
  CHECK(contains(std::string(known_tracker(Bus::usb, 0x0f44, 0xff21)->note), "firmware"));
  CHECK(known_tracker(Bus::usb, 0x1532, 0x0300) == nullptr);
  CHECK(known_tracker(Bus::hid, 0x1234, 0x5678) == nullptr);
}
