// The trainer with a live tracker: what its device sends is recorded, and its set-up is found again.
#include <catch2/catch.hpp>
#include <unistd.h>

#include <cmath>

#include "app/trainer/options.h"
#include "app/trainer/trainer.h"
#include "devices/calibrated_tracker.h"
#include "devices/igtl/igtl_server.h"
#include "devices/live/steady_clock.h"
#include "devices/replay/read_log.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/case.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/test_samples.h"
#include "tests/gl/test_context.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

struct Folder : TemporaryFolder {
  Folder() { write_case(path / "tiny", tiny_case()); }
};

/// A server, and a trainer's options to follow it.
struct Lab {
  Folder folder;
  igtl::Server server{igtl::numeric_address("127.0.0.1", 0), "a server"};
  Options options;
  Lab() {
    options.headless = true;
    options.case_folder = folder.path / "tiny";
    options.tracker = "igtl://127.0.0.1:" + std::to_string(server.address().port()) + "/Probe";
    options.out = folder.path / "out";
  }
};

/// Of a sensor 5 mm behind the face, and a mannequin that lies as the patient does.
Calibration calibration_of(const std::string& uri) {
  constexpr std::int64_t kMade_s = 1767225600;  // 2026-01-01
  Calibration calibration;
  calibration.tracker = tracker_identity(uri);
  calibration.tip = Dated<TipFit>{{}, kMade_s};
  calibration.face = Dated<FaceSetup>{FaceSetup{{Pose{glm::dmat3(1.0), {0, 5, 0}}, 0, 0}, "touch", 0}, kMade_s};
  MannequinSetup mannequin;
  mannequin.patient = mannequin.worst = "tiny";
  mannequin.landmarks.resize(7, {"a place", {}, {}, false});
  calibration.mannequin = Dated<MannequinSetup>{mannequin, kMade_s};
  return calibration;
}

/// Where the trainer shows the probe when the server says that it is at the origin.
std::optional<glm::dvec3> shown_place(Lab& lab, Trainer& trainer) {
  trainer.open_from_options();
  trainer.finish_loading();
  if (!trainer.session()) return std::nullopt;
  for (const double limit_s = steady_now_s() + 60; steady_now_s() < limit_s; usleep(2000)) {
    lab.server.publish(igtl::Server::Stream::pose, igtl::make_transform("Probe", 0, Pose{}));
    trainer.update(steady_now_s());
    if (trainer.session()->shown_pose()) return trainer.session()->shown_pose()->translation;
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("what a live tracker sends the trainer replays to the samples that the trainer recorded, to the bit") {
  const test::TestContext context;
  Lab lab;
  Options& options = lab.options;
  options.record = lab.folder.path / "run.igs.mha";
  options.record_raw = lab.folder.path / "run.raw";
  CHECK_NOTHROW(check(options));
  std::vector<ProbeSample> seen;
  {
    Trainer trainer(options);
    trainer.open_from_options();
    trainer.finish_loading();
    REQUIRE(trainer.session());
    CHECK(trainer.raw_file() == options.record_raw);
    int sent = 0;
    for (const double limit_s = steady_now_s() + 60; seen.size() < 50 && steady_now_s() < limit_s;) {
      lab.server.publish(igtl::Server::Stream::pose,
                         igtl::make_transform("Probe", 0, turned(sent, {1, 2, 3}, {std::sin(0.1 * sent), 2, 3})));
      ++sent;
      trainer.update(steady_now_s());
      const auto& latest = trainer.session()->latest_samples();
      seen.insert(seen.end(), latest.begin(), latest.end());
      usleep(2000);
    }
    trainer.finish_recording();
  }
  REQUIRE(seen.size() >= 50);
  CHECK(same_bits(read_log(options.record).samples, seen));
  std::vector<ProbeSample> replayed = read_log(options.record_raw).samples;
  REQUIRE(replayed.size() >= seen.size());  // what came after the last frame was not shown any more
  replayed.resize(seen.size());
  CHECK(same_bits(replayed, seen));
}

TEST_CASE("each session's bytes go to a file of their own, and say of what they are") {
  const test::TestContext context;
  Lab lab;
  lab.options.tracker = "hydra:";
  lab.options.calibration = lab.folder.path / "lab.toml";
  lab.options.record_raw = lab.folder.path / "run.raw";
  write_calibration(lab.options.calibration, calibration_of(lab.options.tracker));
  Trainer trainer(lab.options);
  trainer.open_from_options();
  trainer.finish_loading();
  REQUIRE(trainer.session());
  CHECK(trainer.raw_file() == lab.folder.path / "run.raw");
  INFO("what comes through a calibration are the sensor's poses");
  CHECK_THAT(read_file(trainer.raw_file()), Catch::Contains("\ntracker hydra:?raw=1&filter="));
  trainer.begin_setup();
  REQUIRE(trainer.setup());
  trainer.end_setup();
  REQUIRE(trainer.session());
  CHECK(trainer.raw_file() == lab.folder.path / "run-2.raw");
}

TEST_CASE("a tracker without bytes, none at all, and a file that is there are refused before anything is loaded") {
  const Folder folder;
  Options options;
  options.record_raw = folder.path / "run.raw";
  CHECK_THROWS_WITH(check(options), Catch::Contains("no tracker is named"));
  for (const char* uri : {"mouse:", "synthetic:3", "synthetic:3?live=1"}) {
    options.tracker = uri;
    CHECK_THROWS_WITH(check(options), Catch::Contains("it has no device that sends bytes"));
  }
  options.tracker = "hydra:";
  CHECK_NOTHROW(check(options));
  write_file(options.record_raw, "an earlier run");
  CHECK_THROWS_WITH(check(options), Catch::Contains("such a file already"));
}

TEST_CASE("a set-up that was made of this very tracker is used from the next start on, and any other is reported") {
  const test::TestContext context;
  Lab lab;
  const fs::path file = lab.options.out / "calibration.toml";
  SECTION("of this tracker") {
    write_calibration(file, calibration_of(lab.options.tracker));
    Trainer trainer(lab.options);
    CHECK(shown_place(lab, trainer) == glm::dvec3(0, 5, 0));
    CHECK(trainer.options().calibration == file);
    CHECK_THAT(trainer.session()->tracker_state().name, Catch::Contains(", calibrated 2026-01-01"));
    CHECK_THAT(trainer.calibration_warning(), Catch::Contains("days old"));
    CHECK_THAT(trainer.next_start(), Catch::Contains("used by itself") && Catch::Contains(lab.options.tracker));
  }
  SECTION("of another") {
    write_calibration(file, calibration_of("igtl://elsewhere/Probe"));
    Trainer trainer(lab.options);
    CHECK(shown_place(lab, trainer) == glm::dvec3(0));
    CHECK_THAT(trainer.calibration_warning(), Catch::Contains("another tracker"));
  }
  SECTION("one that is not complete") {
    Calibration begun = calibration_of(lab.options.tracker);
    begun.mannequin.reset();
    write_calibration(file, begun);
    Trainer trainer(lab.options);
    CHECK(shown_place(lab, trainer) == glm::dvec3(0));
    CHECK_THAT(trainer.calibration_warning(), Catch::Contains("the step 'landmarks' has not been made"));
  }
  SECTION("one that is damaged stops nobody, as nobody has named it") {
    write_file(file, "no calibration");
    Trainer trainer(lab.options);
    CHECK(shown_place(lab, trainer) == glm::dvec3(0));
    CHECK_THAT(trainer.calibration_warning(), Catch::Contains(file.string()));
  }
  SECTION("a file that is named counts") {
    write_file(file, "no calibration");
    lab.options.calibration = lab.folder.path / "lab.toml";
    write_calibration(lab.options.calibration, calibration_of(lab.options.tracker));
    Trainer trainer(lab.options);
    CHECK(shown_place(lab, trainer) == glm::dvec3(0, 5, 0));
    CHECK_THAT(trainer.next_start(), Catch::Contains("--calibration " + lab.options.calibration.string()));
  }
}
