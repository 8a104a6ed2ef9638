#include <glm/gtc/matrix_transform.hpp>

#include <cstdio>
#include <filesystem>
#include <string>

#include "scenarios/scenario.h"
#include "sim/files/files.h"
#include "tools/cli/program.h"
#include "tools/make_log/hand.h"
#include "tools/make_log/plan.h"

namespace {

using namespace insonate;

/// The tracker's pose relative to the patient. Any rigid transform works; the identity would test nothing.
Pose patient_from_tracker() {
  const glm::dmat4 turned =
      glm::rotate(glm::rotate(glm::dmat4(1.0), glm::radians(90.0), {1, 0, 0}), glm::radians(-25.0), {0, 1, 0});
  return {glm::dmat3(turned), {-420, 150, -60}};
}

std::string numbers(const Pose& pose) {
  std::string text;
  char number[32];
  const glm::dmat4 m = pose.matrix();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      // Micrometres and microradians are far below a tracker's resolution, and keep the file small.
      std::snprintf(number, sizeof number, row == 3 ? "%.0f " : column == 3 ? "%.3f " : "%.6f ", m[column][row]);
      text += number;
    }
  return text;
}

const char* plus_word(PoseStatus status) {
  switch (status) {
    case PoseStatus::ok:
      return "OK";
    case PoseStatus::out_of_view:
      return "OUT_OF_VIEW";
    case PoseStatus::out_of_volume:
      return "OUT_OF_VOLUME";
    case PoseStatus::invalid:
      return "INVALID";
    default:
      return "MISSING";
  }
}

/// Returns a sequence file as PLUS records it from a tracker without knowledge of the patient: poses in the tracker's
/// frame, and the tracker's pose. A lost probe keeps its last pose, as with many trackers; its status marks it as
/// unusable.
std::string plus_sequence(const MadeLog& made) {
  const std::vector<ProbeSample>& samples = made.samples;
  const Pose tracker_from_patient = patient_from_tracker().inverse();
  std::string text =
      "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\n"
      "BinaryDataByteOrderMSB = False\nCenterOfRotation = 0 0 0\nCompressedData = False\nDimSize = 0 0 " +
      std::to_string(samples.size()) +
      "\nElementSpacing = 1 1 1\nElementType = MET_UCHAR\nKinds = domain domain list\nOffset = 0 0 0\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nUltrasoundImageOrientation = MF\nUltrasoundImageType = BRIGHTNESS\n"
      "TrackerToPatientTransform = " +
      numbers(patient_from_tracker()) + "\n";
  Pose last;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    char frame[32];
    std::snprintf(frame, sizeof frame, "Seq_Frame%04zu_", i);
    char time[32];
    std::snprintf(time, sizeof time, "%.4f", samples[i].time_s);
    if (samples[i].status == PoseStatus::ok) last = tracker_from_patient * samples[i].patient_from_probe;
    text += std::string(frame) + "FrameNumber = " + std::to_string(i) + "\n";
    text += std::string(frame) + "ProbeToTrackerTransform = " + numbers(last) + "\n";
    text += std::string(frame) + "ProbeToTrackerTransformStatus = " + plus_word(samples[i].status) + "\n";
    text += std::string(frame) + "Timestamp = " + time + "\n";
    if (const auto done = made.actions.find(samples[i].time_s); done != made.actions.end())
      text += std::string(frame) + "Actions = " + to_text(done->second) + "\n";
    text += std::string(frame) + "ImageStatus = INVALID\n";
  }
  return text + "ElementDataFile = LOCAL\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments(
      "Make a tracker log of a made-up scan: move a probe over a scenario's case as a hand would, following a "
      "plan.\n\n  insonate-make-log assets/logs/ruq_good.toml ruq_good.igs.mha",
      "insonate-make-log");
  std::filesystem::path plan_file;
  std::filesystem::path log;
  arguments.add_option("PLAN", plan_file, "Follow this plan (TOML)")->type_name("FILE")->required();
  arguments.add_option("LOG", log, "Write this log, a PLUS/IGSIO sequence file (.igs.mha)")
      ->type_name("FILE")
      ->required();

  return run_program(arguments, argc, argv, [&] {
    const LogPlan plan = read_log_plan(plan_file);
    const Case subject = load_case(read_scenario(plan.scenario, plan.scenario_seed), assets_folder(), cache_folder());
    const MadeLog made = move_by_hand(plan, subject);
    write_file(log, plus_sequence(made));
    std::printf("%s: %zu frames, %.1f s\n", log.string().c_str(), made.samples.size(), made.samples.back().time_s);
    return 0;
  });
}
