// The scattering volume: against the direct sum of the waves, and its file.

#include "sim/acoustics/speckle_volume.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/acoustics/echo_lines.h"
#include "sim/acoustics/speckle_file.h"
#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

/// A viewpoint that is parallel to no axis of the cells.
const Pose kOblique{glm::dmat3(0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1), {12, -30, 7}};

SpecklePlan small_plan(const char* name, double depth_mm) {
  SpecklePlan plan = speckle_plan(*find_probe(name), bundled_transducer(name), kOblique, depth_mm);
  plan.transducer.excitation_cycles = 1;  // a short pulse: many grains in a small part
  plan.thickness_mm = 2;
  plan.seed = 5;
  return plan;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / double(values.size());
}

}  // namespace

TEST_CASE("the scattering volume is the direct sum of the echoes of its scatterers") {
  // Few scatterers in a small part of a linear array's view, so that the direct sum is quick. The amplitude is a blob,
  // which ends them. The table's steps, its end at 2.2 full widths and the nearest of its depths, 1 mm apart, leave 2 %
  // of the mean envelope, and at single voxels 13 %.
  SpecklePlan plan = small_plan("linear", 24);
  plan.voxel_mm = 0.1;
  plan.thickness_mm = 0.9;
  plan.cell_mm = 0.35;
  const glm::dvec3 middle = plan.patient_from_probe.point({0.4, 17, 0.2});
  const AmplitudeAt blob = [&](const glm::dvec3& at) {
    const double away = glm::distance(at, middle);
    return away < 1.5 ? 1 - away / 3 : 0.0;
  };
  const double density = 1 / std::pow(plan.cell_mm, 3);
  const ResponseTable table(plan.transducer, plan.beamforming, plan.depth_mm, density);
  const Grid grid = speckle_grid(plan);
  std::vector<PointScatterer> scatterers;
  for_each_scatterer(plan, {-3, 14, -3}, {4, 20, 3}, blob, [&](const PlacedScatterer& s) {
    scatterers.push_back({s.place_mm, s.amplitude});
  });
  REQUIRE(scatterers.size() > 100);

  const Pose probe_from_patient = plan.patient_from_probe.inverse();
  std::vector<std::vector<float>> strips;
  for (int strip = 0; strip < strip_count(grid); ++strip)
    strips.push_back(speckle_strip(plan, grid, table, blob, strip));
  const Pulse pulse(plan.transducer);
  std::vector<double> direct, stored;
  double wrong = 0;
  for (int k = 0; k < grid.size.z; ++k)
    for (int i = 0; i < grid.size.x; ++i) {
      const glm::dvec3 at = probe_from_patient.point(grid.patient_from_index(glm::dvec3(i, 0, k)));
      if (std::abs(at.x) > 1.6 || (i + k) % 3 != 0) continue;
      // The central line's beam, as the volume takes it everywhere: moved to the middle.
      std::vector<PointScatterer> moved = scatterers;
      for (PointScatterer& s : moved) s.position_mm -= glm::dvec3(at.x, 0, at.z);
      const ScanBeam beam(plan.transducer, plan.beamforming, line_at(plan.transducer, 0));
      const EchoLine echo = echo_line(beam, pulse, moved, 14, 20);
      const std::vector<double> envelope = echo.envelope();
      for (int j = 0; j < grid.size.y; ++j) {
        const double r = probe_from_patient.point(grid.patient_from_index(glm::dvec3(i, j, k))).y;
        const double place = (2 * r / echo.speed_mm_us - echo.first_us) / echo.step_us;
        if (place < 1 || place > double(envelope.size()) - 2 || r < 15.4 || r > 18.6) continue;
        const std::size_t before = std::size_t(place);
        const double f = place - double(before);
        direct.push_back((1 - f) * envelope[before] + f * envelope[before + 1]);
        const std::vector<float>& strip = strips[std::size_t(j / kStripVoxels)];
        const int height = std::min(kStripVoxels, grid.size.y - j / kStripVoxels * kStripVoxels);
        stored.push_back(double(
            strip[(std::size_t(k) * std::size_t(height) + std::size_t(j % kStripVoxels)) * std::size_t(grid.size.x) +
                  std::size_t(i)]));
      }
    }
  REQUIRE(direct.size() > 500);
  // The table's scale is its own, so the direct sum is brought to it.
  double product = 0, squares = 0;
  for (std::size_t n = 0; n < direct.size(); ++n) product += direct[n] * stored[n], squares += direct[n] * direct[n];
  for (double& value : direct) value *= product / squares;
  for (std::size_t n = 0; n < direct.size(); ++n) wrong = std::max(wrong, std::abs(direct[n] - stored[n]));
  std::printf("scattering volume: %zu voxels, at most %.3f of the mean envelope from the direct sum\n", direct.size(),
              wrong / mean_of(direct));
  CHECK(wrong < 0.15 * mean_of(direct));
  std::vector<double> errors;
  for (std::size_t n = 0; n < direct.size(); ++n) errors.push_back(std::abs(direct[n] - stored[n]));
  CHECK(mean_of(errors) < 0.02 * mean_of(direct));
}

TEST_CASE("a scattering volume has mean 1 in liver at every depth, and nothing outside the fan") {
  SpecklePlan plan = small_plan("curvilinear", 40);
  plan.voxel_mm = 0.5;
  const ResponseTable table(plan.transducer, plan.beamforming, plan.depth_mm, 1 / std::pow(plan.cell_mm, 3));
  const Grid grid = speckle_grid(plan);
  const Pose probe_from_patient = plan.patient_from_probe.inverse();
  for (int strip = 2; strip < strip_count(grid) - 1; ++strip) {
    const std::vector<float> voxels = speckle_strip(
        plan, grid, table, [](const glm::dvec3&) { return 1.0; }, strip);
    double sum = 0, squares = 0, n = 0;
    for (std::size_t v = 0; v < voxels.size(); ++v) {
      const int i = int(v % std::size_t(grid.size.x)), j = int(v / std::size_t(grid.size.x)) % kStripVoxels,
                k = int(v / std::size_t(grid.size.x * kStripVoxels));
      const glm::dvec3 at =
          probe_from_patient.point(grid.patient_from_index(glm::dvec3(i, strip * kStripVoxels + j, k)));
      const auto inside = line_position(plan.probe, plan.depth_mm, {at.x, at.y});
      if (!inside) {
        CHECK(voxels[v] == 0);
      } else if (std::abs(at.x) < 12) {
        sum += voxels[v], squares += double(voxels[v]) * voxels[v], ++n;
      }
    }
    INFO("strip " << strip << ": mean " << sum / n);
    REQUIRE(n > 500);
    // Some 100 grains, each with a deviation of half its mean; the table's end takes 1 %.
    CHECK(sum / n == Approx(1).margin(0.15));
    CHECK(sum / n / std::sqrt(squares / n - sum / n * sum / n) == Approx(1.91).margin(0.35));
  }
}

TEST_CASE("scatterers are those of the patient, whatever box they are taken from, and the seed's") {
  const SpecklePlan plan = small_plan("linear", 30);
  const auto in = [](const SpecklePlan& of, const glm::dvec3& low, const glm::dvec3& high) {
    std::vector<glm::dvec3> places;
    for_each_scatterer(
        of, low, high, [](const glm::dvec3&) { return 1.0; },
        [&](const PlacedScatterer& s) { places.push_back(s.place_mm); });
    return places;
  };
  const std::vector<glm::dvec3> all = in(plan, {-2, 10, -2}, {2, 14, 2});
  const double expected = 64 / std::pow(plan.cell_mm, 3);
  CHECK(double(all.size()) == Approx(expected).epsilon(0.05));
  std::size_t halves = 0;
  for (const double z : {-2.0, 0.0}) halves += in(plan, {-2, 10, z}, {2, 14, z + 2}).size();
  CHECK(halves == all.size());
  SpecklePlan other = plan;
  other.seed = 6;
  CHECK(in(other, {-2, 10, -2}, {2, 14, 2}) != all);
}

TEST_CASE("a scattering volume's file is read where it belongs, and refused by name elsewhere") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "speckle.nrrd";
  SpecklePlan plan = small_plan("linear", 12);
  plan.voxel_mm = 2;
  const Grid grid = speckle_grid(plan);
  const SpeckleKey key{"0123456789abcdef", identity_of(plan.transducer), 5};
  const std::string header = speckle_header(key, plan, grid);
  std::vector<float> voxels(grid.count());
  for (std::size_t v = 0; v < voxels.size(); ++v) voxels[v] = float(v) / 3;
  const std::string whole =
      header + std::string(reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(float));
  write_file(file, whole);
  CHECK(is_speckle_file(file, header, grid));
  const Volume<float> read = read_speckle_file(file, key);
  CHECK(read.voxels == voxels);
  CHECK(read.grid.size == grid.size);
  CHECK(glm::distance(read.grid.patient_from_index(glm::dvec3(3, 2, 1)), grid.patient_from_index(glm::dvec3(3, 2, 1))) <
        1e-9);

  const auto refused = [&](SpeckleKey other, const char* why) {
    CHECK_THROWS_WITH(read_speckle_file(file, other), Catch::Contains(why) && Catch::Contains("speckle.nrrd"));
  };
  refused({"fedcba9876543210", key.transducer, 5}, "another patient");
  refused({key.patient, identity_of(bundled_transducer("curvilinear")), 5}, "of the transducer 'L12-3v");
  refused({key.patient, key.transducer, 6}, "the seed '5', not 6");
  Transducer changed = plan.transducer;
  changed.pitch_mm += 1e-9;
  CHECK(identity_of(changed) != key.transducer);
  SpecklePlan deeper = plan;
  deeper.beamforming.transmit_focus_mm += 1;
  CHECK_FALSE(is_speckle_file(file, speckle_header(key, deeper, grid), grid));

  write_file(file, whole.substr(0, whole.size() - 5));
  refused(key, "bytes of voxels instead of");
  CHECK_FALSE(is_speckle_file(file, header, grid));
  write_file(file, "NRRD0004\ntype: float\n\n");
  refused(key, "not a scattering volume");
  write_file(file, "a letter");
  refused(key, "");
  std::string other_type = whole;
  other_type.replace(other_type.find("type: float"), 11, "type: short");
  write_file(file, other_type);
  refused(key, "field 'type'");
}
