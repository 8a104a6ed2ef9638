// The same patient at two doses: noise of a CT is not anatomy.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/hash.h"
#include "sim/imaging/simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/real_ct.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

namespace {

/// Adds normal noise (Box and Muller), independent from voxel to voxel, as quantum noise is before a kernel smooths it.
Volume<std::int16_t> with_noise(Volume<std::int16_t> ct, double deviation_hu) {
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) {
    const std::uint32_t key = hash(std::uint32_t(v));
    const double share = unit_float(hash(key, 1)) + 1e-8, phase = 6.283185307 * unit_float(hash(key, 2));
    const double noise = deviation_hu * std::sqrt(-2 * std::log(share)) * std::cos(phase);
    ct.voxels[v] = std::int16_t(std::lround(std::clamp(ct.voxels[v] + noise, -1024.0, 3071.0)));
  }
  return ct;
}

/// The mean grey of each square of the picture, some 2 cm wide, that lies whole in the fan.
std::vector<double> regions_of(const Stages<float>& stages) {
  constexpr int kSide = 40;
  std::vector<double> means;
  for (int top = 0; top + kSide <= stages.grey.height; top += kSide)
    for (int left = 0; left + kSide <= stages.grey.width; left += kSide) {
      double sum = 0;
      bool inside = true;
      for (int y = top; y < top + kSide; ++y)
        for (int x = left; x < left + kSide; ++x) {
          sum += stages.grey.at(x, y);
          inside = inside && stages.inside.at(x, y);
        }
      means.push_back(inside ? sum / (kSide * kSide) : -1);
    }
  return means;
}

/// Checks that no region's mean grey changes by 3 levels, in the trainer's picture.
void compare(const std::string& what, const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
             const std::vector<std::string>& tissue_of, const std::vector<Pose>& poses) {
  const test::TestContext context;
  const TissueTable& table = test::tissues();
  gl::Simulator simulator;
  Settings settings = trainer_settings(3.5, 160);
  settings.dynamic_range_db = 60;
  simulator.set_probe(*find_probe("curvilinear"), 160);
  simulator.set_settings(settings);
  std::vector<std::vector<double>> quiet;
  simulator.set_volume(make_acoustic_volume(ct, labels, tissue_of, table), table);
  for (const Pose& pose : poses) {
    simulator.set_pose(pose);
    quiet.push_back(regions_of(simulator.read_stages()));
  }
  simulator.set_volume(make_acoustic_volume(with_noise(ct, 20), labels, tissue_of, table), table);
  for (std::size_t p = 0; p < poses.size(); ++p) {
    simulator.set_pose(poses[p]);
    const std::vector<double> noisy = regions_of(simulator.read_stages());
    double worst = 0, mean = 0, regions = 0;
    for (std::size_t i = 0; i < noisy.size(); ++i) {
      if (noisy[i] < 0) continue;
      worst = std::max(worst, std::abs(noisy[i] - quiet[p][i]));
      mean += noisy[i] - quiet[p][i];
      ++regions;
    }
    std::printf(
        "%s, pose %zu: with noise of 20 HU, %.0f regions change by %.2f grey levels in the mean, %.2f at most\n",
        what.c_str(), p, regions, mean / regions, worst);
    CHECK(worst < 3);
  }
}

}  // namespace

TEST_CASE("noise of 20 HU in a CT without labels changes no region's grey by 3 levels") {
  if (!std::filesystem::exists(test::kRealCt)) {
    WARN("skipped: the real scans are not there");
    return;
  }
  const Case subject = open_case(test::kRealCt);
  const glm::dvec3 centre = subject.ct.grid.centre();
  compare("a real CT", subject.ct, {}, {},
          {test::on_skin_of(subject, centre + glm::dvec3(-30, 0, 120), glm::normalize(glm::dvec3(0.94, -0.34, 0))),
           test::on_skin_of(subject, centre + glm::dvec3(0, 0, 60), {0, 1, 0}),
           test::on_skin_of(subject, centre + glm::dvec3(-40, 0, 0), {0, 1, 0})});
}
