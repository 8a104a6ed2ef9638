#include "sim/tissue/ct_noise.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

using namespace insonate;

namespace {

Volume<std::int16_t> block(glm::ivec3 size, double spacing_mm) {
  Volume<std::int16_t> ct;
  ct.grid.size = size;
  ct.grid.spacing = glm::dvec3(spacing_mm);
  ct.voxels.resize(ct.grid.count());
  return ct;
}

/// Independent noise in each voxel, about densities that are a function of the position along x in mm.
template <typename Density>
Volume<std::int16_t> noisy(glm::ivec3 size, double spacing_mm, double noise_hu, Density density) {
  Volume<std::int16_t> ct = block(size, spacing_mm);
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  for (std::size_t v = 0; v < ct.voxels.size(); ++v)
    ct.voxels[v] =
        std::int16_t(std::lround(density(double(v % std::size_t(size.x)) * spacing_mm) + noise_hu * noise(random)));
  return ct;
}

/// Mean and standard deviation of the voxels from x = first to last.
std::pair<double, double> statistics(const Volume<std::int16_t>& ct, int first, int last) {
  double sum = 0, squares = 0, count = 0;
  for (int z = 0; z < ct.grid.size.z; ++z)
    for (int y = 0; y < ct.grid.size.y; ++y)
      for (int x = first; x <= last; ++x) {
        sum += ct.at({x, y, z});
        squares += double(ct.at({x, y, z})) * ct.at({x, y, z});
        ++count;
      }
  return {sum / count, std::sqrt(squares / count - sum * sum / count / count)};
}

}  // namespace

TEST_CASE("a CT's noise is measured in its soft tissue, whatever lies beside it") {
  for (const double hu : {20.0, 25.0, 32.0})
    // Tissue between fat and bone, each with its edges, in voxels of 1 and 3 mm.
    for (const double spacing : {1.0, 3.0}) {
      CAPTURE(hu, spacing);
      const auto ct = noisy({90, 60, 50}, spacing, hu, [&](double x) {
        const double share = x / (90 * spacing);
        return share < 0.3 ? -100.0 : share < 0.75 ? 50.0 : 500.0;
      });
      CHECK(ct_noise_hu(ct) == Approx(hu).epsilon(0.07));  // the mode of 27 values' deviations lies 2 to 4 % lower
    }
  CHECK(ct_noise_hu(noisy({60, 60, 60}, 1, 3, [](double) { return 50; })) == kUsualNoise_hu);
  CHECK(ct_noise_hu(noisy({60, 60, 60}, 1, 40, [](double) { return -100; })) == kUsualNoise_hu);  // no soft tissue
  CHECK(ct_noise_hu(noisy({20, 20, 20}, 1, 40, [](double) { return 50; })) == kUsualNoise_hu);    // and too little
}

TEST_CASE("a seventh of the noise remains in even tissue, and its mean stays") {
  for (const double noise : {15.0, 30.0}) {
    const auto ct = noisy({60, 50, 40}, 1, noise, [](double) { return 30; });
    const auto [mean, deviation] = statistics(without_noise(ct, noise), 8, 51);
    CHECK(mean == Approx(30).margin(0.3));
    CHECK(deviation < noise / 7);
    CHECK(deviation > noise / 20);  // a test of what is measured: no filter of 81 independent voxels does better
  }
}

TEST_CASE("a single voxel shows which of its neighbours count") {
  // 2 voxels are 3 mm. In the guide a voxel and its six neighbours have a seventh of what it is denser by.
  const auto with_one = [](int denser) {
    Volume<std::int16_t> ct = block({21, 21, 21}, 1.5);
    ct.at({10, 10, 10}) = std::int16_t(denser);
    return without_noise(ct, 15);
  };
  // All 27 voxels around become 1, and then two thirds and more of what lies around those within a step.
  const Volume<std::int16_t> noise = with_one(27);
  CHECK(noise.at({10, 10, 10}) == 1);
  CHECK(noise.at({12, 10, 10}) == 1);
  CHECK(noise.at({14, 10, 10}) == 0);
  CHECK(noise.at({11, 10, 10}) == 0);
  CHECK(with_one(13).at({10, 10, 10}) == 0);
  // Up to 7 x 24 it counts as noise: 168 / 27 in all 27 voxels.
  CHECK(with_one(168).at({10, 10, 10}) == 6);
  // Beyond, it and its six neighbours, 27 apart from the rest, keep to themselves: 189 / 7 = 27 in its place, 189 / 6
  // in theirs, whose 27 voxels hold six of the seven. These are alike, 12 or less apart, and 0 is not.
  const Volume<std::int16_t> structure = with_one(189);
  CHECK(structure.at({10, 10, 10}) == 31);  // (27 + 6 x 32) / 7
  CHECK(structure.at({12, 12, 10}) == 0);
}

TEST_CASE("edges between fat, organs, fluid and bone stay in their place under noise") {
  for (const auto& [from, to] : {std::pair{-100.0, 50.0}, {50.0, 0.0}, {50.0, 400.0}, {-700.0, 50.0}}) {
    CAPTURE(from, to);
    const auto ct = noisy({60, 40, 40}, 1, 15, [from = from, to = to](double x) { return x < 29.5 ? from : to; });
    const Volume<std::int16_t> filtered = without_noise(ct, 15);
    // Beside the edge, a seventh of the guide comes from the other side; it leaves organ and fluid two units apart.
    const double step = to - from;
    CHECK(statistics(filtered, 29, 29).first == Approx(from).margin(0.1 * std::abs(step)));
    CHECK(statistics(filtered, 30, 30).first == Approx(to).margin(0.1 * std::abs(step)));
    CHECK(statistics(filtered, 25, 25).first == Approx(from).margin(2));
    CHECK(statistics(filtered, 34, 34).first == Approx(to).margin(2));
  }
}

TEST_CASE("air and a CT without noise stay as they are, on any number of threads") {
  const auto air = noisy({40, 20, 20}, 1, 10, [](double) { return -1000; });
  CHECK(without_noise(air, 20).voxels == air.voxels);
  const auto step = noisy({40, 20, 20}, 1, 0, [](double x) { return x < 20 ? -100 : 60; });
  CHECK(without_noise(step, 15).voxels == step.voxels);

  const auto ct = noisy({50, 30, 30}, 1, 20, [](double x) { return x; });
  const Volume<std::int16_t> filtered = without_noise(ct, 20);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  CHECK(without_noise(ct, 20).voxels == filtered.voxels);
}

TEST_CASE("what is denser than 16 bits' differences, or one voxel thin, is filtered without overflow") {
  Volume<std::int16_t> metal = block({20, 20, 20}, 1);
  metal.at({10, 10, 10}) = 32767;
  metal.at({10, 10, 14}) = -1024;
  for (const std::int16_t hu : without_noise(metal, 100).voxels) CHECK((hu >= -1024 && hu <= 32767));
  const Volume<std::int16_t> one = block({1, 1, 1}, 5);
  CHECK(without_noise(one, 15).voxels == one.voxels);
}
