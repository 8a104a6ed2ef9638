// Compares the GLSL pipeline with the double-precision reference, stage by stage.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/core/hash.h"
#include "sim/imaging/simulator.h"
#include "sim/reference/reference.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/stage_parity.h"
#include "tests/imaging/test_body.h"
#include "tests/imaging/test_divisions.h"
#include "tests/model/amplitudes.h"

using namespace insonate;

namespace {

void check_parity_as_set(const Probe& probe, double depth_mm, Settings settings, const Pose& pose) {
  settings.skipping = false;  // which the reference does not implement
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const MediumField field = trilinear_field(body);
  const test::ReferenceStages reference = test::reference_stages(field, table, probe, depth_mm, settings, pose);
  for (const gl::WorkDivision& division :
       {test::line_an_invocation(), test::line_per_group(), test::line_per_group(32)}) {
    gl::Simulator simulator({}, division);
    simulator.set_volume(body, table);
    simulator.set_probe(probe, depth_mm);
    simulator.set_pose(pose);
    for (const bool exact : {true, false}) {
      if (!exact && test::own_filter_is_coarse()) continue;
      settings.exact_filter = exact;
      simulator.set_settings(settings);
      INFO((exact ? "exact filtering" : "the device's own filter"));
      INFO((division.lines_that_fill > 0 ? "a line a group of " : "a line an invocation, in groups of ")
           << division.group);
      test::check_stages(reference, simulator.read_stages(), scan_lines(probe, depth_mm, settings.samples), settings);
    }
  }
}

/// Checks the paper's sums of amplitudes and the trainer's of waves.
void check_parity(const Probe& probe, double depth_mm, Settings settings, const Pose& pose) {
  for (const bool waves : {false, true}) {
    INFO((waves ? "waves" : "amplitudes"));
    settings.waves = waves;
    check_parity_as_set(probe, depth_mm, settings, pose);
  }
}

Settings small(Settings settings) {
  settings.samples = 300;
  settings.image_width = 200;
  settings.image_height = 160;
  return settings;
}

/// Does the same where a rib, a cyst and gas lie in the picture.
void check_parity_over_rib_and_gas(const Settings& settings) {
  Probe probe = *find_probe("curvilinear");
  probe.lines = 64;
  check_parity(probe, 120, settings, test::on_the_skin(0, 9, 12));
}

}  // namespace

TEST_CASE("GLSL agrees with the reference: curvilinear probe, everything on") {
  Probe probe = *find_probe("curvilinear");
  probe.lines = 96;
  check_parity(probe, 120, small(trainer_settings(3.5, 120)), test::on_the_skin(0, 9, 12));
}

TEST_CASE("GLSL agrees with the reference: linear probe, a wide beam of each window") {
  Probe probe = *find_probe("linear");
  probe.lines = 80;
  Settings settings = small(trainer_settings(7.5, 60));
  settings.focused_beam = false;
  settings.beam_window = GENERATE(BeamWindow::box, BeamWindow::triangle, BeamWindow::hann);
  settings.beam_lines = 11;
  settings.transmission_sigma_mm = 1.5;
  check_parity(probe, 60, settings, test::on_the_skin(-10, 1, -8));
}

TEST_CASE("GLSL agrees with the reference: the paper's own mode") {
  Probe probe = *find_probe("curvilinear");
  probe.lines = 64;
  Settings settings = small(paper_settings(110, 300));
  settings.speckle = false;
  check_parity(probe, 110, settings, test::on_the_skin(5, 12, 0));
}

TEST_CASE("GLSL agrees with the reference: loud receiver's noise, every grey map") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.noise_db = -75;  // visible from the middle of the picture on
  settings.clutter_db = -15;
  settings.grey_map = GENERATE(GreyMap::linear, GreyMap::soft, GreyMap::contrast, GreyMap::s_curve);
  check_parity_over_rib_and_gas(settings);
}

TEST_CASE("GLSL agrees with the reference: a beam focused near the face, wider than the array's edge allows") {
  Probe probe = *find_probe("linear");
  probe.lines = 80;
  Settings settings = small(trainer_settings(5, 60));
  settings.focus_mm = 15;
  settings.f_number = 2;
  check_parity(probe, 60, settings, test::on_the_skin(-10, 1, -8));
}

TEST_CASE("GLSL agrees with the reference: a slice of three planes") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.slice_planes = 3;
  settings.slice_thickness_mm = 5;
  check_parity_over_rib_and_gas(settings);
}

TEST_CASE("GLSL agrees with the reference: a face that reflects everything over a rib and gas") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.face_reflection = 1;
  check_parity_over_rib_and_gas(settings);
}

TEST_CASE("GLSL agrees with the reference: reverberation between a rib's faces, gas and the skin") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.reverberation = true;
  settings.reflection_length_mm = 3;  // a blurred face of the rib is then strong enough to ring
  settings.face_reflection = 0.3;
  settings.gain_db = 20;
  check_parity_over_rib_and_gas(settings);
}

TEST_CASE("GLSL agrees with the reference: what gas and the face of a rib mirror") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.mirror_image = 1;
  settings.slice_planes = GENERATE(1, 3);
  settings.reverberation = settings.slice_planes == 3;
  settings.gain_db = 20;
  check_parity_over_rib_and_gas(settings);
}

TEST_CASE("GLSL agrees with the reference: what gas mirrors again and again, 26 mm from the face") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.face_reflection = 0.5;
  Probe probe = *find_probe("curvilinear");
  probe.lines = 64;
  check_parity(probe, 120, settings, test::on_the_skin(18, 60, 0));
}

TEST_CASE("GLSL agrees with the reference: a slice that is thinnest at its focus") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.slice_planes = 5;
  settings.slice_thickness_mm = 2;
  settings.elevation_focus_mm = 40;
  check_parity_over_rib_and_gas(settings);
}

TEST_CASE("GLSL agrees with the reference: shadows at the edges of a rib, a cyst and gas") {
  Settings settings = small(trainer_settings(3.5, 120));
  settings.edge_shadow = true;
  check_parity_over_rib_and_gas(settings);
}

TEST_CASE("GLSL agrees with the reference: speckle from a scattering volume") {
  const test::TestContext context;
  Probe probe = *find_probe("curvilinear");
  probe.lines = 64;
  Settings settings = small(trainer_settings(3.5, 120));
  settings.waves = settings.skipping = false;
  settings.slice_planes = 3;
  const AcousticVolume body = test::test_body();
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  // Turned, with voxels of three lengths, and ending within the picture.
  StoredSpeckle stored;
  stored.grid.size = {40, 90, 30};
  stored.grid.spacing = {2.1, 1.3, 1.7};
  stored.grid.direction = test::on_the_skin(0, 0, 25).rotation;
  stored.grid.origin = glm::dvec3(-40, 5, -25);
  for (std::size_t v = 0; v < stored.grid.count(); ++v) stored.voxels.push_back(2 * unit_float(hash(std::uint32_t(v))));
  const Pose pose = test::on_the_skin(0, 9, 12);
  const MediumField field = trilinear_field(body);
  test::ReferenceStages reference;
  reference.exact = simulate_reference(field, table, probe, 120, settings, pose, &stored);
  for (std::uint32_t i = 0; i < reference.uncertain.size(); ++i) {
    // Places are known in single precision, along a line as sums of steps.
    Pose near = pose;
    for (int axis = 0; axis < 3; ++axis) near.translation[axis] += 2e-5 * (i >> axis & 1u ? 1 : -1);
    reference.uncertain[i] =
        simulate_reference(test::as_single_precision_knows_it(field, i), table, probe, 120, settings, near, &stored);
  }
  double most = 0, least = 1;
  for (const double s : reference.exact.speckle.pixels) most = std::max(most, s), least = std::min(least, s);
  CHECK(most > 1.5);
  CHECK(least == 0);
  gl::Simulator simulator;
  simulator.set_volume(body, table);
  simulator.set_probe(probe, 120);
  simulator.set_pose(pose);
  settings.exact_filter = test::own_filter_is_coarse();
  simulator.set_settings(settings);
  const Stages<float> drawn = simulator.read_stages();
  simulator.set_stored_speckle(&stored);
  test::check_stages(reference, simulator.read_stages(), scan_lines(probe, 120, settings.samples), settings);
  simulator.set_stored_speckle(nullptr);
  CHECK((simulator.read_stages().speckle.pixels == drawn.speckle.pixels));
}

TEST_CASE("a frame without any echo is black, not NaN") {
  const test::TestContext context;
  AcousticVolume water;
  water.grid.size = {60, 60, 60};
  water.grid.origin = glm::dvec3(-30);
  water.voxels.assign(water.grid.count(), {0, -6000});
  Settings settings = small(paper_settings(20, 32));
  settings.blend = 0;
  gl::Simulator simulator;
  simulator.set_volume(water, read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(*find_probe("linear"), 20);
  simulator.set_settings(settings);
  const Stages<float> stages = simulator.read_stages();
  REQUIRE(std::count(stages.inside.pixels.begin(), stages.inside.pixels.end(), 1) > 1000);
  CHECK(std::all_of(stages.fused.pixels.begin(), stages.fused.pixels.end(), [](float u) { return u == 0; }));
  CHECK(std::all_of(stages.grey.pixels.begin(), stages.grey.pixels.end(), [](int grey) { return grey == 0; }));
}

TEST_CASE("what is skipped changes no pixel by more than a grey level") {
  const test::TestContext context;
  const gl::WorkDivision division = GENERATE(test::line_an_invocation(), test::line_per_group());
  CAPTURE(division.lines_that_fill);
  gl::Simulator simulator({}, division);
  simulator.set_volume(test::test_body(), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(*find_probe("curvilinear"), 120);
  const auto sized = [](Settings settings) {
    settings.image_width = 400;
    settings.image_height = 300;
    return settings;
  };
  // The trainer's settings; loud ones with nothing over the shadows, into which a wide beam carries echoes; and the
  // paper's, whose range is narrow enough to spread few decibels over many levels.
  const Settings trainer = sized(trainer_settings(3.5, 120));
  Settings bare = trainer;
  bare.clutter = bare.electronic_noise = false;
  bare.gain_db = 30;
  Settings noisy = bare, hazy = bare, blended = trainer;
  noisy.electronic_noise = true;
  hazy.clutter = true;
  blended.blend = 1000;  // so much echo that noise does not cover the air's echo
  Settings wide = bare;
  wide.focused_beam = false;
  wide.beam_window = BeamWindow::box;
  wide.beam_lines = 63;
  Settings narrow = sized(paper_settings(120, 512));
  narrow.reference_level = ReferenceLevel::fixed;
  narrow.fixed_level = 1e-9;
  narrow.beam_lines = 63;
  narrow.dynamic_range_db = 20;
  Settings bent = bare;
  bent.elevation_focus_mm = 60;
  bent.slice_thickness_mm = 12;
  std::uint32_t skipped_normals = 0;
  // Over the rib, the cyst and the gas; half off the body; rotated away so that lines leave the body again; beside it.
  for (const Pose& pose : {test::on_the_skin(0, 9, 12), test::on_the_skin(-25, 5, 0), test::on_the_skin(20, 8, -15),
                           test::on_the_skin(60, 2, 0), test::on_the_skin(0, 4, 70), test::on_the_skin(0, -40, 180),
                           test::on_the_skin(72, -8, 20)}) {
    simulator.set_pose(pose);
    for (Settings settings : {trainer, bare, noisy, hazy, blended, wide, narrow, bent}) {
      const auto grey = [&](bool skipping) {
        settings.skipping = skipping;
        simulator.set_settings(settings);
        return simulator.read_stages().grey;
      };
      const Image<std::uint8_t> skipped = grey(true);
      const gl::SampleCounts counts = simulator.sample_counts();
      const Image<std::uint8_t> whole = grey(false);
      CHECK(simulator.sample_counts().traversed ==
            std::uint32_t(settings.slice_planes * find_probe("curvilinear")->lines * settings.samples));
      skipped_normals += simulator.sample_counts().normals - counts.normals;
      int worst_change = 0;
      for (std::size_t i = 0; i < whole.pixels.size(); ++i)
        worst_change = std::max(worst_change, std::abs(int(skipped.pixels[i]) - int(whole.pixels[i])));
      INFO("clutter " << settings.clutter << ", noise " << settings.electronic_noise << ", blend " << settings.blend);
      INFO("gain " << settings.gain_db << " dB, beam of " << settings.beam_lines << " lines");
      CHECK(worst_change <= 1);
    }
  }
  CHECK(skipped_normals > 10000);
}

TEST_CASE("a line that meets no body does not start") {
  const test::TestContext context;
  gl::Simulator simulator({}, GENERATE(test::line_an_invocation(), test::line_per_group()));
  simulator.set_volume(test::test_body(), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  const Probe probe = *find_probe("linear");
  simulator.set_probe(probe, 50);
  Settings settings = small(trainer_settings(7.5, 50));
  settings.elevation_focus_mm = GENERATE(0, 25);  // planes bend then
  CAPTURE(settings.elevation_focus_mm);
  const auto traversed = [&](const Pose& pose) {
    simulator.set_pose(pose);
    simulator.set_settings(settings);
    simulator.image();
    return simulator.sample_counts().traversed;
  };
  const Pose beside = test::on_the_skin(0, -60, 180), on_the_edge = test::on_the_skin(72, 4, 0),
             too_far = test::on_the_skin(0, -120, 0);
  CHECK(traversed(beside) == 0);
  CHECK(traversed(too_far) == 0);
  const std::uint32_t on_edge = traversed(on_the_edge);
  CHECK(on_edge > 0);
  settings.skipping = false;
  const std::uint32_t all = traversed(on_the_edge);
  CHECK(all == std::uint32_t(settings.slice_planes * probe.lines * settings.samples));
  CHECK(on_edge < 0.8 * all);
}

TEST_CASE("where there is only air no line starts, and one starts that passes beside the body") {
  const test::TestContext context;
  gl::Simulator simulator({}, GENERATE(test::line_an_invocation(), test::line_per_group()));
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  AcousticVolume block;
  block.grid.size = {20, 40, 20};
  block.grid.spacing = glm::dvec3(2);
  block.grid.origin = {-19, 0, -19};
  Settings settings = small(test::trainer_with_amplitudes(7.5, 60));
  settings.absorption = false;  // so that nothing ends a line
  Probe probe = *find_probe("linear");
  probe.lines = 1;
  simulator.set_probe(probe, 60);
  const auto traversed_of = [&](const AcousticVoxel& voxel) {
    block.voxels.assign(block.grid.count(), voxel);
    simulator.set_volume(block, table);
    simulator.set_settings(settings);
    simulator.image();
    return simulator.sample_counts().traversed;
  };
  simulator.set_pose(test::on_the_skin(0, 0, 20));  // parallel to no axis
  CHECK(traversed_of({}) == 0);

  // Nothing of a block 5 mm beside the line lies on it. But the edge of the block refracts sound that is within half
  // the reflection length of it.
  simulator.set_pose({});
  block.grid.origin.x = 6;
  settings.gel_mm = 100;
  settings.reflection_length_mm = 15;
  settings.slice_planes = 1;
  CHECK(traversed_of({140, 0}) > 0);
  const Image<float> intensity = simulator.read_stages().intensity;
  CHECK(intensity.at(0, intensity.height - 1) < 0.99f * intensity.at(0, 0));
  settings.skipping = false;
  simulator.set_settings(settings);
  CHECK(simulator.read_stages().intensity.pixels == intensity.pixels);

  // The same with planes that bend: far from the elevation focus the outer two reach what lies beside all of them here.
  settings.skipping = true;
  settings.frequency_mhz = 0.5;
  settings.slice_thickness_mm = 0.5;
  settings.elevation_focus_mm = 5;
  settings.slice_planes = 3;
  settings.reflection_length_mm = 0.6;
  block.grid.origin = {-19, 0, 30};
  CHECK(traversed_of({140, 0}) > 0);
  const Image<float> bent = simulator.read_stages().speckle;
  CHECK(bent.at(0, 0) == 0);
  CHECK(bent.at(0, bent.height - 1) > 0);
  settings.skipping = false;
  simulator.set_settings(settings);
  CHECK(simulator.read_stages().speckle.pixels == bent.pixels);
}

TEST_CASE("settings out of their range are refused by name, and those before stay") {
  const test::TestContext context;
  gl::Simulator simulator;
  simulator.set_volume(test::test_body(), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(*find_probe("curvilinear"), 100);
  Settings settings = small(trainer_settings(3.5, 100));
  simulator.set_settings(settings);
  settings.beam_lines = 4;
  CHECK_THROWS_WITH(simulator.set_settings(settings), Catch::Contains("'beam_lines' is 4"));
  CHECK_THROWS_AS(simulator.set_settings(settings), std::invalid_argument);
  CHECK(simulator.image().width() == 200);
}
