// Tests that both ways to traverse lines, one invocation per line and one work group per line, give the same picture.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "sim/imaging/simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/test_divisions.h"
#include "tests/imaging/test_sweeps.h"

using namespace insonate;

namespace {

struct Drawn {
  Stages<float> stages;
  gl::SampleCounts counts;
};

Drawn drawn(const Probe& probe, const Settings& settings, const gl::WorkDivision& division) {
  const test::TestContext context;
  gl::Simulator simulator({}, division);
  simulator.set_volume(test::test_body(), test::tissues());
  simulator.set_probe(probe, test::kDepth_mm);
  // A coarse filter would amplify the rounding differences in position between the two ways.
  simulator.set_settings(test::exact_as_needed(settings));
  simulator.set_pose(test::on_the_skin(0, 9, 0));
  Stages<float> stages = simulator.read_stages();
  return {std::move(stages), simulator.sample_counts()};
}

/// One case: invocations per group, lines, samples per line, and samples per reflection length.
struct Stretched {
  int group, lines, samples;
  double samples_per_length;
};

/// Returns how many samples differ by more than rounding explains. The logarithm of I, down to -46 before a line ends,
/// may differ by some units of its last place, 4e-6; R may differ like the square of I. Below 10^-19 a line has ended,
/// or ends with the next sample.
long count_of_different(const Image<float>& expected, const Image<float>& got) {
  REQUIRE(expected.pixels.size() == got.pixels.size());
  long count = 0;
  for (std::size_t i = 0; i < got.pixels.size(); ++i)
    count += !(std::abs(got.pixels[i] - expected.pixels[i]) <= 2e-5f * expected.pixels[i] + 1e-19f);
  return count;
}

long count_of_rising(const Image<float>& intensity) {
  long count = 0;
  for (int line = 0; line < intensity.width; ++line)
    for (int k = 1; k < intensity.height; ++k) count += intensity.at(line, k) > intensity.at(line, k - 1);
  return count;
}

}  // namespace

TEST_CASE("lines that groups walk along carry what they do where invocations walk, but for how sums are rounded") {
  for (const Stretched& of : {Stretched{4, 61, 90, 2}, Stretched{8, 61, 301, 1}, Stretched{8, 1, 8, 2},
                              Stretched{32, 61, 301, 2}, Stretched{32, 5, 1, 2}, Stretched{32, 3, 8192, 2},
                              Stretched{128, 61, 301, 1.3}, Stretched{128, 1, 100, 2}, Stretched{128, 17, 129, 2}}) {
    CAPTURE(of.group, of.lines, of.samples, of.samples_per_length);
    Probe probe = *find_probe("curvilinear");
    probe.lines = of.lines;
    Settings settings = test::everything();
    settings.image_width = 120;
    settings.image_height = 90;
    settings.samples = of.samples;
    settings.reflection_length_mm = std::min(of.samples_per_length * test::kDepth_mm / of.samples, 20.0);
    for (const bool skipping : {true, false}) {
      CAPTURE(skipping);
      settings.skipping = skipping;
      const Drawn expected = drawn(probe, settings, test::line_an_invocation());
      const Drawn got = drawn(probe, settings, test::line_per_group(of.group));
      CHECK(count_of_different(expected.stages.intensity, got.stages.intensity) == 0);
      CHECK(count_of_different(expected.stages.reflection, got.stages.reflection) == 0);
      CHECK(count_of_rising(got.stages.intensity) == 0);
      int worst = 0;
      for (std::size_t i = 0; i < got.stages.grey.pixels.size(); ++i)
        worst = std::max(worst, std::abs(got.stages.grey.pixels[i] - expected.stages.grey.pixels[i]));
      CHECK(worst <= 1);

      const std::uint32_t lines = std::uint32_t(settings.slice_planes * of.lines);
      CHECK(got.counts.traversed >= expected.counts.traversed);
      CHECK(got.counts.traversed <= expected.counts.traversed + lines * std::uint32_t(of.group - 1));
      CHECK(got.counts.normals >= expected.counts.normals);
      if (skipping) continue;
      CHECK(got.counts.traversed == lines * std::uint32_t(of.samples));
      CHECK(got.counts.normals == expected.counts.normals);
    }
  }
}

TEST_CASE("few lines take a work group each, as many as fill the device an invocation each, of pictures and sweeps") {
  const test::TestContext context;
  Settings settings = test::everything();
  const auto samples_traversed = [&](const Sweep& sweep, std::size_t lines_that_fill) {
    gl::WorkDivision division = test::line_an_invocation(64);
    division.lines_that_fill = lines_that_fill;
    if (sweep.patient_from_plane.size() == 1) {
      gl::Simulator simulator({}, division);
      simulator.set_volume(test::test_body(), test::tissues());
      simulator.set_probe(sweep.probe, sweep.depth_mm);
      simulator.set_settings(settings);
      simulator.set_pose(sweep.patient_from_plane.front());
      simulator.image();
      return std::uint64_t(simulator.sample_counts().traversed);
    }
    gl::SweepSimulator simulator = test::simulator_of(sweep, settings, sweep_grid(sweep, 10), division);
    simulator.volume();
    return simulator.count(gl::SweepStage::traverse).evaluated;
  };
  // Lines of groups end at the end of a stretch.
  for (const int planes : {1, 3}) {
    CAPTURE(planes);
    Sweep sweep = test::by_hand();
    sweep.patient_from_plane.resize(std::size_t(planes));
    const std::size_t lines = std::size_t(planes * sweep.probe.lines);
    const std::uint64_t by_invocations = samples_traversed(sweep, 0);
    CHECK(samples_traversed(sweep, lines) == by_invocations);
    CHECK(samples_traversed(sweep, lines + 1) > by_invocations);
  }
}
