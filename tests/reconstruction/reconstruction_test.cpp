#include "sim/reconstruction/reconstruction.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <array>
#include <map>

#include "sim/reconstruction/sweep_extent.h"
#include "tests/reconstruction/swept_scene.h"

using namespace insonate;

namespace {

constexpr auto kMeasured = std::uint8_t(VoxelKnown::measured);

ReconstructedVolume reconstructed(const std::vector<TrackedPicture>& pictures, double voxel_mm,
                                  const ReconstructionSettings& settings = {}) {
  Reconstruction reconstruction(choose_grid(pictures, voxel_mm).grid, settings);
  for (const TrackedPicture& picture : pictures) reconstruction.add(picture);
  return reconstruction.filled();
}

template <typename Use>
void for_each_voxel(const Grid& grid, Use use) {
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) use(glm::ivec3(i, j, k));
}

bool equal(const ReconstructedVolume& a, const ReconstructedVolume& b) {
  return a.grey.grid == b.grey.grid && a.grey.voxels == b.grey.voxels && a.known.voxels == b.known.voxels;
}

/// A picture of one row of pixels, 1 mm apart, from the origin along the patient's x.
TrackedPicture row_of(const std::vector<std::uint8_t>& greys, const glm::dvec3& first_mm, double time_s) {
  TrackedPicture picture;
  picture.grey = Image<std::uint8_t>(int(greys.size()), 1);
  picture.grey.pixels = greys;
  picture.region = rectangle_region(int(greys.size()), 1, {0, 0, int(greys.size()), 1});
  picture.patient_from_pixel[3] = glm::dvec4(first_mm, 1);
  picture.time_s = time_s;
  return picture;
}

Grid unit_grid(const glm::ivec3& size) {
  Grid grid;
  grid.size = size;
  return grid;
}

}  // namespace

TEST_CASE("a ramp's values are reconstructed within what it changes over one voxel") {
  const HandSweep sweep;
  const glm::dvec3 middle = sweep.middle(), slope(1.1, 1.6, -0.9);
  const Scene ramp = [&](const glm::dvec3& at) { return 128 + glm::dot(slope, at - middle); };
  const double voxel_mm = 0.7, rounding = 1;
  for (const Insertion insertion : {Insertion::nearest, Insertion::trilinear}) {
    const ReconstructedVolume volume = reconstructed(sweep.pictures_of(ramp), voxel_mm, {insertion, {}, 2});
    // Samples of a voxel lie at most half a voxel from it along each axis, or one.
    const double reach = (insertion == Insertion::nearest ? 0.5 : 1.0) * voxel_mm;
    const glm::dvec3 along = glm::abs(glm::transpose(volume.grey.grid.direction) * slope);
    const double most = reach * (along.x + along.y + along.z) + rounding;
    double worst = 0, sum = 0;
    std::size_t measured = 0;
    for_each_voxel(volume.grey.grid, [&](const glm::ivec3& voxel) {
      if (volume.known.at(voxel) == 0) return;
      const double error = volume.grey.at(voxel) - ramp(volume.grey.grid.patient_from_index(glm::dvec3(voxel)));
      worst = std::max(worst, std::abs(error));
      sum += error;
      ++measured;
    });
    CHECK(measured > 50000);
    CHECK(worst < most);
    // No bias: a shift by a tenth of a voxel would show.
    CHECK(std::abs(sum / double(measured)) < 0.1 * voxel_mm * glm::length(slope));
  }
}

TEST_CASE("a ball is reconstructed at its place and in its size, to less than half a voxel") {
  const HandSweep sweep;
  const glm::dvec3 centre = sweep.middle() + glm::dvec3(0.13, -0.41, 0.22);
  const double radius_mm = 9, voxel_mm = 0.6;
  const Scene ball = [&](const glm::dvec3& at) { return glm::distance(at, centre) < radius_mm ? 200 : 40; };
  for (const Insertion insertion : {Insertion::nearest, Insertion::trilinear}) {
    const ReconstructedVolume volume = reconstructed(sweep.pictures_of(ball), voxel_mm, {insertion, {}, 2});
    glm::dvec3 sum(0.0);
    double inside = 0;
    for_each_voxel(volume.grey.grid, [&](const glm::ivec3& voxel) {
      const double share = (double(volume.grey.at(voxel)) - 40) / 160;
      if (volume.known.at(voxel) == 0) return;
      sum += share * volume.grey.grid.patient_from_index(glm::dvec3(voxel));
      inside += share;
    });
    CHECK(glm::distance(sum / inside, centre) < 0.1 * voxel_mm);
    const double volume_mm3 = inside * std::pow(voxel_mm, 3);
    CHECK(std::abs(std::cbrt(volume_mm3 * 3 / (4 * M_PI)) - radius_mm) < 0.1 * voxel_mm);
  }
}

TEST_CASE("a plane's edge lies where it is, to less than half a voxel") {
  const HandSweep sweep;
  const glm::dvec3 through = sweep.middle(), normal = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
  const Scene halves = [&](const glm::dvec3& at) { return glm::dot(at - through, normal) > 0 ? 220 : 20; };
  const double voxel_mm = 0.6;
  const ReconstructedVolume volume = reconstructed(sweep.pictures_of(halves), voxel_mm);
  std::size_t wrong = 0, seen = 0;
  for_each_voxel(volume.grey.grid, [&](const glm::ivec3& voxel) {
    if (volume.known.at(voxel) == 0) return;
    const double off_mm = glm::dot(volume.grey.grid.patient_from_index(glm::dvec3(voxel)) - through, normal);
    if (std::abs(off_mm) < voxel_mm / 2) return;
    ++seen;
    wrong += (volume.grey.at(voxel) > 120) != (off_mm > 0);
  });
  CHECK(seen > 50000);
  CHECK(wrong * 1000 < seen);
}

TEST_CASE("voxels are measured where pixels lie, filled between them, and unseen elsewhere") {
  const HandSweep sweep{.pictures = 12, .step_mm = 2.5, .tremor_deg = 0};
  const auto pictures = sweep.pictures_of([](const glm::dvec3&) { return 90; });
  for (const Insertion insertion : {Insertion::nearest, Insertion::trilinear}) {
    const ReconstructedVolume volume = reconstructed(pictures, 0.5, {insertion, {}, 1.5});
    const double reach = insertion == Insertion::nearest ? 0.5 : 1;
    std::array<std::size_t, 3> count{};
    std::size_t wrong = 0;
    for_each_voxel(volume.grey.grid, [&](const glm::ivec3& voxel) {
      const auto known = volume.known.at(voxel);
      ++count[known];
      const glm::dvec3 patient = volume.grey.grid.patient_from_index(glm::dvec3(voxel));
      const glm::dvec3 at = oblique_pose().inverse().point(patient);
      // Distances from the pixels along the axes of grid and pictures, which are the same up to the hand's tremor.
      double to_plane = 1e9;
      for (const Pose& pose : sweep.poses()) to_plane = std::min(to_plane, std::abs(pose.inverse().point(patient).z));
      const bool well_inside = std::abs(at.x) < 22 && at.y > 1 && at.y < 38 && at.z > 0.5 && at.z < 27;
      const bool well_outside = std::abs(at.x) > 26 || at.y < -2 || at.y > 43 || at.z < -1 || at.z > 29;
      if (well_inside && to_plane < (reach - 0.1) * 0.5) wrong += known != kMeasured;
      if (well_inside && to_plane > (reach + 0.1) * 0.5) wrong += known != std::uint8_t(VoxelKnown::filled);
      if (well_outside) wrong += known != 0;
      if (known != 0) wrong += volume.grey.at(voxel) != 90;
      if (known == 0) wrong += volume.grey.at(voxel) != 0;
    });
    CHECK(wrong == 0);
    CHECK(count[0] > 1000);
    CHECK(count[1] > 50000);
    CHECK(count[2] > 50000);
  }
}

TEST_CASE("pixels outside the fan are not used") {
  const Probe& probe = *find_probe("curvilinear");
  const ImageGeometry geometry = image_geometry(probe, 60, 120, 90);
  const auto region = fan_region(probe, 60, geometry);
  std::vector<TrackedPicture> pictures;
  for (int n = 0; n < 20; ++n) {
    const Pose pose = oblique_pose() * Pose{glm::dmat3(1.0), {0, 0, 0.5 * n}};
    pictures.push_back(picture_of([](const glm::dvec3&) { return 100; }, pose, geometry, region));
    for (std::size_t p = 0; p < pictures.back().grey.pixels.size(); ++p)
      if (!region->inside.pixels[p]) pictures.back().grey.pixels[p] = 255;  // letters and bars of a screen
  }
  const double voxel_mm = 0.8;
  const ReconstructedVolume volume = reconstructed(pictures, voxel_mm);
  const Pose probe_from_patient = oblique_pose().inverse();
  std::size_t known = 0, beyond = 0, bright = 0;
  for_each_voxel(volume.grey.grid, [&](const glm::ivec3& voxel) {
    if (volume.known.at(voxel) == 0) return;
    ++known;
    bright += volume.grey.at(voxel) != 100;
    const glm::dvec3 at = probe_from_patient.point(volume.grey.grid.patient_from_index(glm::dvec3(voxel)));
    bool near = false;
    for (const double dx : {-1, 0, 1})
      for (const double dy : {-1, 0, 1})
        near = near || line_position(probe, 60, glm::dvec2(at) + 1.5 * voxel_mm * glm::dvec2(dx, dy));
    beyond += !near || at.z < -1.01 * voxel_mm || at.z > 9.5 + 1.01 * voxel_mm;
  });
  CHECK(known > 50000);
  CHECK(bright == 0);
  CHECK(beyond == 0);
}

TEST_CASE("the mean, the largest or the latest of pictures is taken") {
  const std::map<Compounding, std::vector<int>> expected{{Compounding::mean, {60, 107, 120}},
                                                         {Compounding::maximum, {100, 200, 150}},
                                                         {Compounding::latest, {20, 90, 120}}};
  for (const Insertion insertion : {Insertion::nearest, Insertion::trilinear})
    for (const auto& [compounding, values] : expected) {
      Reconstruction reconstruction(unit_grid({4, 2, 2}), {insertion, compounding, 0});
      reconstruction.add(row_of({100, 30, 90}, {0, 0, 0}, 0));
      if (compounding == Compounding::mean) {
        reconstruction.add(row_of({20, 200, 150}, {0, 0, 0}, 1));
        reconstruction.add(row_of({60, 90, 120}, {0, 0, 0}, 2));
      } else {
        reconstruction.add(row_of({60, 200, 150}, {0, 0, 0}, 1));
        reconstruction.add(row_of({20, 90, 120}, {0, 0, 0}, 2));
      }
      const ReconstructedVolume volume = reconstruction.measured();
      for (int i = 0; i < 3; ++i) {
        CHECK(int(volume.grey.at({i, 0, 0})) == values[std::size_t(i)]);
        CHECK(volume.known.at({i, 0, 0}) == kMeasured);
      }
      CHECK(volume.known.at({3, 0, 0}) == 0);
      CHECK(volume.known.at({0, 1, 0}) == 0);
    }
}

TEST_CASE("within one picture the pixels of a voxel are averaged, before the largest or latest is taken") {
  Reconstruction reconstruction(unit_grid({2, 2, 2}), {Insertion::nearest, Compounding::maximum, 0});
  TrackedPicture fine = row_of({10, 50}, {-0.1, 0, 0}, 0);
  fine.patient_from_pixel[0].x = 0.2;  // both in the first voxel
  reconstruction.add(fine);
  CHECK(int(reconstruction.measured().grey.at({0, 0, 0})) == 30);
}

TEST_CASE("a volume does not depend on how many threads make it, nor on being looked at and enlarged meanwhile") {
  const HandSweep sweep{.pictures = 24};
  const glm::dvec3 middle = sweep.middle();
  const auto pictures = sweep.pictures_of([&](const glm::dvec3& at) {
    return 128 + 90 * std::sin(0.9 * (at.x - middle.x)) * std::cos(0.7 * at.y) + 30 * std::sin(3 * at.z);
  });
  for (const Compounding compounding : {Compounding::mean, Compounding::maximum, Compounding::latest})
    for (const Insertion insertion : {Insertion::nearest, Insertion::trilinear}) {
      const ReconstructionSettings settings{insertion, compounding, 1};
      const tbb::global_control workers(tbb::global_control::max_allowed_parallelism, 8);
      const auto with_threads = [&](int threads) {
        tbb::task_arena arena(threads);
        return arena.execute([&] { return reconstructed(pictures, 0.6, settings); });
      };
      const ReconstructedVolume whole = with_threads(1);
      CHECK(equal(whole, with_threads(2)));
      CHECK(equal(whole, with_threads(7)));

      // From a part of the grid, enlarged in two steps.
      const Grid grid = choose_grid(pictures, 0.6).grid;
      const glm::ivec3 before(0, 0, 0), behind(0, 3, grid.size.z / 2);
      Grid part = grid;
      part.size -= before + behind;
      Reconstruction growing(part, settings);
      growing.extend({0, 0, 0}, {0, 3, 0});
      for (std::size_t n = 0; n < 6; ++n) growing.add(pictures[n]);
      growing.filled();
      growing.extend({0, 0, 0}, {0, 0, behind.z});
      CHECK(growing.grid() == grid);
      for (std::size_t n = 6; n < pictures.size(); ++n) growing.add(pictures[n]);
      CHECK(equal(whole, growing.filled()));
    }
}

TEST_CASE("an extended volume stays where it lies") {
  Reconstruction reconstruction(unit_grid({3, 2, 2}), {Insertion::nearest, Compounding::latest, 0});
  reconstruction.add(row_of({10, 20, 30}, {0, 1, 1}, 0));
  reconstruction.extend({2, 1, 3}, {1, 0, 2});
  const ReconstructedVolume volume = reconstruction.measured();
  CHECK(volume.grey.grid.size == glm::ivec3(6, 3, 7));
  CHECK(volume.grey.grid.origin == glm::dvec3(-2, -1, -3));
  CHECK(int(volume.grey.at({3, 2, 4})) == 20);
  CHECK(std::count(volume.known.voxels.begin(), volume.known.voxels.end(), kMeasured) == 3);
}

TEST_CASE("a hand that rests does not exhaust single precision") {
  Reconstruction reconstruction(unit_grid({2, 2, 2}), {Insertion::nearest, Compounding::mean, 0});
  TrackedPicture fine = row_of(std::vector<std::uint8_t>(4000, 3), {-0.1, 0, 0}, 0);
  fine.patient_from_pixel[0].x = 2e-5;  // all in the first voxel
  for (int n = 0; n < 10000; ++n) reconstruction.add(fine);
  CHECK(int(reconstruction.measured().grey.at({0, 0, 0})) == 3);
}
