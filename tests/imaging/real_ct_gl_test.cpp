// Runs a real CT through the whole pipeline and checks what must be visible in every patient. The pictures stay in the
// build's pictures/ for people to look at.

#include <catch2/catch.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/files/png.h"
#include "sim/imaging/simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/real_ct.h"
#include "tests/model/amplitudes.h"

using namespace insonate;

namespace {

constexpr double kScanDepth_mm = 160;

struct Look {
  ScanLines lines;
  Stages<float> stages;
};

Look look(gl::Simulator& simulator, const Pose& pose, const std::string& picture) {
  const Probe& probe = *find_probe("curvilinear");
  Settings settings = test::trainer_with_amplitudes(probe.frequency_mhz, kScanDepth_mm);
  settings.slice_planes = 1;  // the test looks up what a line meets along that line only
  simulator.set_probe(probe, kScanDepth_mm);
  simulator.set_settings(settings);
  simulator.set_pose(pose);
  Look seen{scan_lines(probe, kScanDepth_mm, settings.samples), simulator.read_stages()};
  write_png(std::filesystem::path(INSONATE_PICTURES_FOLDER) / (picture + ".png"), mirrored(seen.stages.grey));
  return seen;
}

/// Returns the depth, less than 70 mm, at which a line has passed `thickness_mm` of voxels for whose Hounsfield units
/// `is_it` holds.
template <typename Predicate>
std::optional<double> depth_behind(const Case& subject, const Pose& pose, const ScanLine& line, double thickness_mm,
                                   Predicate is_it) {
  double run = 0;
  for (double r = 4; r < 70; r += 0.5) {
    const glm::dvec3 p = pose.point(line.start + r * line.direction);
    run = is_it(sample_trilinear(subject.ct, subject.ct.grid.index_from_patient(p))) ? run + 0.5 : 0;
    if (run >= thickness_mm) return r;
  }
  return std::nullopt;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

TEST_CASE("in a real CT bone casts a shadow, gas blocks, and liver and kidney are seen beside them") {
  if (!std::filesystem::exists(test::kRealCt)) {
    WARN("skipped: the real scans are not there");
    return;
  }
  const Case subject = open_case(test::kRealCt);
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const test::TestContext context;
  gl::Simulator simulator;
  simulator.set_volume(make_acoustic_volume(subject.ct, {}, {}, table), table);
  const glm::dvec3 centre = subject.ct.grid.centre();

  SECTION("a rib over the liver") {
    const double angle = glm::radians(-20.0);
    const Pose pose =
        test::on_skin_of(subject, centre + glm::dvec3(-30, 0, 120), {std::cos(angle), std::sin(angle), 0});
    const Look seen = look(simulator, pose, "real_ct_right_upper_quadrant");
    const int sample = int(120 / seen.lines.dr_mm());
    std::vector<double> shadowed, clear;
    for (std::size_t i = 0; i < seen.lines.lines.size(); ++i) {
      const double transmitted = seen.stages.transmission.at(int(i), sample);
      const auto bone = depth_behind(subject, pose, seen.lines.lines[i], 2.5, [](double hu) { return hu > 300; });
      const auto lung = depth_behind(subject, pose, seen.lines.lines[i], 2.5, [](double hu) { return hu < -600; });
      if (bone)
        shadowed.push_back(transmitted);
      else if (!lung)
        clear.push_back(transmitted);
    }
    REQUIRE(shadowed.size() >= 5);
    REQUIRE(clear.size() >= 100);
    // Each of two surfaces transmits 0.59, and 3 mm of bone at 10 dB/(cm MHz) and 3.5 MHz absorb 10 dB, all there and
    // back: 10^-2.9. The rib has 360 HU in its core only, so the test asks for 10^-2.
    CHECK(median(shadowed) < 0.01 * median(clear));
  }

  SECTION("gas in the bowel, from the front") {
    const Pose pose = test::on_skin_of(subject, centre, {0, 1, 0});
    const Look seen = look(simulator, pose, "real_ct_front");
    std::size_t blocked = 0;
    for (std::size_t i = 0; i < seen.lines.lines.size(); ++i)
      if (const auto gas = depth_behind(subject, pose, seen.lines.lines[i], 3, [](double hu) { return hu < -700; })) {
        const int sample = int((*gas + 5) / seen.lines.dr_mm());
        CHECK(seen.stages.transmission.at(int(i), sample) < 1e-6f);
        ++blocked;
      }
    CHECK(blocked >= 3);
  }
}
