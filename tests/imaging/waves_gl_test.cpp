// Waves on the graphics card, beside their parity with the reference (parity_gl_test.cpp): what runs when, that equal
// poses give equal bits, and that a small move of the probe is a small move of the echo.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "sim/gl/headless_context.h"
#include "sim/imaging/scatterer_stage.h"
#include "sim/imaging/simulator.h"
#include "sim/model/beam.h"
#include "sim/model/waves.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/changed_simulator.h"
#include "tests/imaging/swept_lines.h"
#include "tests/imaging/test_body.h"
#include "tests/imaging/test_divisions.h"
#include "tests/imaging/test_sweeps.h"

using namespace insonate;
using gl::Stage;

namespace {

Settings small_waves(double depth_mm = 100) {
  Settings settings = trainer_settings(3.5, depth_mm);
  settings.samples = 128;
  settings.image_width = 96;
  settings.image_height = 72;
  return settings;
}

}  // namespace

TEST_CASE("waves run the stages that a change reaches, and never smooth") {
  test::ChangedSimulator changed(small_waves());
  gl::Simulator& simulator = changed.simulator;
  Settings& s = changed.settings;
  const auto after = [&](const std::function<void()>& change) { return changed.after(change); };
  CHECK(after([] {}) == "");
  CHECK(after([&] { simulator.set_pose(test::on_the_skin(1, 9, 0)); }) == "0124");
  CHECK(after([&] { s.reflection_sigma_mm = 2, s.transmission_sigma_mm = 2; }) == "");
  CHECK(after([&] { s.f_number = 5; }) == "0124");  // the scatterers' scale depends on the beam
  CHECK(after([&] { s.blend *= 2; }) == "0124");
  CHECK(after([&] { s.specular_exponent = 3; }) == "0124");
  CHECK(after([&] { s.mirror_image = 0.5; }) == "0124");
  CHECK(after([&] { s.two_way = false; }) == "0124");
  CHECK(after([&] { s.speckle_seed = 9; }) == "0124");
  CHECK(after([&] { s.face_reflection = 0.1; }) == "0124");  // for the face repeats what gas mirrors
  CHECK(after([&] { s.mirror_image = 0; }) == "0124");
  CHECK(after([&] { s.face_reflection = 0.2; }) == "124");
  CHECK(after([&] { s.electronic_noise = false; }) == "24");
  CHECK(after([&] { s.gain_db = 6; }) == "4");
}

TEST_CASE("a picture of waves after a change is the picture that a new simulator draws") {
  const std::function<void(Settings&)> changes[] = {
      [](Settings& s) { s.waves = false; },
      [](Settings& s) { s.waves = true; },
      [](Settings& s) { s.speckle = false; },
      [](Settings& s) { s.speckle_seed = 7, s.speckle_cell_mm = 1.3; },
      [](Settings& s) { s.speckle = true; },
      [](Settings& s) { s.f_number = 5, s.focus_mm = 30; },
      [](Settings& s) { s.focused_beam = false; },
      [](Settings& s) { s.beam_lines = 15, s.beam_window = BeamWindow::box; },
      [](Settings& s) { s.frequency_mhz = 5; },
      [](Settings& s) { s.absorption = false; },
      [](Settings& s) { s.frequency_mhz = 3; },  // the carrier, even where nothing absorbs
      [](Settings& s) { s.slice_thickness_mm = 5, s.elevation_focus_mm = 60; },
      [](Settings& s) { s.slice_planes = 5; },
      [](Settings& s) { s.slice_planes = 1; },
      [](Settings& s) { s.reflection_length_mm = 1.7; },
      [](Settings& s) { s.samples = 90; },
      [](Settings& s) { s.reverberation = false, s.face_reflection = 0; },
      [](Settings& s) { s.mirror_image = 1; },  // keeps the middle plane, which nothing else needs now
      [](Settings& s) { s.mirror_image = 0; },
      [](Settings& s) { s.reverberation = true, s.mirror_image = 0.3; },
      [](Settings& s) { s.face_reflection = 0.4; },
      [](Settings& s) { s.clutter = s.electronic_noise = false; },
      [](Settings& s) { s.electronic_noise = true, s.noise_db = -70; },
      [](Settings& s) { s.clutter = true, s.clutter_db = -10; },
      [](Settings& s) { s.blend *= 10, s.two_way = false, s.specular_exponent = 1; },
      [](Settings& s) { s.image_width = 80; },
      [](Settings& s) { s.reference_level = ReferenceLevel::frame_maximum; },
  };
  test::ChangedSimulator(small_waves()).compare_with_new(changes);
}

TEST_CASE("the picture of waves comes back to the bit when the probe does, and its noise is that of the pose") {
  const test::TestContext context;
  gl::Simulator simulator;
  Settings settings = small_waves();
  settings.noise_db = -40;
  test::set_up(simulator, settings);
  const auto at = [&](double x_mm, double z_mm) {
    simulator.set_pose(test::on_the_skin(x_mm, 9, z_mm));
    return simulator.read_stages();
  };
  const Stages<float> first = at(0, 0);
  const Stages<float> beside = at(0.001, 0);
  at(20, 10);
  const Stages<float> again = at(0, 0);
  CHECK((first.fused.pixels == again.fused.pixels));
  CHECK((first.wave_re.pixels == again.wave_re.pixels));

  // Where no sound arrives, a picture is noise alone: another pose's noise is as loud and not the same.
  double here = 0, there = 0, product = 0, squares = 0, other_squares = 0, n = 0;
  for (std::size_t i = 0; i < first.fused.pixels.size(); ++i) {
    if (!first.inside.pixels[i] || i < first.fused.pixels.size() * 8 / 10) continue;
    const double a = first.fused.pixels[i], b = beside.fused.pixels[i];
    here += a, there += b, product += a * b, squares += a * a, other_squares += b * b, ++n;
  }
  REQUIRE(n > 300);
  CHECK(there / here == Approx(1).margin(0.3));
  const double correlation =
      (product / n - here * there / n / n) /
      std::sqrt((squares / n - here * here / n / n) * (other_squares / n - there * there / n / n));
  CHECK(std::abs(correlation) < 0.3);
}

TEST_CASE("a move of the probe by a hundredth of a millimetre changes the echo's amplitude by a few hundredths") {
  const test::TestContext context;
  gl::Simulator simulator;
  Settings settings = small_waves();
  settings.electronic_noise = settings.clutter = false;
  settings.samples = 320;
  test::set_up(simulator, settings);
  double worst = 0;
  for (int place = 0; place < 12; ++place) {
    const auto at = [&](double more_mm) {
      simulator.set_pose(test::on_the_skin(-30 + 5.1 * place + more_mm, 9, 7 - place));
      return simulator.read_stages();
    };
    const Stages<float> before = at(0), after = at(0.01);
    for (int k = 8; k < before.wave_re.height - 8; ++k)
      for (int line = 8; line < before.wave_re.width - 8; ++line) {
        if (before.intensity.at(line, k) < 1e-3) continue;  // behind gas, where the intensity itself jumps
        double loudest = 0;
        for (int j = -8; j <= 8; ++j)
          for (int i = -8; i <= 8; ++i)
            loudest = std::max(
                loudest, double(std::hypot(before.wave_re.at(line + i, k + j), before.wave_im.at(line + i, k + j))));
        const double change = std::abs(std::hypot(before.wave_re.at(line, k), before.wave_im.at(line, k)) -
                                       std::hypot(after.wave_re.at(line, k), after.wave_im.at(line, k)));
        worst = std::max(worst, change / loudest);
      }
  }
  std::printf("a step of 0.01 mm: the amplitude of waves changes by at most %.3f of the loudest around\n", worst);
  CHECK(worst < 0.1);
}

TEST_CASE("the lines of many planes hold what each plane's picture holds, with waves") {
  for (const gl::WorkDivision& division : {test::line_an_invocation(), test::line_per_group()}) {
    Settings settings = test::everything();
    settings.waves = true;
    settings.specular_exponent = 6;
    const test::TestContext context;
    // A card's compiler may fuse other multiplications and additions where a program is compiled for many planes.
    const float rounding = gl::is_software_renderer() ? 0 : 1e-5f;
    const std::vector<test::SweptPlane> planes = test::swept_lines(settings, division);
    for (std::size_t plane = 0; plane < planes.size(); ++plane) {
      CAPTURE(plane);
      const auto& [picture, scan, echoes] = planes[plane];
      std::array<float, 8> loudest{}, difference{};
      long heard = 0;
      for (int line = 0; line < scan.width; ++line)
        for (int k = 0; k < scan.height; ++k) {
          heard += echoes.at(line, k)[0] != 0;
          const float intensity = picture.intensity.at(line, k);
          const std::array<float, 8> of_picture{intensity,
                                                picture.scattered.at(line, k),
                                                picture.echo_re.at(line, k),
                                                picture.echo_im.at(line, k),
                                                picture.wave_re.at(line, k),
                                                picture.wave_im.at(line, k),
                                                intensity * intensity,
                                                picture.repeated.at(line, k)};
          for (std::size_t i = 0; i < 8; ++i) {
            const float of_planes = i < 4 ? scan.at(line, k)[i] : echoes.at(line, k)[i - 4];
            loudest[i] = std::max(loudest[i], std::abs(of_picture[i]));
            difference[i] = std::max(difference[i], std::abs(of_planes - of_picture[i]));
          }
        }
      for (std::size_t i = 0; i < 8; ++i) {
        CAPTURE(i, loudest[i], difference[i]);
        CHECK(difference[i] <= rounding * loudest[i]);
      }
      CHECK((heard > scan.width * scan.height / 4 || plane >= 9));
    }
  }
}

TEST_CASE("every scatterer that reaches a sample lies in one column of the list, and no column is there twice") {
  for (const char* name : {"curvilinear", "linear", "phased"}) {
    const Probe& probe = *find_probe(name);
    Settings settings = trainer_settings(probe.frequency_mhz, probe.depth_mm);
    settings.speckle_cell_mm *= 2;
    settings.elevation_focus_mm = 30;
    const ScanLines lines = scan_lines(probe, probe.depth_mm, settings.samples);
    for (const double turn : {0.0, 17.0, 90.0, 200.0}) {
      CAPTURE(name, turn);
      const Pose pose = test::on_the_skin(3 * turn, -turn, turn);
      const gl::ScattererColumns columns = gl::scatterer_columns(pose, lines, settings);
      std::vector<std::pair<int, int>> listed;
      for (const glm::ivec2& group : columns.groups)
        for (int i = 0; i < gl::ScattererColumns::kGroup; ++i) listed.emplace_back(group.x + i, group.y);
      std::ranges::sort(listed);
      CHECK(std::ranges::adjacent_find(listed) == listed.end());

      const glm::dmat4 cells = cells_from_patient(scatterer_pitch_mm(lines, settings)) * pose.matrix();
      const gl::ScatterParameters& p = columns.parameters;
      int missed = 0, checked = 0;
      for (double line = -0.99; line < double(lines.lines.size()); line += 1.7)
        for (double sample = -0.99; sample < lines.samples; sample += 5.3)
          for (const double share : {-0.999, -0.4, 0.0, 0.7, 0.999}) {
            const double r = lines.r_min_mm + (sample + 0.5) * lines.dr_mm();
            const double across = lines.fan.first + line * lines.fan.step;
            const double outer = std::cos(lines.fan.first);  // beyond the outer lines as from them
            const double apex = lines.fan.face == LineFan::Face::flat
                                    ? lines.fan.apex_mm / std::max(std::cos(across), outer)
                                    : lines.fan.apex_mm;
            const glm::dvec2 at =
                lines.fan.face == LineFan::Face::parallel
                    ? glm::dvec2(across, r)
                    : glm::dvec2((r + apex) * std::sin(across), (r + apex) * std::cos(across) - lines.fan.apex_mm);
            const double z = share * kSliceHalf * slice_thickness_at_mm(settings, r);
            const glm::ivec3 cell = glm::ivec3(glm::floor(glm::dvec3(cells * glm::dvec4(at, z, 1)))) - columns.corner;
            const auto along = [&](const glm::ivec4& unit) {
              return unit.x * cell.x + unit.y * cell.y + unit.z * cell.z;
            };
            ++checked;
            missed += !std::ranges::binary_search(listed, std::pair(along(p.across), along(p.up)));
          }
      REQUIRE(checked > 10000);
      CHECK(missed == 0);
    }
  }
}

TEST_CASE("a bone that is steep in elevation is one broad echo, not one for each plane of the slice") {
  // Bone behind the plane y = 40 mm + z. The slice is 3 mm thick, so that its planes meet it 1.7 mm apart.
  AcousticVolume body;
  body.grid.size = {40, 160, 40};
  body.grid.spacing = {2, 0.5, 0.5};
  body.grid.origin = {-39, 0, -9.75};
  for (int z = 0; z < body.grid.size.z; ++z)
    for (int y = 0; y < body.grid.size.y; ++y)
      for (int x = 0; x < body.grid.size.x; ++x)
        body.voxels.push_back({std::int16_t(body.grid.origin.z + 0.5 * z < 0.5 * y - 40 ? 900 : 60), -6000});
  const test::TestContext context;
  gl::Simulator simulator;
  simulator.set_volume(body, read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(*find_probe("linear"), 60);
  simulator.set_pose({glm::dmat3(1.0), {0, 2, 0}});
  Settings settings = trainer_settings(3.5, 60);
  settings.slice_thickness_mm = 3;
  settings.reverberation = settings.electronic_noise = settings.clutter = false;
  simulator.set_settings(settings);
  const Stages<float> stages = simulator.read_stages();
  const ScanLines lines = scan_lines(*find_probe("linear"), 60, settings.samples);
  double least = 1, sum = 0;
  int samples = 0;
  for (int k = 0; k < lines.samples; ++k) {
    const double y_mm = 2 + lines.r_min_mm + (k + 0.5) * lines.dr_mm();
    if (std::abs(y_mm - 40) > 1.5) continue;  // half the slice: where its window has half its maximum
    double power = 0;
    for (int line = 16; line < stages.wave_re.width - 16; ++line)
      power += std::pow(stages.wave_re.at(line, k), 2) + std::pow(stages.wave_im.at(line, k), 2);
    least = std::min(least, power);
    sum += power;
    ++samples;
  }
  std::printf("a steep bone: the weakest depth has %.2g of the mean power of %d depths\n", least * samples / sum,
              samples);
  CHECK(samples >= 8);
  CHECK(least > 0.05 * sum / samples);  // between the rungs of a ladder there is less than a thousandth
}

TEST_CASE(
    "without speckle, a surface behind which the impedance falls adds to the tissue's echo, and cancels nothing") {
  AcousticVolume body;  // muscle before the plane y = 40 mm, fat behind it, and equal scatterers in both
  body.grid.size = {40, 160, 40};
  body.grid.spacing = {2, 0.5, 0.5};
  body.grid.origin = {-39, 0, -9.75};
  for (int z = 0; z < body.grid.size.z; ++z)
    for (int y = 0; y < body.grid.size.y; ++y)
      for (int x = 0; x < body.grid.size.x; ++x) body.voxels.push_back({std::int16_t(y < 80 ? 60 : -100), -2000});
  const test::TestContext context;
  gl::Simulator simulator;
  simulator.set_volume(body, read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(*find_probe("linear"), 60);
  simulator.set_pose({glm::dmat3(1.0), {0, 2, 0}});
  Settings settings = trainer_settings(7.5, 60);
  settings.speckle = settings.reverberation = settings.electronic_noise = settings.clutter = settings.absorption =
      false;
  simulator.set_settings(settings);
  const Stages<float> stages = simulator.read_stages();
  const ScanLines lines = scan_lines(*find_probe("linear"), 60, settings.samples);
  const auto power_at = [&](double y_mm) {
    const int k = int((y_mm - 2 - lines.r_min_mm) / lines.dr_mm()), line = stages.wave_re.width / 2;
    return std::pow(stages.wave_re.at(line, k), 2) + std::pow(stages.wave_im.at(line, k), 2);
  };
  double least = 1e300, most = 0;
  for (double y_mm = 35; y_mm < 45; y_mm += lines.dr_mm()) {
    least = std::min(least, power_at(y_mm));
    most = std::max(most, power_at(y_mm));
  }
  const double tissue = std::min(power_at(30), power_at(50));
  CHECK(tissue > 0);
  CHECK(most > 3 * tissue);     // the surface is seen
  CHECK(least > 0.8 * tissue);  // echoes of opposite signs would cancel beside it
}
