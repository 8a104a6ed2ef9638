#include "app/trainer/setup_wizard.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "devices/replay/replay_tracker.h"
#include "sim/core/input_error.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/calibration/hand.h"

using namespace insonate;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

SetupInput given() {
  SetupInput made;
  made.landmarks = read_landmark_list(std::string(INSONATE_ASSETS_FOLDER) + "/calibration/abdomen.toml");
  return made;
}

SetupWizard wizard_of(const std::vector<SensorSample>& samples, const Calibration& base, const fs::path& file) {
  return SetupWizard(
      SensorTracker(std::make_unique<ReplayTracker>("a sensor", as_raw(samples), ReplayTracker::Options{})), base,
      given(), file);
}

Calibration none_yet() {
  Calibration calibration;
  calibration.tracker = {"hydra", "1"};
  return calibration;
}

void run(SetupWizard& wizard, double from_s, double to_s) {
  for (double now_s = from_s; now_s < to_s; now_s += 1.0 / 30) wizard.update(now_s);
}

/// The whole set-up, with a button pressed after each step to go on.
std::vector<SensorSample> whole_setup() {
  const Lab lab;
  Hand hand(lab, 7);
  const auto go_on = [&] {
    hand.hold(Pose{}, 0.5);
    hand.hold(Pose{}, 0.2, true);
    hand.hold(Pose{}, 0.2);
  };
  hand.hold(Pose{}, 0.2);
  hand.axes();
  go_on();
  hand.pivot(14);
  go_on();
  hand.face();
  go_on();
  hand.landmarks(given().landmarks->landmarks, 0.3);
  go_on();
  hand.knocks(0.05);
  hand.hold(Pose{}, 4);  // a press that comes with the last blows would be taken for one
  go_on();
  return hand.samples();
}

}  // namespace

TEST_CASE("the whole set-up is made with the probe's buttons alone, and is in the file after each step") {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "lab.toml";
  const std::vector<SensorSample> samples = whole_setup();
  SetupWizard wizard = wizard_of(samples, none_yet(), file);
  std::size_t steps_in_file = 0;
  for (double now_s = 0; now_s < samples.back().time_s + 1; now_s += 1.0 / 30) {
    wizard.update(now_s);
    if (!fs::exists(file)) continue;
    const Calibration kept = read_calibration(file);
    const std::size_t made = std::size_t(kept.axes.has_value()) + kept.tip.has_value() + kept.face.has_value() +
                             kept.mannequin.has_value() + kept.lag.has_value();
    CHECK(made >= steps_in_file);
    CHECK(made == wizard.current() + std::size_t(wizard.view().done));
    steps_in_file = made;
  }
  CHECK(steps_in_file == kSetupSteps.size());
  CHECK(wizard.finished());
  CHECK(why_incomplete(wizard.calibration()).empty());
  CHECK(wizard.calibration().mannequin->value.accuracy_mm < 2);
  for (const SetupWizard::Row& row : wizard.rows()) CHECK_FALSE(row.figure.empty());
}

TEST_CASE("a set-up goes on where it was left, and to any step that can be made") {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "lab.toml";
  const std::vector<SensorSample> samples = whole_setup();
  SetupWizard first = wizard_of(samples, none_yet(), file);
  double now_s = 0;
  for (; first.current() < 2; now_s += 1.0 / 30) first.update(now_s);

  SetupWizard wizard = wizard_of(samples, read_calibration(file), file);
  CHECK(wizard.current() == 2);
  wizard.go_to(0);
  CHECK(wizard.current() == 0);
  wizard.go_to(3);
  CHECK(wizard.current() == 3);
  CHECK(wizard.landmarks().size() == given().landmarks->landmarks.size());
  wizard.set_moved(true);
  CHECK_FALSE(wizard.moved());  // no landmarks were ever touched

  SetupWizard fresh = wizard_of(samples, none_yet(), file);
  CHECK(fresh.current() == 0);
  CHECK_THAT(fresh.why_not(2), Contains("tip"));
  fresh.go_to(2);
  CHECK(fresh.current() == 0);
}

TEST_CASE("marks of the keyboard are taken back, and a file that cannot be written is reported") {
  const TemporaryFolder folder;
  const std::vector<SensorSample> samples = whole_setup();
  SetupWizard wizard = wizard_of(samples, none_yet(), folder.path / "lab.toml");
  wizard.mark(0);  // before any pose has come
  wizard.update(0);
  wizard.update(0.1);
  CHECK(wizard.view().part == 0);
  wizard.mark(0.1);
  wizard.update(0.15);
  CHECK(wizard.view().part == 1);
  wizard.undo();
  CHECK(wizard.view().part == 0);

  std::ofstream(folder.path / "file") << "no folder";
  SetupWizard nowhere = wizard_of(samples, none_yet(), folder.path / "file" / "lab.toml");
  CHECK_THROWS_AS(run(nowhere, 0, samples.back().time_s), InputError);
}
