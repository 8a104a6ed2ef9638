// Labels are looked up in an index, or at their surface: the same must come out as of reading all voxels.
#include "scenarios/steps/structures.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

#include "scenarios/steps/plane_region.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

/// A few blobs of labels 1 to 3 in a grid that is turned, moved and not even.
Case blobs(std::mt19937& random) {
  const auto up_to = [&](int most) { return int(random() % std::uint32_t(most + 1)); };
  Case subject;
  subject.name = "blobs";
  subject.label_table = {{1, "one", ""}, {2, "two", ""}, {3, "three", ""}, {4, "absent", ""}};
  Grid& grid = subject.labels.grid;
  grid.size = {20 + up_to(15), 20 + up_to(15), 20 + up_to(15)};
  grid.spacing = {0.7, 1.1, 2.5};
  grid.origin = {-12, 30, 5};
  grid.direction = turned(40, {1, 2, 3}, {0, 0, 0}).rotation;
  subject.labels.voxels.assign(grid.count(), 0);
  for (int blob = 0; blob < 5; ++blob) {
    const glm::ivec3 middle(up_to(grid.size.x - 1), up_to(grid.size.y - 1), up_to(grid.size.z - 1));
    const double radius = 1 + up_to(4);
    for (int k = 0; k < grid.size.z; ++k)
      for (int j = 0; j < grid.size.y; ++j)
        for (int i = 0; i < grid.size.x; ++i)
          if (glm::distance(glm::dvec3(i, j, k), glm::dvec3(middle)) < radius)
            subject.labels.at({i, j, k}) = std::uint8_t(1 + blob % 3);
  }
  return subject;
}

const std::vector<std::vector<std::string>> kSets = {{"one"}, {"two", "three"}, {"one", "one", "nobody"}, {"absent"}};

}  // namespace

TEST_CASE("what an index holds of structures is what reading every voxel finds, to the bit") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> mm(-60, 60);
  for (int round = 0; round < 20; ++round) {
    const Case subject = blobs(random);
    const Grid& grid = subject.labels.grid;
    const LabelIndex index(subject);
    for (const auto& names : kSets) {
      const StructureSet set(index, names);
      const StructureSurface surface(index, names);
      std::vector<glm::ivec3> voxels;
      for (int k = 0; k < grid.size.z; ++k)
        for (int j = 0; j < grid.size.y; ++j)
          for (int i = 0; i < grid.size.x; ++i)
            if (set.holds(subject.labels.at({i, j, k}))) voxels.push_back({i, j, k});
      CHECK(set.any_voxel() == !voxels.empty());
      CHECK(set.volume_mm3() == double(voxels.size()) * 0.7 * 1.1 * 2.5);
      for (int place = 0; place < 30; ++place) {
        const glm::dvec3 at = grid.centre() + glm::dvec3(mm(random), mm(random), mm(random));
        double nearest = std::numeric_limits<double>::infinity();
        for (const glm::ivec3& voxel : voxels) {
          const glm::dvec3 way = (glm::dvec3(voxel) - grid.index_from_patient(at)) * grid.spacing;
          nearest = std::min(nearest, glm::dot(way, way));
        }
        const auto distance = surface.distance_mm(at);
        REQUIRE(distance.has_value() == !voxels.empty());
        if (distance) CHECK(*distance == (set.holds(at) ? 0 : std::sqrt(nearest)));
      }
    }
  }
}

TEST_CASE("a region in a plane is the one that every pixel of the window has been asked for") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> mm(-12, 12), degrees(0, 360);
  constexpr double kHalf_mm = 40, kPitch_mm = 0.5;
  int found = 0;
  for (int round = 0; round < 40; ++round) {
    const Case subject = blobs(random);
    const LabelIndex index(subject);
    const StructureSet set(index, kSets[std::size_t(round) % 2]);
    const glm::dvec3 middle = subject.labels.grid.centre();
    const Pose pose = turned(degrees(random), {mm(random), mm(random), 13}, middle + mm(random));
    const glm::dvec2 near(mm(random), mm(random));
    const auto region = plane_region(set, pose, near, kHalf_mm, kPitch_mm);
    // Its pixel that is nearest to the point is nearest of all.
    double nearest = std::numeric_limits<double>::infinity();
    constexpr int kPixels = int(kHalf_mm / kPitch_mm);
    for (int j = -kPixels; j <= kPixels; ++j)
      for (int i = -kPixels; i <= kPixels; ++i) {
        const glm::dvec2 place = near + kPitch_mm * glm::dvec2(i, j);
        if (set.holds(pose.point(glm::dvec3(place, 0)))) nearest = std::min(nearest, glm::distance(place, near));
      }
    REQUIRE(region.has_value() == std::isfinite(nearest));
    if (!region) continue;
    ++found;
    double of_region = std::numeric_limits<double>::infinity(), longest = 0;
    for (const glm::dvec2& pixel : region->pixels) of_region = std::min(of_region, glm::distance(pixel, near));
    CHECK(of_region == nearest);
    INFO("and beside its pixels nothing of the structures is left out");
    std::set<std::pair<int, int>> taken;
    const auto index_of = [&](const glm::dvec2& pixel) {
      const glm::dvec2 steps = (pixel - near) / kPitch_mm;
      return std::pair(int(std::lround(steps.x)), int(std::lround(steps.y)));
    };
    for (const glm::dvec2& pixel : region->pixels) taken.insert(index_of(pixel));
    CHECK(taken.size() == region->pixels.size());
    std::size_t left_out = 0;
    for (const auto& [i, j] : taken)
      for (const auto& [u, v] : {std::pair(i + 1, j), {i - 1, j}, {i, j + 1}, {i, j - 1}})
        left_out += std::max(std::abs(u), std::abs(v)) <= kPixels && !taken.contains({u, v}) &&
                    set.holds(pose.point(glm::dvec3(near + kPitch_mm * glm::dvec2(u, v), 0)));
    CHECK(left_out == 0);
    for (int i = 0; i < 90; ++i) {
      const double angle = 3.14159265358979323846 * i / 90;
      longest = std::max(longest, region->extent_mm({std::cos(angle), std::sin(angle)}));
    }
    CHECK(region->longest_extent_mm() == longest);
  }
  CHECK(found > 10);
}

TEST_CASE("of a box that is cut along its sides every pixel is found, out to its edges") {
  Case subject;
  subject.label_table = {{1, "box", ""}};
  Grid& grid = subject.labels.grid;
  grid.size = {30, 30, 30};
  grid.spacing = {1, 2, 3};
  subject.labels.voxels.assign(grid.count(), 0);
  for (int k = 7; k < 20; ++k)
    for (int j = 5; j < 15; ++j)
      for (int i = 8; i < 25; ++i) subject.labels.at({i, j, k}) = 1;
  const auto region =
      plane_region(StructureSet(LabelIndex(subject), {"box"}), {glm::dmat3(1.0), {0.1, 0.1, 30}}, {{15, 20}}, 40, 0.25);
  REQUIRE(region);
  CHECK(region->extent_mm({1, 0}) == Approx(17));
  CHECK(region->extent_mm({0, 1}) == Approx(20));
  CHECK(region->area_mm2() == Approx(17 * 20));
}
