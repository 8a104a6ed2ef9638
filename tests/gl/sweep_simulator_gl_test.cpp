// A sweep as one set of lines on the graphics card: against the reference in double precision, and against the
// simulator of pictures plane by plane; the same whatever a device takes at once; and nothing run that a change does
// not reach.

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/gl/line_stages.h"
#include "sim/gl/simulator.h"
#include "sim/gl/stage_tables.h"
#include "sim/gl/sweep_simulator.h"
#include "sim/reference/sweep_reference.h"
#include "tests/gl/parity.h"
#include "tests/gl/test_body.h"
#include "tests/gl/test_context.h"

using namespace insonate;

namespace {

constexpr double kDepth_mm = 110;

const TissueTable& tissues() {
  static const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  return table;
}

Probe small_probe(const char* name) {
  Probe probe = *find_probe(name);
  probe.lines = 30;  // no multiple of a work group, nor of the four lines that share their windows
  return probe;
}

/// Over the rib, the cyst and the gas.
Sweep swept(const char* probe_name, int planes = 9) {
  const Probe probe = small_probe(probe_name);
  return {probe, kDepth_mm, swept_planes(test::on_the_skin(0, 9, 0), planes, 40, 30)};
}

/// As a hand moves: each plane turned and moved against the one before by another way.
Sweep by_hand() {
  Sweep sweep{small_probe("curvilinear"), kDepth_mm, {}};
  Pose patient_from_plane = test::on_the_skin(-6, 7, -12);
  for (int k = 0; k < 9; ++k) {
    sweep.patient_from_plane.push_back(patient_from_plane);
    const glm::dmat4 turn =
        glm::rotate(glm::dmat4(1.0), 0.03 + 0.02 * (k % 3), glm::normalize(glm::dvec3(1, 0.5 * std::sin(k), 0.2)));
    patient_from_plane = patient_from_plane * Pose{glm::dmat3(turn), {std::cos(k), 0.3, 2.5 + k % 2}};
  }
  return sweep;
}

/// Every effect on, and enough of each to show.
Settings everything() {
  Settings settings = trainer_settings(3.5, kDepth_mm);
  settings.samples = 150;
  settings.reverberation = settings.clutter = settings.electronic_noise = settings.edge_shadow = true;
  settings.face_reflection = 0.3;
  settings.clutter_db = -15;
  settings.noise_db = -80;
  settings.slice_planes = 3;
  settings.gain_db = 10;
  return settings;
}

Settings of_the_paper() {
  Settings settings = paper_settings(kDepth_mm, 150);
  settings.blend = 1e-3;  // else its one brightest voxel leaves the rest black
  return settings;
}

gl::SweepSimulator simulator_of(const Sweep& sweep, const Settings& settings, const Grid& grid,
                                const gl::Scheme& scheme = gl::Scheme::of_device()) {
  gl::SweepSimulator simulator({}, scheme);
  simulator.set_volume(test::test_body(), tissues());
  simulator.set_sweep(sweep);
  simulator.set_settings(settings);
  simulator.set_grid(grid);
  return simulator;
}

struct Volumes {
  std::vector<float> fused;
  std::vector<std::int16_t> grey;
};

Volumes volumes_of(const Sweep& sweep, const Settings& settings, const Grid& grid, const gl::Scheme& scheme) {
  const test::TestContext context;
  gl::SweepSimulator simulator = simulator_of(sweep, settings, grid, scheme);
  Volumes volumes{simulator.read_fused().voxels, simulator.read_grey().voxels};
  for (float& echo : volumes.fused)
    if (std::isnan(echo)) echo = -1;  // which equals itself
  return volumes;
}

template <typename Number>
long count_of_different(const std::vector<Number>& a, const std::vector<Number>& b) {
  REQUIRE(a.size() == b.size());
  long count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

Image<double> row_of(const std::vector<double>& values) {
  Image<double> row(int(values.size()), 1);
  row.pixels = values;
  return row;
}

void check_against_reference(const Sweep& sweep, Settings settings) {
  const test::TestContext context;
  settings = test::exact_as_needed(settings);
  settings.skipping = false;  // which the reference does not do
  const Grid grid = sweep_grid(sweep, 4);
  gl::SweepSimulator simulator = simulator_of(sweep, settings, grid);
  const Volume<float> fused = simulator.read_fused();
  const Volume<std::int16_t> grey = simulator.read_grey();

  const AcousticVolume body = test::test_body();
  const MediumField field = trilinear_field(body);
  const auto reference = [&](const MediumField& of_body, const Grid& of_voxels) {
    return simulate_sweep_reference(of_body, tissues(), sweep, settings, of_voxels);
  };
  const ReferenceVolume expected = reference(field, grid);
  // Mesa's arctangent is within 1e-6 rad, which is 2e-4 mm at a fan's end, 170 mm from its apex; the voxels'
  // coordinates are closer than that. It is felt where an echo stands beside one of another magnitude.
  std::array<ReferenceVolume, 4> uncertain;
  for (std::uint32_t i = 0; i < uncertain.size(); ++i) {
    Grid moved = grid;
    for (int axis = 0; axis < 3; ++axis)
      moved.origin[axis] += 2e-4 * (2.0 * unit_float(hash(i, std::uint32_t(axis))) - 1.0);
    uncertain[i] = reference(test::as_single_precision_knows_it(field, i), moved);
  }

  // At the edge of the sweep rounding alone decides what is inside.
  long at_edge = 0;
  std::vector<double> expected_fused;
  std::array<std::vector<double>, 4> uncertain_fused;
  std::vector<float> got_fused;
  std::vector<int> expected_grey, got_grey;
  for (std::size_t i = 0; i < grid.count(); ++i) {
    REQUIRE(std::isnan(fused.voxels[i]) == (grey.voxels[i] < 0));
    REQUIRE(std::isnan(expected.fused.voxels[i]) == (expected.grey.voxels[i] < 0));
    const bool inside = grey.voxels[i] >= 0;
    if (inside != expected.grey.voxels[i] >= 0) ++at_edge;
    const auto outside_there = [&](const ReferenceVolume& volume) { return volume.grey.voxels[i] < 0; };
    if (!inside || outside_there(expected) || std::ranges::any_of(uncertain, outside_there)) continue;
    expected_fused.push_back(expected.fused.voxels[i]);
    for (std::size_t j = 0; j < uncertain.size(); ++j) uncertain_fused[j].push_back(uncertain[j].fused.voxels[i]);
    got_fused.push_back(fused.voxels[i]);
    expected_grey.push_back(expected.grey.voxels[i]);
    got_grey.push_back(grey.voxels[i]);
  }
  CHECK(at_edge <= 5);
  REQUIRE(got_fused.size() > grid.count() / 10);
  Image<float> got(int(got_fused.size()), 1);
  got.pixels = got_fused;
  test::check_fused(
      row_of(expected_fused),
      {row_of(uncertain_fused[0]), row_of(uncertain_fused[1]), row_of(uncertain_fused[2]), row_of(uncertain_fused[3])},
      got, settings.dynamic_range_db);
  test::check_grey(expected_grey, got_grey);
}

}  // namespace

TEST_CASE("GLSL agrees with the reference: a 3D probe, every effect on") {
  check_against_reference(swept("curvilinear"), everything());
}

TEST_CASE("GLSL agrees with the reference: a 3D probe in the paper's own mode, its brightest voxel white") {
  check_against_reference(swept("phased"), of_the_paper());
}

TEST_CASE("GLSL agrees with the reference: planes that a hand has swept") {
  Settings settings = everything();
  settings.slice_planes = 1;
  settings.grey_map = GreyMap::s_curve;
  check_against_reference(by_hand(), settings);
}

TEST_CASE("the lines of many planes hold what each plane's picture holds, to the last bit") {
  // Windows too wide for the array: one that went on into the next plane's lines would take its other end.
  for (const bool focused : {false, true}) {
    Settings settings = everything();
    settings.focused_beam = focused;
    settings.beam_lines = 21;
    settings.f_number = 2;
    settings.focus_mm = 20;
    if (!focused) settings.elevation_focus_mm = 0;  // bent planes' lines start whatever they meet
    Sweep sweep = by_hand();
    sweep.patient_from_plane.push_back(test::on_the_skin(60, 2, 0));     // half of its lines meet no body
    sweep.patient_from_plane.push_back(test::on_the_skin(0, -40, 180));  // and none of these does
    const int n = sweep.probe.lines, d = settings.samples, planes = int(sweep.patient_from_plane.size());

    const test::TestContext context;
    const gl::DeviceVolume body(test::test_body(), tissues());
    gl::LineStages stages({}, gl::Scheme::of_device());
    stages.lay_out(scan_lines(sweep.probe, sweep.depth_mm, d), planes, settings);
    gl::SimulationParameters parameters = gl::parameters_of(settings, stages.lines(), {}, {});
    parameters.planes = planes;
    const gl::Buffer block(sizeof parameters, &parameters);
    block.bind_uniform(0);
    stages.traverse(body, sweep.patient_from_plane, settings);
    stages.beam(settings);
    std::vector<std::array<float, 4>> scan(std::size_t(planes * n * d)), echoes(scan.size());
    stages.scan().read(scan.data(), scan.size() * sizeof scan[0]);
    stages.echoes().read(echoes.data(), echoes.size() * sizeof echoes[0]);

    gl::Simulator simulator;
    simulator.set_volume(test::test_body(), tissues());
    simulator.set_probe(sweep.probe, sweep.depth_mm);
    simulator.set_settings(settings);
    for (int plane = 0; plane < planes; ++plane) {
      CAPTURE(focused, plane);
      simulator.set_pose(sweep.patient_from_plane[std::size_t(plane)]);
      const Stages<float> picture = simulator.read_stages();
      long differ = 0;
      for (int line = 0; line < n; ++line)
        for (int k = 0; k < d; ++k) {
          const std::size_t at = std::size_t((plane * n + line) * d + k);
          differ += scan[at][0] != picture.intensity.at(line, k) || scan[at][1] != picture.reflection.at(line, k);
          differ += echoes[at] != std::array{picture.reflection_beam.at(line, k), picture.transmission.at(line, k),
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
  REQUIRE(grid.count() % 4 != 0);  // the voxels that an invocation packs together
  for (const Settings& settings : {everything(), of_the_paper()}) {
    const Volumes at_once = volumes_of(sweep, settings, grid, {});
    CHECK(std::ranges::count_if(at_once.grey, [](int grey) { return grey > 0; }) > 1000);
    gl::Scheme rows, groups, parts, pairs;
    rows.most_groups = 7;  // of lines 38, of voxels more
    groups.group = 64;
    // Four planes, and some slices of the volume; no divisor of either.
    parts.most_texels = std::size_t(4 * sweep.probe.lines * settings.samples);
    pairs.most_texels = 1;  // two planes, a slice
    for (const gl::Scheme& scheme : {rows, groups, parts, pairs}) {
      CAPTURE(scheme.most_groups, scheme.group, scheme.most_texels);
      const Volumes got = volumes_of(sweep, settings, grid, scheme);
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
    gl::Scheme scheme = gl::Scheme::of_device();
    if (in_parts) scheme.most_texels = 3 * 30 * 64;
    gl::SweepSimulator simulator = simulator_of(sweep, settings, grid, scheme);
    const auto after = [&](const std::function<void()>& change) {
      const auto before = simulator.runs();
      change();
      simulator.set_settings(settings);
      simulator.set_sweep(sweep);
      simulator.set_grid(grid);
      simulator.volume();
      std::string ran;
      for (int stage = 0; stage < gl::kSweepStageCount; ++stage)
        if (simulator.runs()[std::size_t(stage)] > before[std::size_t(stage)]) ran += char('0' + stage);
      return ran;
    };
    // Of parts the lines of the last alone are kept.
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
    CHECK(simulator.read_grey().voxels == simulator_of(sweep, settings, grid, scheme).read_grey().voxels);

    const gl::StageCount walked = simulator.count(gl::SweepStage::traverse);
    const std::uint64_t planes = in_parts ? 3 + 3 + 2 : 6;  // the planes where parts meet are walked twice
    CHECK(walked.possible == planes * 30 * 64);
    CHECK(walked.evaluated == walked.possible);
    CHECK(simulator.count(gl::SweepStage::compress).evaluated == grid.count());
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
