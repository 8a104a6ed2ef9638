// Tests a sweep as one set of lines on the graphics card. It is compared with the simulator of pictures plane by plane.
// It must not depend on how much a device takes at once, and must run only the stages that a change affects.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/gl/test_context.h"
#include "tests/imaging/changed_simulator.h"
#include "tests/imaging/swept_lines.h"
#include "tests/imaging/test_divisions.h"
#include "tests/imaging/test_sweeps.h"

using namespace insonate;
using test::everything;
using test::of_the_paper;
using test::simulator_of;
using test::swept;
using test::tissues;

namespace {

struct Volumes {
  std::vector<float> fused;
  std::vector<std::int16_t> grey;
};

Volumes volumes_of(const Sweep& sweep, const Settings& settings, const Grid& grid, const gl::WorkDivision& division) {
  const test::TestContext context;
  gl::SweepSimulator simulator = simulator_of(sweep, settings, grid, division);
  Volumes volumes{simulator.read_fused().voxels, simulator.read_grey().voxels};
  for (float& echo : volumes.fused)
    if (std::isnan(echo)) echo = -1;  // which equals itself, unlike NaN
  return volumes;
}

template <typename Number>
long count_of_different(const std::vector<Number>& a, const std::vector<Number>& b) {
  REQUIRE(a.size() == b.size());
  long count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

}  // namespace

TEST_CASE("the lines of many planes hold what each plane's picture holds, to the last bit") {
  const gl::WorkDivision division = GENERATE(test::line_an_invocation(), test::line_per_group());
  CAPTURE(division.lines_that_fill);
  // Windows too wide for the array: a window that continued into the next plane's lines would take its other end.
  for (const bool focused : {false, true}) {
    Settings settings = everything();
    settings.focused_beam = focused;
    settings.beam_lines = 21;
    settings.f_number = 2;
    settings.focus_mm = 20;
    if (!focused) settings.elevation_focus_mm = 0;  // lines of bent planes start whatever they meet
    const test::TestContext context;
    const std::vector<test::SweptPlane> planes = test::swept_lines(settings, division);
    for (std::size_t plane = 0; plane < planes.size(); ++plane) {
      CAPTURE(focused, plane);
      const auto& [picture, scan, echoes] = planes[plane];
      long differ = 0;
      for (int line = 0; line < scan.width; ++line)
        for (int k = 0; k < scan.height; ++k) {
          differ += scan.at(line, k)[0] != picture.intensity.at(line, k);
          differ += scan.at(line, k)[1] != picture.reflection.at(line, k);
          differ +=
              echoes.at(line, k) != std::array{picture.reflection_beam.at(line, k), picture.transmission.at(line, k),
                                               picture.speckle.at(line, k), picture.repeated.at(line, k)};
        }
      CHECK(differ == 0);
    }
  }
}

TEST_CASE("a volume is the same to the last bit whatever lines, planes and voxels a device takes at once") {
  const Sweep sweep = swept("curvilinear", 11);
  Grid grid = sweep_grid(sweep, 5);
  grid.size -= glm::ivec3(1, 2, 0);
  if (grid.size.x % 2 == 0) --grid.size.x;
  if (grid.size.y % 2 == 0) --grid.size.y;
  REQUIRE(grid.count() % 4 != 0);  // the number of voxels that one invocation packs together
  for (const Settings& settings : {everything(), of_the_paper()}) {
    const Volumes at_once = volumes_of(sweep, settings, grid, {});
    CHECK(std::ranges::count_if(at_once.grey, [](int grey) { return grey > 0; }) > 1000);
    gl::WorkDivision rows, groups, parts, pairs;
    rows.most_groups = 7;  // of 38 lines each, of more voxels
    groups.group = 64;
    // Four planes, and some slices of the volume; neither is divided evenly.
    parts.most_texels = std::size_t(4 * sweep.probe.lines * settings.samples);
    pairs.most_texels = 1;  // two planes, one slice
    for (const gl::WorkDivision& division : {rows, groups, parts, pairs}) {
      CAPTURE(division.most_groups, division.group, division.most_texels);
      const Volumes got = volumes_of(sweep, settings, grid, division);
      CHECK(count_of_different(got.fused, at_once.fused) == 0);
      CHECK(count_of_different(got.grey, at_once.grey) == 0);
    }
  }
}

TEST_CASE("a sweep runs the first stage that a change reaches and those behind it, and nothing when it is still") {
  const test::TestContext context;
  for (const bool in_parts : {false, true}) {
    CAPTURE(in_parts);
    Sweep sweep = swept("curvilinear", 6);
    Settings settings = everything();
    settings.samples = 64;
    settings.slice_planes = 1;
    settings.skipping = false;
    Grid grid = sweep_grid(sweep, 8);
    gl::WorkDivision division = gl::WorkDivision::of_device();
    if (in_parts) division.most_texels = 3 * 30 * 64;
    gl::SweepSimulator simulator = simulator_of(sweep, settings, grid, division);
    const auto after = [&](const std::function<void()>& change) {
      const auto before = simulator.runs();
      change();
      simulator.set_settings(settings);
      simulator.set_sweep(sweep);
      simulator.set_grid(grid);
      simulator.volume();
      return test::stages_run(before, simulator.runs());
    };
    // If the sweep is processed in parts, only the lines of the last part are stored.
    const auto lines_too = [&](const char* stages) { return std::string(in_parts ? "01235" : stages); };
    CHECK(after([] {}) == "01235");
    CHECK(after([] {}) == "");
    CHECK(after([&] { sweep.patient_from_plane[1].translation.x += 0.5; }) == "01235");
    CHECK(after([&] { settings.f_number = 5; }) == lines_too("1235"));
    CHECK(after([&] { settings.noise_db += 3; }) == lines_too("235"));
    CHECK(after([&] { grid.origin.x += 1; }) == lines_too("35"));
    CHECK(after([&] { settings.gain_db += 6; }) == "5");
    CHECK(after([&] { settings.tgc_db[3] += 6; }) == "5");
    CHECK(after([&] { settings.dynamic_range_db -= 5; }) == "5");
    CHECK(after([&] { settings.image_width = 100; }) == "");
    CHECK(after([&] { settings.reflection_sigma_mm *= 2; }) == "");
    CHECK(after([&] { settings.reference_level = ReferenceLevel::frame_maximum; }) == "45");
    CHECK(after([&] { settings.gain_db -= 6; }) == "45");
    CHECK(after([&] { settings.dynamic_range_db -= 5; }) == "5");
    CHECK(simulator.read_grey().voxels == simulator_of(sweep, settings, grid, division).read_grey().voxels);

    const gl::StageCount traversed = simulator.count(gl::SweepStage::traverse);
    const std::uint64_t planes = in_parts ? 3 + 3 + 2 : 6;  // the planes where parts meet are traversed twice
    CHECK(traversed.possible == planes * 30 * 64);
    CHECK(traversed.evaluated == traversed.possible);
    CHECK(simulator.count(gl::SweepStage::compress).evaluated == grid.count());
  }
}

TEST_CASE("a volume after a change is the volume that a new simulator makes") {
  const test::TestContext context;
  for (const bool in_parts : {false, true}) {
    Sweep sweep = swept("curvilinear", 6);
    Settings settings = everything();
    settings.samples = 64;
    Grid grid = sweep_grid(sweep, 8);
    gl::WorkDivision division = gl::WorkDivision::of_device();
    if (in_parts) division.most_texels = 3 * 30 * 64;
    gl::SweepSimulator simulator = simulator_of(sweep, settings, grid, division);
    simulator.volume();
    const std::vector<std::function<void()>> changes = {
        [&] { settings.samples = 48; },
        [&] { settings.reflection_length_mm *= 2; },
        [&] { settings.slice_planes = 1; },
        [&] { settings.clutter = false; },
        [&] { settings.noise_db += 6; },
        [&] { settings.electronic_noise = false; },
        [&] { settings.speckle_seed = 7; },
        [&] { settings.focused_beam = false; },
        [&] { sweep.depth_mm = 90; },
        [&] { sweep.probe.lines = 21; },
        [&] { sweep.probe = test::small_probe("phased"); },
        [&] { sweep.patient_from_plane.pop_back(); },
        [&] { sweep.patient_from_plane[2].translation.x += 1; },
        [&] { grid = sweep_grid(sweep, 6); },
        [&] { settings.clutter = settings.electronic_noise = true; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
      CAPTURE(in_parts, i);
      changes[i]();
      simulator.set_sweep(sweep);
      simulator.set_settings(settings);
      simulator.set_grid(grid);
      const std::vector<std::int16_t> grey = simulator.read_grey().voxels;
      CHECK(std::ranges::count_if(grey, [](int g) { return g > 20; }) > 100);
      CHECK(grey == simulator_of(sweep, settings, grid, division).read_grey().voxels);
    }

    AcousticVolume liver = test::test_body();
    liver.voxels.assign(liver.grid.count(), {60, 0});
    simulator.set_volume(liver, tissues());
    gl::SweepSimulator anew = simulator_of(sweep, settings, grid, division);
    CHECK(simulator.read_grey().voxels != anew.read_grey().voxels);
    anew.set_volume(liver, tissues());
    CHECK(simulator.read_grey().voxels == anew.read_grey().voxels);

    CHECK(!simulator.reload(gl::ShaderSources()));
    CHECK(simulator.read_grey().voxels == anew.read_grey().voxels);
  }
}

TEST_CASE("a volume beside its sweep is all outside, and one of its planes alone is refused") {
  const test::TestContext context;
  Sweep sweep = swept("linear", 3);
  Grid grid = sweep_grid(sweep, 8);
  grid.origin += glm::dvec3(2000);
  gl::SweepSimulator simulator = simulator_of(sweep, of_the_paper(), grid);
  CHECK(std::ranges::all_of(simulator.read_grey().voxels, [](int grey) { return grey == -1; }));
  sweep.patient_from_plane.resize(1);
  CHECK_THROWS_AS(simulator.set_sweep(sweep), std::invalid_argument);
}
