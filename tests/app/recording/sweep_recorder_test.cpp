#include "app/recording/sweep_recorder.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <cmath>

#include "sim/core/input_error.h"
#include "sim/volume/ct_reader.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A picture at `z_mm` along the elevation of a probe whose frame is the patient's. Its grey level is 2 per mm of
/// depth, within the fan and outside of it.
DrawnPicture picture_at(double z_mm, double time_s) {
  const Probe& probe = probes().front();
  DrawnPicture picture;
  picture.probe = probe.name;
  picture.depth_mm = 80;
  picture.geometry = image_geometry(probe, picture.depth_mm, 160, 120);
  picture.patient_from_probe = {glm::dmat3(1.0), {0, 0, z_mm}};
  picture.time_s = time_s;
  picture.attempt = 1;
  picture.grey = Image<std::uint8_t>(160, 120);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      picture.grey.at(x, y) = std::uint8_t(std::lround(std::max(0.0, 2 * picture.geometry.plane_mm(x, y).y)));
  return picture;
}

std::shared_ptr<const SweptVolume> finished(SweepRecorder& recorder) {
  recorder.stop();
  recorder.wait();
  return recorder.take_finished();
}

/// Returns the voxel nearest to a patient point, or nothing.
int voxel(const Volume<std::uint8_t>& volume, const glm::dvec3& patient_mm) {
  const glm::ivec3 index = glm::ivec3(glm::round(volume.grid.index_from_patient(patient_mm)));
  return volume.grid.contains(index) ? volume.at(index) : -1;
}

}  // namespace

TEST_CASE("a sweep's live pictures become a volume at their places in the patient") {
  SweepRecorder recorder;
  CHECK_FALSE(recorder.take_finished());
  recorder.start();
  CHECK(recorder.running());
  for (int n = 0; n <= 20; ++n) recorder.take(picture_at(n, 10 + 0.05 * n));
  CHECK(recorder.quality().pictures == 21);
  const auto swept = finished(recorder);
  REQUIRE(swept);
  CHECK_FALSE(recorder.take_finished());
  CHECK(swept->quality.is_good());
  CHECK(swept->quality.length_mm == Approx(20));
  CHECK(swept->quality.duration_s == Approx(1));
  CHECK(voxel(swept->volume.known, {0, 40, 10}) > 0);
  // A voxel's centre lies within 0.35 mm of the point along the depth, and a pixel is 0.6 mm.
  CHECK(voxel(swept->volume.grey, {0, 40, 10}) == Approx(80).margin(2));
  CHECK(voxel(swept->volume.grey, {5, 60, 15}) == Approx(120).margin(2));
  CHECK(voxel(swept->volume.known, {0, -20, 10}) <= 0);  // behind the face there is no fan
}

TEST_CASE("frozen pictures and those of another attempt are not part of a sweep") {
  SweepRecorder recorder;
  recorder.take(picture_at(0, 1));
  CHECK(recorder.quality().pictures == 0);
  recorder.start();
  recorder.take(picture_at(0, 1));
  DrawnPicture frozen = picture_at(5, 1.1);
  frozen.frozen = true;
  recorder.take(frozen);
  recorder.take(picture_at(1, 1));  // not later
  recorder.take(picture_at(1, 1.2));
  CHECK(recorder.quality().pictures == 2);
  DrawnPicture other = picture_at(50, 1.3);
  other.attempt = 2;
  recorder.take(other);
  CHECK_FALSE(recorder.running());
  const auto swept = finished(recorder);
  REQUIRE(swept);
  CHECK(swept->quality.pictures == 2);
  CHECK(voxel(swept->volume.known, {0, 40, 50}) <= 0);
}

TEST_CASE("a sweep that was too fast says so, and its gap is not filled") {
  SweepRecorder recorder;
  recorder.start();
  for (int n = 0; n <= 10; ++n) recorder.take(picture_at(n + (n > 5 ? 9 : 0), 0.05 * n));
  const auto swept = finished(recorder);
  REQUIRE(swept);
  REQUIRE(swept->quality.flaws.size() == 1);
  CHECK(swept->quality.flaws[0].words() == "gap of 10.0 mm at 5 mm");
  CHECK(voxel(swept->volume.known, {0, 40, 10}) == 0);
  CHECK(voxel(swept->volume.known, {0, 40, 3}) > 0);
}

TEST_CASE("a sweep without pictures is refused in a sentence, and the next one works") {
  SweepRecorder recorder;
  recorder.start();
  recorder.stop();
  recorder.wait();
  CHECK_THROWS_AS(recorder.take_finished(), InputError);
  CHECK_FALSE(recorder.reconstructing());
  recorder.start();
  for (int n = 0; n < 3; ++n) recorder.take(picture_at(n, n));
  CHECK(finished(recorder));
}

TEST_CASE("a recorder that is destroyed in the middle of a sweep drops it") {
  SweepRecorder recorder;
  recorder.start();
  for (int n = 0; n < 5; ++n) recorder.take(picture_at(n, n));
}

TEST_CASE("a swept volume reads back from its files as it was") {
  const TemporaryFolder temporary;
  const fs::path& folder = temporary.path;
  SweepRecorder recorder;
  recorder.start();
  for (int n = 0; n < 5; ++n) recorder.take(picture_at(n, n));
  const auto swept = finished(recorder);
  REQUIRE(swept);
  write_swept(folder / "swept.nrrd", *swept);
  const Volume<std::uint8_t> grey = read_labels(folder / "swept.nrrd"),
                             known = read_labels(folder / "swept-known.nrrd");
  CHECK(grey.voxels == swept->volume.grey.voxels);
  CHECK(known.voxels == swept->volume.known.voxels);
  CHECK(grey.grid.size == swept->volume.grey.grid.size);
  CHECK(glm::distance(grey.grid.origin, swept->volume.grey.grid.origin) < 1e-6);
}
