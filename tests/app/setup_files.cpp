// What the window's tests of trackers need, in the folder given: pivot.igs.mha, a sensor that is pivoted, to be looped;
// lab.toml, a calibration of eight days ago that has all but the lag; and buttons.igs.mha, a probe whose buttons are
// pressed now and then.
//   setup_files FOLDER LANDMARKS

#include <cmath>
#include <ctime>
#include <filesystem>

#include "devices/calibration/steps/setup_step.h"
#include "devices/live/probe_buttons.h"
#include "devices/sequence/sequence.h"
#include "sim/files/files.h"
#include "tests/devices/calibration/hand.h"

using namespace insonate;

namespace {

/// Marks once, and goes on every six seconds, for as long as a slow machine may take.
std::vector<ProbeSample> pressed_now_and_then() {
  constexpr double kRate_hz = 20;
  std::vector<ProbeSample> samples;
  for (int i = 0; i < 400 * kRate_hz; ++i) {
    const double time_s = i / kRate_hz;
    ProbeSample sample{time_s, PoseStatus::ok, Pose{glm::dmat3(1.0), {0, 1, 10 * std::sin(time_s)}}, 0};
    if (time_s > 1 && time_s < 2) sample.buttons = kEventMarkerButton;
    if (std::fmod(time_s, 6) > 4 && std::fmod(time_s, 6) < 5) sample.buttons = kContinueButton;
    // Tracking is lost while they are held.
    if (std::abs(std::fmod(time_s, 3) - 1.5) < 0.2) sample = {time_s, PoseStatus::missing, Pose{}, 0};
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::filesystem::path folder = argv[1];
  const SetupInput given{.landmarks = read_landmark_list(argv[2]), .drawing = {}, .moved = false};
  const Lab lab;
  Hand pivoting(lab, 1), whole(lab, 2);
  pivoting.pivot(12);
  std::vector<ProbeSample> bare = as_raw(pivoting.samples());
  for (ProbeSample& sample : bare) sample.buttons = 0;
  write_file(folder / "pivot.igs.mha", write_sequence(bare));
  write_file(folder / "buttons.igs.mha", write_sequence(pressed_now_and_then()));

  whole.axes();
  whole.pivot(14);
  whole.face();
  whole.landmarks(given.landmarks->landmarks, 0.3);
  Calibration calibration;
  calibration.tracker = {"replay", ""};
  const std::int64_t made_s = std::int64_t(std::time(nullptr)) - 8 * 86400;
  std::size_t at = 0;
  for (const char* name : {"axes", "pivot", "face", "landmarks"}) {
    const auto step = begin_setup_step(name, calibration, given);
    while (at < whole.samples().size() && !step->view().done) step->feed(whole.samples()[at++]);
    if (!step->view().done) return 1;
    step->store(calibration, made_s);
  }
  write_calibration(folder / "lab.toml", calibration);
  return 0;
}
