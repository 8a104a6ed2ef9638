// Model W on the processor, what the graphics pipeline is timed against, against the reference: only then do the times
// compare the same work.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "sim/wein/wein_reference.h"
#include "tests/imaging/test_body.h"
#include "tools/bench/processor/wein_on_processor.h"

using namespace insonate;

namespace {

using Simulate = decltype(&bench::simulate_plainly);

void check(Simulate simulate, const WeinSettings& settings, int count, int tolerance) {
  const AcousticVolume body = test::test_body();
  Probe probe = *find_probe("curvilinear");
  probe.lines = 61;  // no multiple of the eight lines that are traversed together
  const bench::DensityVoxels ct(body, settings.reflection_length_mm);
  const bench::ProcessorFan fan(probe, 110, settings);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) poses.push_back(test::on_the_skin(4 * i - 6, 3 * i, 5 * i - 4));

  const std::size_t size = std::size_t(settings.image_width) * std::size_t(settings.image_height);
  std::vector<std::uint8_t> pictures(size * poses.size());
  simulate(ct, fan, settings, poses, pictures);
  const WeinField field = wein_field(body, settings.reflection_length_mm);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const WeinStages<double> expected = wein_reference(field, probe, 110, settings, poses[i]);
    int worst = 0, brightest = 0;
    for (std::size_t pixel = 0; pixel < size; ++pixel) {
      const int got = pictures[i * size + pixel];
      worst = std::max(worst, std::abs(int(expected.grey.pixels[pixel]) - got));
      brightest = std::max(brightest, got);
    }
    INFO("image " << i);
    CHECK(worst <= tolerance);
    CHECK(brightest > 60);  // a black image would agree as well
  }
}

WeinSettings odd_settings() {
  WeinSettings settings;
  settings.samples = 83;
  settings.image_width = 75;
  settings.image_height = 61;
  return settings;
}

}  // namespace

// The voxels' gradient is stored in single precision, which moves a term by 1e-7: a grey level on its border.
TEST_CASE("the plain processor draws the reference's images") {
  check(bench::simulate_plainly, odd_settings(), 2, 1);
}

// Single precision throughout: 1e-4 of each term, as on the device, is far below one grey level, but can cross the
// border between two.
TEST_CASE("the vectorised processor draws the reference's images, alone and many at once") {
  WeinSettings settings = odd_settings();
  check(bench::simulate_vectorised, settings, 1, 1);
  check(bench::simulate_vectorised, settings, 3, 1);
  settings.shadows = false;
  settings.contact_mm = 0;
  settings.reflection_share = 0.8;
  check(bench::simulate_vectorised, settings, 2, 1);
}
