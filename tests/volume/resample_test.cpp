#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/volume/ct_reader.h"

using namespace insonate;

namespace {

template <typename Density>
Volume<std::int16_t> made(glm::ivec3 size, glm::dvec3 spacing, Density density) {
  Volume<std::int16_t> ct;
  ct.grid.size = size;
  ct.grid.spacing = spacing;
  ct.grid.origin = {11, -22, 33};
  ct.grid.direction = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, -1));
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i)
        ct.voxels.push_back(std::int16_t(std::lround(density(ct.grid.patient_from_index({i, j, k})))));
  return ct;
}

}  // namespace

TEST_CASE("a resampled CT shows the same density at the same place of the patient") {
  // Waves of 40 mm on 3 x 2 x 5 mm voxels: 8 samples or more a period, where a cubic spline errs by less than 1 %.
  const auto wave = [](const glm::dvec3& p) {
    return 1000 * std::sin(p.x * 0.157) * std::cos(p.y * 0.157) * std::cos(p.z * 0.12 + 1);
  };
  const Volume<std::int16_t> ct = made({40, 50, 24}, {3, 2, 5}, wave);
  const Volume<std::int16_t> fine = resample_isotropic(ct, 1);
  CHECK(fine.grid.size == glm::ivec3(120, 100, 120));
  CHECK(fine.grid.spacing == glm::dvec3(1));
  CHECK(glm::distance(fine.grid.centre(), ct.grid.centre()) < 1e-9);
  double worst = 0, sum = 0;
  std::size_t inside = 0;
  for (int k = 10; k < 110; ++k)
    for (int j = 10; j < 90; ++j)
      for (int i = 10; i < 110; ++i) {
        const double error = fine.at({i, j, k}) - wave(fine.grid.patient_from_index({i, j, k}));
        worst = std::max(worst, std::abs(error));
        sum += std::abs(error);
        ++inside;
      }
  // A crest between samples is cut to its neighbours: up to 1 - cos(pi * 5 / 52) = 5 % in all axes together near one.
  CHECK(worst < 80);
  CHECK(sum / double(inside) < 10);
}

TEST_CASE("resampling meets the samples it starts from") {
  auto ct = made({12, 10, 11}, {3, 3, 3}, [](const glm::dvec3&) { return 0.0; });
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) ct.voxels[v] = std::int16_t(hash(std::uint32_t(v)) % 2000);
  const Volume<std::int16_t> fine = resample_isotropic(ct, 1);
  for (int k = 0; k < 11; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 12; ++i) CHECK(fine.at(glm::ivec3(3 * i + 1, 3 * j + 1, 3 * k + 1)) == ct.at({i, j, k}));
}

TEST_CASE("a rounding error in the spacing changes nothing where new samples fall on old planes") {
  // A third of each axis' samples do. What lies beside the plane has no part in them, on whichever side of it rounding
  // puts them.
  const auto fine_of = [](double spacing_mm) {
    auto ct = made({12, 10, 11}, glm::dvec3(spacing_mm), [](const glm::dvec3&) { return 0.0; });
    for (std::size_t v = 0; v < ct.voxels.size(); ++v) ct.voxels[v] = std::int16_t(hash(std::uint32_t(v)) % 2000);
    return std::pair(ct, resample_isotropic(ct, 1));
  };
  const auto [ct, fine] = fine_of(3);
  // The last two as a header in single precision may have it.
  for (const double off : {-1e-13, 1e-13, -6e-8, 6e-8}) {
    const Volume<std::int16_t> other = fine_of(3 * (1 + off)).second;
    REQUIRE(other.grid.size == fine.grid.size);
    int worst = 0;
    for (std::size_t v = 0; v < fine.voxels.size(); ++v)
      worst = std::max(worst, std::abs(fine.voxels[v] - other.voxels[v]));
    INFO(off);
    CHECK(worst <= 1);  // the other samples' own rounding to whole Hounsfield units
  }
  for (int k = 1; k < 32; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 12; ++i) {
        const auto [low, high] =
            std::minmax(ct.at({i, j, std::max((k - 1) / 3, 0)}), ct.at({i, j, std::min((k + 1) / 3, 10)}));
        const int hu = fine.at({3 * i + 1, 3 * j + 1, k});
        CHECK(hu >= low);
        CHECK(hu <= high);
      }
}

TEST_CASE("resampling never leaves the range of the voxels around") {
  const Volume<std::int16_t> ct =
      made({20, 20, 20}, {3, 3, 3}, [](const glm::dvec3& p) { return p.x > 0 ? 3000 : -1000; });
  const Volume<std::int16_t> fine = resample_isotropic(ct, 0.8);
  int between = 0;
  for (const std::int16_t hu : fine.voxels) {
    REQUIRE(hu >= -1000);
    REQUIRE(hu <= 3000);
    between += hu > -900 && hu < 2900;
  }
  CHECK(between > 0);
}

TEST_CASE("a CT that is about as fine as asked for stays as it is") {
  const Volume<std::int16_t> ct = made({6, 7, 8}, {0.9, 1.1, 1.19}, [](const glm::dvec3& p) { return p.x; });
  const Volume<std::int16_t> same = resample_isotropic(ct, 1);
  CHECK(same.grid.size == ct.grid.size);
  CHECK(same.voxels == ct.voxels);
  CHECK_THROWS_AS(resample_isotropic(ct, 1e-4), InputError);
  // The smallest volume there is.
  CHECK(resample_isotropic(made({2, 2, 2}, {1, 2, 3}, [](const glm::dvec3&) { return 7; }), 1).voxels ==
        std::vector<std::int16_t>(2 * 4 * 6, 7));
}

TEST_CASE("resampling gives the same bits on any number of threads") {
  auto ct = made({31, 17, 23}, {2.5, 1.7, 4}, [](const glm::dvec3&) { return 0.0; });
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) ct.voxels[v] = std::int16_t(hash(std::uint32_t(v)) % 2000);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return resample_isotropic(ct, 1).voxels;
  };
  CHECK(with_threads(1) == with_threads(5));
}

TEST_CASE("labels land on the same place of the patient") {
  const Volume<std::int16_t> ct = made({20, 20, 20}, {3, 3, 3}, [](const glm::dvec3&) { return 0; });
  Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(ct.voxels.size())};
  labels.at({5, 6, 7}) = 9;
  const Volume<std::int16_t> fine = resample_isotropic(ct, 1);
  const Volume<std::uint8_t> carried = resample_labels(labels, fine.grid);
  CHECK(carried.grid.size == fine.grid.size);
  int count = 0;
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i)
        if (carried.at({i, j, k})) {
          ++count;
          const glm::dvec3 away =
              labels.grid.index_from_patient(fine.grid.patient_from_index({i, j, k})) - glm::dvec3(5, 6, 7);
          CHECK(std::max({std::abs(away.x), std::abs(away.y), std::abs(away.z)}) < 0.5);
        }
  CHECK(count >= 1);  // a single voxel is not lost
  CHECK(count <= 27);
  CHECK(resample_labels(labels, labels.grid).voxels == labels.voxels);

  Grid elsewhere = fine.grid;
  elsewhere.origin.x += 500;
  const auto outside = resample_labels(labels, elsewhere).voxels;
  CHECK(std::count(outside.begin(), outside.end(), 0) == std::ptrdiff_t(outside.size()));
}

TEST_CASE("labels of coarse voxels get a smooth surface, and sheets of one voxel keep their thickness") {
  const Volume<std::int16_t> ct = made({20, 20, 20}, {3, 3, 3}, [](const glm::dvec3&) { return 0; });
  const Volume<std::int16_t> fine = resample_isotropic(ct, 1);
  Volume<std::uint8_t> half{ct.grid, std::vector<std::uint8_t>(ct.voxels.size())}, sheet = half;
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 0.35, 0.2));
  const auto depth = [&](const glm::dvec3& p) {
    return glm::dot(p - ct.grid.patient_from_index(glm::dvec3(9.7)), normal);
  };
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 20; ++i) {
        half.at({i, j, k}) = depth(ct.grid.patient_from_index(glm::dvec3(i, j, k))) < 0 ? 3 : 4;
        sheet.at({i, j, k}) = i == 8;
      }
  // How far on the wrong side of the plane voxels are, root mean square over those within 3 mm of it.
  const auto roughness = [&](auto&& label_at) {
    double sum = 0, count = 0;
    for (int k = 9; k < 50; ++k)
      for (int j = 9; j < 50; ++j)
        for (int i = 9; i < 50; ++i) {
          const double d = depth(fine.grid.patient_from_index(glm::dvec3(i, j, k)));
          if (std::abs(d) > 3) continue;
          ++count;
          if ((label_at(glm::ivec3(i, j, k)) == 3) != (d < 0)) sum += d * d;
        }
    return std::sqrt(sum / count);
  };
  const Volume<std::uint8_t> carried = resample_labels(half, fine.grid);
  const double smooth = roughness([&](const glm::ivec3& at) { return carried.at(at); });
  const double nearest = roughness([&](const glm::ivec3& at) {
    return half.at(glm::ivec3(glm::round(half.grid.index_from_patient(fine.grid.patient_from_index(glm::dvec3(at))))));
  });
  INFO("of smooth labels " << smooth << " mm, of the nearest " << nearest << " mm");
  CHECK(smooth < 0.5 * nearest);

  const auto thick = resample_labels(sheet, fine.grid).voxels;
  CHECK(double(std::count(thick.begin(), thick.end(), 1)) == Approx(3.0 * 60 * 60).epsilon(0.4));
}
