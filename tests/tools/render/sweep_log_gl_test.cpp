// Tests insonate-render --sweep-log: a recording's images become a volume.

#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include "devices/record/sequence_recorder.h"
#include "devices/replay/read_log.h"
#include "sim/volume/ct_reader.h"
#include "tests/core/run_program.h"
#include "tests/reconstruction/swept_scene.h"
#include "tests/tools/render/nrrd_file.h"

using namespace insonate;
using insonate::test::NrrdFile;
namespace fs = std::filesystem;

namespace {

constexpr double kRadius_mm = 8;

/// A folder, and a recording in it of a hand that sweeps over a bright ball in a grey block.
struct SweptBall {
  TemporaryFolder folder;
  HandSweep sweep;
  glm::dvec3 centre{0.0};

  explicit SweptBall(HandSweep hand = {}) : sweep(hand), centre(hand.middle()) {
    SequenceRecorder recorder(folder.path / "swept.igs.mha", sweep.width, sweep.height);
    double time_s = 1;
    for (const Pose& pose : sweep.poses()) {
      const TrackedPicture picture =
          picture_of([&](const glm::dvec3& at) { return glm::distance(at, centre) < kRadius_mm ? 180 : 60; }, pose,
                     sweep.geometry(), rectangle_region(sweep.width, sweep.height, {0, 0, sweep.width, sweep.height}));
      recorder.add({time_s, PoseStatus::ok, pose}, picture.grey, patient_from_pixel(Pose{}, sweep.geometry()));
      time_s += 1 / sweep.rate_hz;
    }
    recorder.add({time_s, PoseStatus::missing, {}}, Image<std::uint8_t>(sweep.width, sweep.height, 255),
                 patient_from_pixel(Pose{}, sweep.geometry()));
    recorder.finish();
  }
  std::string in(const char* name) const { return (folder.path / name).string(); }
  ProgramOutcome render(const std::string& arguments) const {
    return run_program(INSONATE_RENDER_PROGRAM " " + arguments);
  }
};

/// Returns the centre and the radius of what is brighter than half.
std::pair<glm::dvec3, double> ball_in(const Volume<std::uint8_t>& volume) {
  glm::dvec3 sum(0.0);
  double inside = 0;
  for (int k = 0; k < volume.grid.size.z; ++k)
    for (int j = 0; j < volume.grid.size.y; ++j)
      for (int i = 0; i < volume.grid.size.x; ++i) {
        if (volume.at({i, j, k}) < 120) continue;
        sum += volume.grid.patient_from_index({i, j, k});
        ++inside;
      }
  return {sum / inside, std::cbrt(inside * std::pow(volume.grid.spacing.x, 3) * 3 / (4 * M_PI))};
}

}  // namespace

TEST_CASE("a recording's images become a volume at their place in the patient") {
  const SweptBall swept;
  for (const std::string how : {"", "--insertion nearest ", "--compounding maximum --hole-radius 0 "}) {
    const ProgramOutcome outcome = swept.render("--sweep-log " + swept.in("swept.igs.mha") + " --voxel 0.6 " + how +
                                                swept.in("volume.nrrd") + " --known " + swept.in("known.nrrd"));
    INFO(how << outcome.errors);
    REQUIRE(outcome.code == 0);
    const auto volume = NrrdFile(swept.in("volume.nrrd")).volume<std::uint8_t>();
    CHECK(volume.grid.spacing.x == Approx(0.6));
    const auto [centre, radius_mm] = ball_in(volume);
    CHECK(glm::distance(centre, swept.centre) < 0.3);
    CHECK(std::abs(radius_mm - kRadius_mm) < 0.3);
    const auto known = NrrdFile(swept.in("known.nrrd")).volume<std::uint8_t>();
    CHECK(known.grid == volume.grid);
    for (std::size_t n = 0; n < known.voxels.size(); ++n)
      if ((known.voxels[n] == 0) != (volume.voxels[n] == 0)) FAIL("a voxel is not known, or not grey");
    INFO(outcome.output);
    CHECK(outcome.output.find("Even: 60 pictures over 30 mm in 2.9 s") == 0);
    CHECK(outcome.output.find("\nFrames without a pose, left out: 1.") != std::string::npos);
    // The project's own reader takes it as what it is.
    CHECK(read_labels(swept.in("volume.nrrd")).voxels == volume.voxels);
  }
}

TEST_CASE("a part of the images, or the fan of a probe, can be taken alone") {
  const SweptBall swept;
  const auto measured = [&](const std::string& how) {
    const ProgramOutcome outcome =
        swept.render("--sweep-log " + swept.in("swept.igs.mha") + " " + how + " " + swept.in("volume.nrrd"));
    INFO(how << outcome.errors);
    REQUIRE(outcome.code == 0);
    const auto volume = NrrdFile(swept.in("volume.nrrd")).volume<std::uint8_t>();
    return double(volume.grid.count() - std::size_t(std::count(volume.voxels.begin(), volume.voxels.end(), 0)));
  };
  const double all = measured("");
  CHECK(measured("--clip 24,20,48,40") / all == Approx(0.25).margin(0.06));
  // A linear probe of 40 mm over 30 of 40 mm of depth; the pictures are 48 mm wide.
  CHECK(measured("--probe linear --depth 30") / all == Approx(40 / 48.0 * 30 / 40).margin(0.06));
}

TEST_CASE("a hasty sweep is called uneven, with where and when") {
  HandSweep hasty;
  hasty.step_mm = 5;
  hasty.pictures = 21;
  hasty.tremor_deg = 0;
  const SweptBall swept(hasty);
  const ProgramOutcome outcome =
      swept.render("--sweep-log " + swept.in("swept.igs.mha") + " " + swept.in("volume.nrrd"));
  REQUIRE(outcome.code == 0);
  CHECK(outcome.output.find(
            "Uneven: 21 pictures over 100 mm in 1.0 s, up to 5.0 mm apart.\n  gap of 5.0 mm at 0 mm\n") == 0);
  const ProgramOutcome filled =
      swept.render("--sweep-log " + swept.in("swept.igs.mha") + " --hole-radius 4 " + swept.in("volume.nrrd"));
  REQUIRE(filled.code == 0);
  CHECK(filled.output.find("too fast between 0.0 s and 1.0 s\n") != std::string::npos);
}

TEST_CASE("what cannot be reconstructed is refused in a sentence") {
  const SweptBall swept;
  const std::string log = "--sweep-log " + swept.in("swept.igs.mha") + " ", volume = swept.in("volume.nrrd");
  swept.folder.put("sheared.txt", "0.2 0.1 0 0  0 0.2 0 0  0 0 0.2 0  0 0 0 1");
  swept.folder.put("huge.txt", "20 0 0 0  0 20 0 0  0 0 20 0  0 0 0 1");
  swept.folder.put("open.txt", "1 0 0 0  0 1 0 0  0 0 1 0  0 0 1 1");
  swept.folder.put("two.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  {
    SequenceRecorder recorder(swept.folder.path / "dark.igs.mha");
    recorder.add({1, PoseStatus::ok, {}});
    recorder.add({2, PoseStatus::ok, {}});
    recorder.finish();
  }
  const auto refused = [&](const std::string& arguments, const std::string& sentence) {
    const ProgramOutcome outcome = swept.render(arguments);
    INFO(arguments << ": " << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.errors.find(sentence) != std::string::npos);
    CHECK_FALSE(fs::exists(volume));
  };
  refused(log + swept.in("volume.png"), "volume.png: a sweep is written as NRRD; name a file that ends in .nrrd.");
  refused(log + "--known x.mha " + volume, "x.mha: a volume is written as NRRD");
  refused(log + "--clip 0,0,97,10 " + volume, "--clip: the rectangle is not within the images of 96 x 80 pixels");
  refused(log + "--image-to-probe " + swept.in("sheared.txt") + " " + volume, "rows and columns are not perpendicular");
  refused(log + "--image-to-probe " + swept.in("huge.txt") + " " + volume, "a pixel is not from 0.001 mm to 10 mm");
  refused(log + "--image-to-probe " + swept.in("open.txt") + " " + volume, "the last row is not 0 0 0 1");
  refused(log + "--image-to-probe " + swept.in("two.txt") + " " + volume, "there are 2 matrices, not one");
  refused(log + "--ct x.nrrd " + volume, "--case excludes --sweep-log");
  refused("--clip 0,0,9,9 " + volume, "--clip requires --sweep-log");
  refused("--sweep-log " + swept.in("dark.igs.mha") + " " + volume, "dark.igs.mha: it holds no images");
}

TEST_CASE("a recording of PLUS becomes a volume that shows each of its images where it was taken") {
  const fs::path log = INSONATE_SCANS_FOLDER "/plus/NwirePhantomFreehandCropped.igs.mha";
  if (!fs::exists(log)) {
    WARN("the folder of real scans is not here: " << log);
    return;
  }
  const TemporaryFolder folder;
  const std::string matrix = "0.15 0 0 -15  0 0.15 0 2  0 0 0.15 0  0 0 0 1";
  const std::string volume_file = (folder.path / "volume.nrrd").string();
  const auto matrix_file = folder.put("image_to_probe.txt", matrix);
  REQUIRE(run_program(INSONATE_RENDER_PROGRAM " --sweep-log " + log.string() + " " + volume_file).code == 2);
  const ProgramOutcome outcome =
      run_program(INSONATE_RENDER_PROGRAM " --sweep-log " + log.string() + " --image-to-probe " + matrix_file.string() +
                  " --voxel 0.15 " + volume_file + " >/dev/null");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  const auto volume = NrrdFile(volume_file).volume<std::uint8_t>();

  const RecordedScan scan = read_log(log);
  ImageReader reader(*scan.images);
  double off = 0, off_beside = 0, pixels = 0;
  for (std::size_t n = 0; n < scan.samples.size(); ++n) {
    const Image<std::uint8_t>& image = reader.grey(scan.images->frames[n].number);
    for (int y = 6; y < image.height - 6; y += 3)
      for (int x = 6; x < image.width - 6; x += 3) {
        const glm::dvec3 at = scan.samples[n].patient_from_probe.point({0.15 * x - 15, 0.15 * y + 2, 0});
        const int grey = sample_nearest(volume, volume.grid.index_from_patient(at));
        off += std::abs(grey - int(image.at(x, y)));
        off_beside += std::abs(grey - int(image.at(x + 5, y + 5)));
        ++pixels;
      }
  }
  CHECK(off / pixels < 5);
  CHECK(off_beside > 2 * off);
}
