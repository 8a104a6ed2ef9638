// Tests probes that parity_gl_test.cpp does not compare stage by stage. A probe alone decides where its lines and
// pixels lie, and that shows in the picture.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

#include "sim/imaging/simulator.h"
#include "sim/reference/reference.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

TEST_CASE("GLSL agrees with the reference: phased probe") {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Probe probe = *find_probe("phased");
  probe.lines = 96;
  Settings settings = trainer_settings(probe.frequency_mhz, 120);
  settings.image_width = 200;
  settings.image_height = 160;
  settings = test::exact_as_needed(settings);
  const Pose pose = test::on_the_skin(0, 9, 12);

  gl::Simulator simulator;
  simulator.set_volume(body, table);
  simulator.set_probe(probe, 120);
  simulator.set_settings(settings);
  simulator.set_pose(pose);
  const Stages<float> got = simulator.read_stages();
  const Stages<double> expected = simulate_reference(trilinear_field(body), table, probe, 120, settings, pose);

  REQUIRE(expected.inside.pixels == got.inside.pixels);
  const std::size_t count = expected.grey.pixels.size();
  long inside = 0, off_by_more_than_1 = 0, sum = 0;
  int worst = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!expected.inside.pixels[i]) continue;
    const int error = std::abs(int(expected.grey.pixels[i]) - int(got.grey.pixels[i]));
    worst = std::max(worst, error);
    off_by_more_than_1 += error > 1;
    sum += expected.grey.pixels[i];
    ++inside;
  }
  INFO(off_by_more_than_1 << " of " << inside << " pixels off by more than 1, worst " << worst);
  CHECK(double(off_by_more_than_1) <= 0.001 * double(inside));
  CHECK(worst <= 2);
  CHECK(double(sum) / double(inside) > 10);  // a black picture would agree as well
}
