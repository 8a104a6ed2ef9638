// The paper's method of traversal, the benchmarks' baseline, against the reference with the tolerances of the
// simulator's own: only then do times of the two compare the same work.

#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/test_body.h"
#include "tests/model/amplitudes.h"
#include "tools/bench/paper_traversal.h"

using namespace insonate;

namespace {

void check(const Settings& settings, const Pose& pose) {
  const AcousticVolume body = test::test_body();
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Probe probe = *find_probe("curvilinear");
  probe.lines = 67;  // no multiple of any width that a device shades at once
  const ScanLines lines = scan_lines(probe, 110, settings.samples);

  const test::TestContext context;
  if (test::own_filter_is_coarse()) {
    WARN("skipped: the paper's passes have the device's own filter, which is coarse here");
    return;
  }
  gl::PaperTraversal traversal;
  traversal.set_volume(body, table);
  traversal.set_lines(lines, settings);
  traversal.run(test::on_the_skin(-20, 2, 30));  // of which the next run must show nothing
  traversal.run(pose);
  const gl::PaperTraversal::Scan got = traversal.read();

  const MediumField field = trilinear_field(body);
  const ReferenceScan expected = traverse_reference(field, table, lines, settings, pose);
  std::array<ReferenceScan, 4> uncertain;
  for (std::uint32_t i = 0; i < uncertain.size(); ++i)
    uncertain[i] = traverse_reference(test::as_single_precision_knows_it(field, i), table, lines, settings, pose);

  // I: 1e-4 relative, or 1e-10 below 1e-6. R: 1e-4 of the brightest.
  const test::Worst intensity = test::worst(expected.intensity, got.intensity,
                                            test::tolerated(expected, uncertain, &ReferenceScan::intensity,
                                                            [](double value) { return 1e-4 * std::max(value, 1e-6); }));
  INFO(test::described("I", intensity));
  CHECK(intensity.error < 1);
  const double brightest = *std::max_element(expected.reflection.pixels.begin(), expected.reflection.pixels.end());
  REQUIRE(brightest > 0);
  const test::Worst reflection = test::worst(
      expected.reflection, got.reflection,
      test::tolerated(expected, uncertain, &ReferenceScan::reflection, [&](double) { return 1e-4 * brightest; }));
  INFO(test::described("R", reflection));
  CHECK(reflection.error < 1);
}

}  // namespace

TEST_CASE("the paper's passes agree with the reference in the paper's own mode") {
  check(paper_settings(110, 301), test::on_the_skin(5, 12, 0));
}

TEST_CASE("the paper's passes agree with the reference in the trainer's mode, two samples a reflection length or any") {
  Settings settings = test::trainer_with_amplitudes(3.5, 110);
  settings.slice_planes = 1;  // the paper knows neither
  settings.edge_shadow = false;
  settings.samples = 300;
  for (const double samples_per_length : {2.0, 1.0, 1.63}) {
    CAPTURE(samples_per_length);
    settings.reflection_length_mm = samples_per_length * 110 / 300;
    check(settings, test::on_the_skin(0, 9, 12));
  }
}
