// Tests the scan conversion of a sweep to a volume: the shader against the reference, and both against patterns given
// by a formula. A volume must show the patterns at their place and in their size.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

#include "sim/core/hash.h"
#include "sim/imaging/sweep_conversion.h"
#include "sim/reference/sweep_reference.h"
#include "tests/gl/test_context.h"

using namespace insonate;

namespace {

Pose somewhere() {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, -2, 0.5)));
  return {glm::dmat3(turn), {30, -50, 120}};
}

Sweep swept(const char* probe_name, int lines, int planes, double sweep_deg) {
  Probe probe = *find_probe(probe_name);
  probe.lines = lines;
  return {probe, 60, swept_planes(somewhere(), planes, sweep_deg, 30)};
}

Sweep by_hand() {
  Sweep sweep = swept("linear", 40, 2, 1);
  sweep.patient_from_plane.clear();
  Pose patient_from_plane = somewhere();
  for (int k = 0; k < 24; ++k) {
    sweep.patient_from_plane.push_back(patient_from_plane);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.01, glm::normalize(glm::dvec3(1, 0.5 * std::sin(k), 0.2)));
    patient_from_plane = patient_from_plane * Pose{glm::dmat3(turn), {0.3 * std::cos(k), 0.1, 1.2}};
  }
  return sweep;
}

template <typename Pattern>
SweepValues sampled(const Sweep& sweep, int samples, const Pattern& pattern) {
  const ScanLines all = scan_lines(sweep, samples);
  SweepValues values{samples, sweep.probe.lines, {}};
  for (const ScanLine& line : all.lines)
    for (int k = 0; k < samples; ++k)
      values.values.push_back(float(pattern(line.start + (k + 0.5) * all.dr_mm() * line.direction)));
  return values;
}

Volume<float> converted(const Sweep& sweep, const SweepValues& values, const Grid& grid) {
  const test::TestContext context;
  gl::SweepConversion conversion;
  conversion.lay_out(grid);
  const std::vector<float> stored(values.values.begin(), values.values.end());
  const gl::TexelBuffer rows(GL_R32F, stored.size(), stored.data());
  conversion.convert(sweep, {0, int(sweep.patient_from_plane.size())}, rows, values.samples);
  return conversion.read();
}

}  // namespace

TEST_CASE("GLSL agrees with the reference: a sweep's lines to a volume") {
  for (const Sweep& sweep : {swept("curvilinear", 33, 12, 40), swept("phased", 40, 17, 60), by_hand()}) {
    INFO(sweep.probe.name);
    std::uint32_t count = 0;  // noise: the steepest possible field
    const SweepValues values = sampled(sweep, 50, [&](const glm::dvec3&) { return unit_float(hash(count++)); });
    const Grid grid = sweep_grid(sweep, 2.0);
    const Volume<float> got = converted(sweep, values, grid);
    const Volume<double> expected = convert_sweep_reference(sweep, values, grid);

    // Single precision places a voxel within 2e-5 mm. There are a few samples or lines per millimetre, and noise
    // changes by up to 1 per sample. At the edge of the sweep rounding alone decides what is inside.
    long inside = 0, at_edge = 0;
    double worst = 0;
    for (std::size_t i = 0; i < grid.count(); ++i) {
      if (std::isnan(got.voxels[i]) != std::isnan(expected.voxels[i])) {
        ++at_edge;
        continue;
      }
      if (std::isnan(expected.voxels[i])) continue;
      worst = std::max(worst, std::abs(double(got.voxels[i]) - expected.voxels[i]));
      ++inside;
    }
    CHECK(worst < 1e-3);
    CHECK(at_edge <= 5);
    CHECK(inside > long(grid.count() / 10));
  }
}

TEST_CASE("a swept volume shows a pattern where it is, to trilinear accuracy") {
  // A wave of 24 mm, rotated and moved relative to the probe and the volume.
  const glm::dvec3 wave = 2 * glm::pi<double>() / 24 * glm::normalize(glm::dvec3(0.4, 0.7, -0.6));
  const auto pattern = [&](const glm::dvec3& p) { return std::sin(glm::dot(wave, p - glm::dvec3(3, 1, 2))); };
  const double curvature = glm::dot(wave, wave);  // of the wave at its crests
  for (const Sweep& sweep : {swept("curvilinear", 64, 33, 40), swept("phased", 64, 33, 40), by_hand()}) {
    INFO(sweep.probe.name);
    const Grid grid = sweep_grid(sweep, 1.7);
    const SweepValues values = sampled(sweep, 60, pattern);
    const ScanLines all = scan_lines(sweep, 60);
    // The error of linear interpolation is at most h^2/8 of the curvature for each of the three steps h, at their
    // widest: samples, lines and planes. Up to half a step beyond the outer lines and samples the value is constant.
    const auto deepest = [&](std::size_t i) { return all.lines[i].start + sweep.depth_mm * all.lines[i].direction; };
    double lines_apart = 0, planes_apart = 0;
    const std::size_t n = std::size_t(sweep.probe.lines);
    for (std::size_t i = 0; i + n < all.lines.size(); ++i) {
      if ((i + 1) % n != 0) lines_apart = std::max(lines_apart, glm::distance(deepest(i), deepest(i + 1)));
      planes_apart = std::max(planes_apart, glm::distance(deepest(i), deepest(i + n)));
    }
    const double squares = all.dr_mm() * all.dr_mm() + lines_apart * lines_apart + planes_apart * planes_apart;
    const double bound = curvature * squares / 8;
    REQUIRE(bound < 0.1);

    const Volume<float> got = converted(sweep, values, grid);
    double worst = 0;
    long looked_at = 0;
    for (int k = 0; k < grid.size.z; ++k)
      for (int j = 0; j < grid.size.y; ++j)
        for (int i = 0; i < grid.size.x; ++i) {
          const glm::dvec3 p = grid.patient_from_index({i, j, k});
          const auto at = sweep_position(sweep, p);
          if (!at) continue;
          bool held = false;
          for (const LinePosition& in : {at->in_this, at->in_next})
            held |= in.line < 0 || in.line > double(n) - 1 || in.r_mm < all.dr_mm() / 2 ||
                    in.r_mm > sweep.depth_mm - all.dr_mm() / 2;
          if (held) continue;
          REQUIRE_FALSE(std::isnan(got.at({i, j, k})));
          worst = std::max(worst, std::abs(double(got.at({i, j, k})) - pattern(p)));
          ++looked_at;
        }
    CHECK(worst < bound);
    CHECK(looked_at > 1000);
  }
}

TEST_CASE("calipers on a swept volume measure an area to 1 %") {
  // A cylinder along an oblique direction: its section with a slice of the volume is an ellipse.
  const Sweep sweep = swept("curvilinear", 128, 65, 40);
  const Pose pose = somewhere();
  const glm::dvec3 centre = pose.point({2, 35, 0}), axis = pose.direction(glm::normalize(glm::dvec3(0.3, 0.2, 1)));
  const double radius = 12;
  const auto outside = [&](const glm::dvec3& p) { return glm::length(glm::cross(p - centre, axis)) - radius; };
  const SweepValues values =
      sampled(sweep, 240, [&](const glm::dvec3& p) { return 0.5 - 0.5 * std::tanh(outside(p) / 0.5); });
  const Grid grid = sweep_grid(sweep, 0.5);
  const Volume<float> got = converted(sweep, values, grid);
  long inside = 0;
  const int slice = grid.size.z / 2;
  for (int j = 0; j < grid.size.y; ++j)
    for (int i = 0; i < grid.size.x; ++i) inside += got.at({i, j, slice}) > 0.5f;
  const double cosine = std::abs(glm::dot(axis, grid.direction[2]));
  CHECK(double(inside) * 0.5 * 0.5 == Approx(glm::pi<double>() * radius * radius / cosine).epsilon(0.01));
}
