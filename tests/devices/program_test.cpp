// insonate-devices as a person runs it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "devices/hydra/hydra_tracker.h"
#include "devices/osvr/osvr_tracker.h"
#include "devices/polhemus/polhemus_tracker.h"
#include "devices/record/recording_files.h"
#include "devices/registry.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "devices/sequence/sequence_text.h"
#include "devices/spacemouse/spacemouse_tracker.h"
#include "sim/files/files.h"
#include "tests/core/run_program.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/test_samples.h"

using namespace insonate;

namespace {

ProgramOutcome run(const std::string& arguments) {
  return run_program(std::string(INSONATE_DEVICES_PROGRAM) + " " + arguments);
}

const std::string kLog = std::string(INSONATE_SEQUENCES_FOLDER) + "/plus_images.igs.mha";

}  // namespace

TEST_CASE("insonate-devices list names every kind of tracker, with or without a bus to ask") {
  const ProgramOutcome listed = run("list");
  CHECK(listed.code == 0);
  for (const char* words : {"replay:FILE", "synthetic:", "mouse:", "Plugged in:"})
    CHECK(contains(listed.output, words));
  CHECK(run("list --all").code == 0);
}

TEST_CASE("insonate-devices check reports a log in words and in JSON") {
  const ProgramOutcome words = run("check " + kLog);
  CHECK(words.code == 0);
  CHECK(contains(words.output, "frames    5, 3 of them usable (60.0 %)"));
  CHECK(contains(words.output, "1 frames out of view in 1 spells"));

  const ProgramOutcome json = run("check --json " + kLog);
  CHECK(json.code == 0);
  const auto report = nlohmann::json::parse(json.output);
  CHECK(report["frames"] == 5);
  CHECK(report["usable_frames"] == 3);
  CHECK(report["rate_hz"].get<double>() == Approx(20));
  CHECK(report["dropouts"]["missing"]["frames"] == 1);
  CHECK(report["jumps"].empty());
  CHECK(report["findings"].empty());
  CHECK(nlohmann::json::parse(run("check --json --transform ReferenceToTracker " + kLog).output)["usable_frames"] == 5);
}

TEST_CASE("insonate-devices check exits with 1 when there is something to look at") {
  const TemporaryFolder folder;
  const std::string log = folder.path / "gap.igs.mha";
  std::vector<ProbeSample> samples;
  for (int i = 0; i < 50; ++i)
    if (i < 20 || i > 30) samples.push_back({i / 60.0, PoseStatus::ok, Pose{}, 0});
  write_file(log, write_sequence(samples));
  const ProgramOutcome words = run("check " + log);
  CHECK(words.code == 1);
  CHECK(contains(words.output, "look at   1 gap in the samples"));
  const ProgramOutcome json = run("check --json " + log);
  CHECK(json.code == 1);
  CHECK(nlohmann::json::parse(json.output)["findings"].size() == 1);
}

TEST_CASE("insonate-devices watch records what it prints, to the bit, and overwrites nothing") {
  const TemporaryFolder folder;
  const std::string file = folder.path / "watch.igs.mha";
  const std::string command = "watch 'replay:" + kLog + "?speed=4' --record " + file + " 2>&1";
  CHECK(run(command).code == 0);
  const auto samples = [](const std::string& log) { return read_recorded_scan(log).samples; };
  CHECK(same_bits(samples(file), samples(kLog)));
  const ProgramOutcome again = run(command);
  CHECK(again.code == 2);
  CHECK(contains(again.output, "such a file already"));
}

TEST_CASE("insonate-devices bench prints its figures and writes them and the latency's histogram as CSV") {
  const TemporaryFolder folder;
  const std::string csv = folder.path / "bench.csv";
  const ProgramOutcome bench = run("bench --seconds 0.5 --csv " + csv + " --histogram " + csv + ".steps");
  CHECK(bench.code == 0);
  const std::string figures = read_file(csv), steps = read_file(csv + ".steps");
  for (const char* row :
       {"measure,setting,figure,value,unit\n", "smoothing,60 Hz,lag,", "prediction,20 ms ahead,",
        "rejection,240 Hz,strays rejected,", "throughput,8 x 1000 Hz,samples lost,", "latency,1000 Hz,median,"})
    CHECK(contains(figures, row));
  CHECK(contains(bench.output, "samples delivered"));
  CHECK(contains(steps, "from_ms,reports_60_hz,reports_240_hz,reports_1000_hz\n0,"));
}

TEST_CASE("insonate-devices recover finishes a recording, and says what there is none of") {
  const TemporaryFolder folder;
  const std::string log = folder.path / "cut.igs.mha";
  const auto leave = [&] {
    std::filesystem::remove(log);
    std::string text = working_head(0, 0);
    append_frame(text, 0, {1.5, PoseStatus::ok, Pose{}, 0});
    write_file(working_file(log), text + frame_end(0, 1) + "Seq_Frame0001_Probe");
  };
  for (const std::string& named : {log, working_file(log).string()}) {
    leave();
    const ProgramOutcome recovered = run("recover " + named);
    CHECK(recovered.code == 0);
    CHECK(recovered.output == "wrote " + log + " with 1 frames\n");
    CHECK(read_file(log) == write_sequence({{1.5, PoseStatus::ok, Pose{}, 0}}));
  }
  const ProgramOutcome none = run("recover " + log + " 2>&1");
  CHECK(none.code == 2);
  CHECK(contains(none.output, "such a file already"));
}

TEST_CASE("insonate-devices watch prints every sample of a log, once and in order") {
  const ProgramOutcome watched = run("watch 'replay:" + kLog + "?speed=4' 2>/dev/null");
  CHECK(watched.code == 0);
  CHECK(std::count(watched.output.begin(), watched.output.end(), '\n') == 1 + 5);
  CHECK(contains(watched.output, "12.350000 out of view"));
  const std::size_t first = watched.output.find("12.250000 ok"), last = watched.output.find("12.450000 ok");
  CHECK(first < last);
  CHECK(last != std::string::npos);

  const ProgramOutcome endless = run("watch synthetic:3?rate=100 --seconds 0.3 2>/dev/null");
  CHECK(endless.code == 0);
  CHECK(std::count(endless.output.begin(), endless.output.end(), '\n') == 1 + 31);
}

TEST_CASE("insonate-devices says what is wrong in one line and exits with 2") {
  const std::pair<const char*, const char*> wrong[] = {
      {"check /nowhere/scan.igs.mha", "/nowhere/scan.igs.mha: there is no such file"},
      {"check /dev/null", "not an ordinary file"},
      {"watch replai:x", "did you mean 'replay'?"},
      {"watch mouse:?x=1", "no options"},
  };
  for (const auto& [arguments, expected] : wrong) {
    const ProgramOutcome refused = run(std::string(arguments) + " 2>&1");
    CAPTURE(arguments, refused.output);
    CHECK(refused.code == 2);
    CHECK(contains(refused.output, expected));
    CHECK(std::count(refused.output.begin(), refused.output.end(), '\n') == 1);
  }
  CHECK(run("2>/dev/null").code == 2);
  CHECK(run("chek x 2>/dev/null").code == 2);
  CHECK(run("--help").code == 0);
}

TEST_CASE("trackers are known by their numbers, the more particular name first") {
  CHECK(kHydraDevice.find(0x1532, 0x0300)->name == "Razer Hydra");
  CHECK(kSpaceMouseDevice.find(0x256f, 0xc635)->name == "3Dconnexion SpaceMouse Compact");
  CHECK(kSpaceMouseDevice.find(0x256f, 0xffff)->name == "3Dconnexion SpaceMouse");
  CHECK(kPolhemusDevice.find(0x0f44, 0xbf01)->usable);
  CHECK_FALSE(kPolhemusDevice.find(0x0f44, 0xff21)->usable);
  CHECK(contains(std::string(kPolhemusDevice.find(0x0f44, 0xff21)->note), "firmware"));
  CHECK(kOsvrDevice.find(0x1532, 0x0300) == nullptr);
}

TEST_CASE("insonate-devices watch says whose pose it shows, and that only a device can be recorded raw") {
  const ProgramOutcome watched = run("watch synthetic:1 --seconds 0.1 2>&1");
  CHECK(watched.code == 0);
  CHECK(watched.output.find("synthetic hand 1\n") == 0);
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "program.raw";
  const ProgramOutcome refused = run("watch synthetic:1 --seconds 0.1 --record-raw " + file.string() + " 2>&1");
  CHECK(refused.code == 2);
  CHECK(contains(refused.output, "no device that sends bytes"));
  CHECK_FALSE(std::filesystem::exists(file));
  write_file(file,
             "insonate raw 1\ntracker spacemouse:\nstart 1 0 0 0 1 0 0 0 1 0 0 0\nopen 1 256f:c635\n"
             "read 1.5 015e0151ff0000\nread 1.52\nread 1.54\n");
  for (const char* as : {"", "raw:"}) {
    const ProgramOutcome checked = run("check " + (as + file.string()) + " 2>&1");
    CHECK(checked.code == 0);
    CHECK(contains(checked.output, "frames    3, 3 of them usable"));
  }
  const ProgramOutcome with_transform = run("check raw:" + file.string() + " --transform ProbeToTracker 2>&1");
  CHECK(with_transform.code == 2);
  CHECK(contains(with_transform.output, "no transforms to choose from"));
  std::filesystem::remove(file);
  CHECK(run("watch hydra: --seconds 0.1 --record-raw " + file.string() + " 2>&1").code == 0);
  const ProgramOutcome replayed = run("watch raw:" + file.string() + " 2>&1");
  CHECK(replayed.code == 2);
  CHECK(contains(replayed.output, "nothing in it became a sample"));
}

TEST_CASE("the udev rules open every device that a tracker uses") {
  const std::string rules = read_file(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "udev" / "70-insonate.rules");
  for (const TrackerKind& kind : tracker_kinds()) {
    if (!kind.device) continue;
    const std::string node = kind.device->bus == Bus::hid ? "KERNEL==\"hidraw*\"" : "SUBSYSTEM==\"usb\"";
    for (const DeviceKind::Model& model : kind.device->models) {
      char vendor[40], product[40];
      std::snprintf(vendor, sizeof vendor, "{idVendor}==\"%04x\"", model.vendor);
      std::snprintf(product, sizeof product, "{idProduct}==\"%04x\"", model.product);
      CAPTURE(vendor, product);
      bool opened = false;
      std::istringstream lines(rules);
      for (std::string line; std::getline(lines, line);)
        opened |= line.starts_with(node) && line.find(vendor) != std::string::npos &&
                  line.find("uaccess") != std::string::npos &&
                  (line.find("idProduct") == std::string::npos || line.find(product) != std::string::npos);
      CHECK(opened);
    }
  }
}
