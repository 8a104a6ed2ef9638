// Recordings that PLUS's own writers made, held against numbers that plus/derive_numbers.py read from them.
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>

#include "devices/log_report.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/recorded_images.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"

using namespace insonate;
using Catch::Contains;

namespace {

const std::filesystem::path kFolder = std::filesystem::path(INSONATE_SCANS_FOLDER) / "plus";

bool is_there() {
  if (std::filesystem::exists(kFolder)) return true;
  WARN("skipped: PLUS's recordings are not at " << kFolder);
  return false;
}

std::string refusal(const std::string& name, const RecordingOptions& options = {}) {
  try {
    read_recorded_scan(kFolder / name, options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// @param error  of the file's rotations. Making them orthonormal moves their entries by less than that, and what lies
/// a
///               tracker's working distance away by as many times that.
void compare_pose(const Pose& pose, const nlohmann::json& rows, double error) {
  constexpr double kDistance_mm = 300;
  for (int row = 0; row < 3; ++row) {
    const auto expected = [&](int column) { return double(rows[std::size_t(row)][std::size_t(column)]); };
    for (int column = 0; column < 3; ++column)
      CHECK(pose.rotation[column][row] == Approx(expected(column)).margin(error));
    CHECK(pose.translation[row] == Approx(expected(3)).margin(error * kDistance_mm));
  }
  CHECK(orthonormal_error(pose.rotation) < 1e-12);
}

void compare_images(const RecordedScan& scan, const nlohmann::json& images) {
  REQUIRE(scan.images);
  ImageReader reader(*scan.images);
  const auto width = int(images[0]), height = int(images[1]);
  // Backwards, so that every image needs its own place to be found.
  for (std::size_t f = scan.samples.size(); f-- > 0;) {
    const Image<std::uint8_t>& grey = reader.grey(scan.images->frames[f].number);
    CAPTURE(f);
    REQUIRE(grey.width == width);
    REQUIRE(grey.height == height);
    CHECK(std::accumulate(grey.pixels.begin(), grey.pixels.end(), 0L) == long(images[2][f]["sum"]));
    CHECK(grey.at(width / 3, height / 3) == int(images[2][f]["pixel"]));
  }
}

}  // namespace

TEST_CASE("what is read of PLUS's recordings is what an independent reader finds") {
  if (!is_there()) return;
  const auto expected =
      nlohmann::json::parse(read_file(std::string(INSONATE_PLUS_NUMBERS_FOLDER) + "/plus_recordings.json"));
  const std::map<std::string, RecordingOptions> options = {
      {"BkCurvilinearScanConvertedData.igs.mha", {.transform = "StylusToTracker"}},
      {"Prostate10_tracker.igs.mha", {.transform = "ToolToTracker"}},
      {"SegmentationTest_BKMedical_RandomStepperMotionData2_Trimmed_Cropped_FlipX.igs.mha",
       {.transform = "ToolToTracker", .rate_hz = 10}}};
  int compared = 0;
  for (const auto& [name, numbers] : expected.items()) {
    if (name == "NrrdSample.igs.nrrd") continue;  // without poses, as below
    CAPTURE(name);
    const auto with = options.find(name);
    const RecordedScan scan =
        read_recorded_scan(kFolder / name, with == options.end() ? RecordingOptions{} : with->second);
    CHECK(scan.samples.size() == std::size_t(numbers["frames"]));
    CHECK(check_log(scan).usable == std::size_t(numbers["usable"]));
    const double error = std::max(scan.recording.repairs.worst_rotation_error, 1e-5);
    for (const auto& [frame, matrix] : numbers["poses"].items()) {
      CAPTURE(frame);
      const ProbeSample& sample = scan.samples[std::stoul(frame)];
      REQUIRE(sample.status == PoseStatus::ok);
      compare_pose(sample.patient_from_probe, matrix, error);
      ++compared;
    }
    if (!numbers["times"].empty()) {
      CHECK(scan.samples.front().time_s == double(numbers["times"].front()));
      CHECK(scan.samples.back().time_s == double(numbers["times"].back()));
    }
    CHECK(scan.images.has_value() == !numbers["images"].empty());
    if (scan.images) compare_images(scan, numbers["images"]);
  }
  CHECK(compared == 25);
}

TEST_CASE("PLUS's recordings that do not show where the probe was are refused with what to do") {
  if (!is_there()) return;
  CHECK_THAT(
      refusal("BkCurvilinearScanConvertedData.igs.mha"),
      Contains("it has ReferenceToTracker, StylusToTracker") && Contains("such as StylusToTracker: by --transform"));
  CHECK_THAT(refusal("Prostate10_tracker.igs.mha"), Contains("it has ToolToTracker"));
  const std::string stepper = "SegmentationTest_BKMedical_RandomStepperMotionData2_Trimmed_Cropped_FlipX.igs.mha";
  CHECK_THAT(refusal(stepper), Contains("such as ToolToTracker: by --transform"));
  CHECK_THAT(refusal(stepper, {.transform = "ToolToTracker"}), Contains("no Timestamp") && Contains("?rate=HZ"));
  CHECK_THAT(refusal("NrrdSample.igs.nrrd"), Contains("its frames have no transforms") && Contains("with a tracker"));
}

TEST_CASE("rotations of PLUS that are off by more than rounding are replaced and counted") {
  if (!is_there()) return;
  const RecordedScan scan = read_recorded_scan(kFolder / "WaterTankBottomTranslationTrackerBuffer-trimmed.igs.mha");
  CHECK(scan.recording.transform == "ProbeToTracker, TrackerToReference");
  CHECK(scan.recording.repairs.rounded_rotations > 0);
  CHECK(scan.recording.repairs.worst_rotation_error > kRoundingToSixDecimals);
  CHECK(scan.recording.repairs.worst_rotation_error < 5e-4);
  const RecordedScan exact = read_recorded_scan(kFolder / "SlidingProbeTrackingData.igs.mha");
  CHECK(exact.recording.repairs.rounded_rotations == 0);
}
