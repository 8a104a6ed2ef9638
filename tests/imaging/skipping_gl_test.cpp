// Tests that the simulator runs the stages that a change affects, and no others.

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>

#include "tests/imaging/changed_simulator.h"
#include "tests/model/amplitudes.h"

using namespace insonate;
using gl::Stage;

namespace {

struct Fixture : test::ChangedSimulator {
  Fixture() : ChangedSimulator(small_picture()) {}

  static Settings small_picture() {
    Settings settings = test::trainer_with_amplitudes(3.5, 100);
    settings.samples = 64;
    settings.slice_planes = 1;
    settings.transmission_sigma_mm = 0;
    settings.image_width = 64;
    settings.image_height = 48;
    return settings;
  }
};

}  // namespace

TEST_CASE("an unchanged frame runs nothing") {
  Fixture f;
  CHECK(f.after([] {}) == "");
  CHECK(f.after([&] { f.simulator.set_pose(test::on_the_skin(0, 9, 0)); }) == "");
  CHECK(f.after([&] { f.simulator.set_probe(*find_probe("curvilinear"), 100); }) == "");
}

TEST_CASE("a change runs the first stage it reaches and those behind it") {
  Fixture f;
  CHECK(f.after([&] { f.simulator.set_pose(test::on_the_skin(1, 9, 0)); }) == "01234");
  CHECK(f.after([&] { f.settings.f_number = 5; }) == "1234");
  CHECK(f.after([&] { f.settings.reflection_sigma_mm = 2; }) == "234");
  CHECK(f.after([&] { f.settings.blend *= 2; }) == "01234");  // weaker interfaces count
  CHECK(f.after([&] { f.settings.gain_db = 6; }) == "4");
  CHECK(f.after([&] { f.settings.tgc_db[3] += 6; }) == "4");
  CHECK(f.after([&] { f.settings.dynamic_range_db = 50; }) == "4");
}

TEST_CASE("what other settings leave unused reaches nothing, until they use it") {
  Fixture f;
  CHECK(f.after([&] { f.settings.beam_lines = 9; }) == "");  // the beam is focused
  CHECK(f.after([&] { f.settings.beam_window = BeamWindow::box; }) == "");
  CHECK(f.after([&] { f.settings.slice_thickness_mm = 5; }) == "");
  CHECK(f.after([&] { f.settings.elevation_focus_mm = 50; }) == "");
  CHECK(f.after([&] { f.settings.focused_beam = false; }) == "1234");
  CHECK(f.after([&] { f.settings.focus_mm = 70, f.settings.f_number = 4; }) == "");
  CHECK(f.after([&] { f.settings.beam_lines = 11; }) == "1234");
  CHECK(f.after([&] { f.settings.frequency_mhz = 4; }) == "01234");  // absorption
  CHECK(f.after([&] { f.settings.absorption = false; }) == "01234");
  CHECK(f.after([&] { f.settings.frequency_mhz = 5; }) == "");
  CHECK(f.after([&] { f.settings.electronic_noise = false; }) == "234");
  CHECK(f.after([&] { f.settings.noise_db = -90; }) == "");
  CHECK(f.after([&] { f.settings.clutter_db = -20; }) == "234");
  CHECK(f.after([&] { f.settings.clutter_db = -40; }) == "01234");  // weaker interfaces become visible
  CHECK(f.after([&] { f.settings.clutter = false; }) == "01234");
  CHECK(f.after([&] { f.settings.clutter_db = -20; }) == "");
  CHECK(f.after([&] { f.settings.speckle = false; }) == "01234");
  CHECK(f.after([&] { f.settings.speckle_seed = 7, f.settings.speckle_cell_mm = 1; }) == "");
  CHECK(f.after([&] { f.settings.slice_planes = 3; }) == "01234");
  CHECK(f.after([&] { f.settings.slice_thickness_mm = 4; }) == "01234");
}

TEST_CASE("ring-down needs waves, and makes the frequency and the fixed level count") {
  Fixture f;
  CHECK(f.after([&] { f.settings.ring_down = 1; }) == "");
  // Nothing else that depends on the two, and the frame's brightest pixel is white.
  f.after([&] {
    f.settings.waves = true;
    f.settings.absorption = f.settings.focused_beam = f.settings.electronic_noise = false;
    f.settings.ring_down = 0;
    f.settings.reference_level = ReferenceLevel::frame_maximum;
  });
  CHECK(f.after([&] { f.settings.fixed_level *= 2; }) == "");
  CHECK(f.after([&] { f.settings.frequency_mhz = 4; }) == "");
  CHECK(f.after([&] { f.settings.ring_down = 1; }) == "01245");  // and the frequency, which nothing used
  CHECK(f.after([&] { f.settings.ring_down = 2; }) == "245");
  CHECK(f.after([&] { f.settings.fixed_level *= 2; }) == "245");
  CHECK(f.after([&] { f.settings.frequency_mhz = 5; }) == "01245");
}

TEST_CASE("each stage reports how often it ran and how much it evaluated of what there is") {
  Fixture f;
  f.settings.image_width = 400;
  f.settings.image_height = 300;
  f.settings.slice_planes = 3;
  f.after([&] { f.simulator.set_pose(test::on_the_skin(0, -40, 180)); });  // away from the body, so that lines end soon
  const std::uint64_t samples = std::uint64_t(find_probe("curvilinear")->lines) * 64, pixels = 400 * 300;
  const gl::StageCount traversal = f.simulator.count(Stage::traverse), beam = f.simulator.count(Stage::beam);
  CHECK(traversal.runs == 2);
  CHECK(traversal.possible == 3 * samples);
  CHECK(traversal.evaluated > 0);
  CHECK(traversal.evaluated < traversal.possible / 2);
  CHECK(beam.evaluated == samples);
  CHECK(beam.possible == samples);
  const Image<std::uint8_t> inside = f.simulator.read_stages().inside;
  const auto in_fan = std::uint64_t(std::count(inside.pixels.begin(), inside.pixels.end(), std::uint8_t(1)));
  for (const Stage stage : {Stage::scan_convert, Stage::smooth, Stage::fuse}) {
    const gl::StageCount count = f.simulator.count(stage);
    CHECK(count.runs >= 2);
    CHECK(count.possible == pixels);
    CHECK(count.evaluated >= in_fan);
    CHECK(count.evaluated < pixels);  // the picture's corners are left out
  }
  CHECK(f.simulator.count(Stage::compress).runs == 0);  // white is a fixed level
  CHECK(f.simulator.count(Stage::compress).evaluated == 0);
}

TEST_CASE("smoothing that is off does not run") {
  Fixture f;
  CHECK(f.after([&] { f.settings.reflection_sigma_mm = 0; }) == "24");
  CHECK(f.after([&] { f.simulator.set_pose(test::on_the_skin(2, 9, 0)); }) == "0124");
}

TEST_CASE("where each frame sets what is white, compressing is a stage of its own") {
  Fixture f;
  CHECK(f.after([&] { f.settings.reference_level = ReferenceLevel::frame_maximum; }) == "45");
  CHECK(f.after([&] { f.settings.gain_db = 6; }) == "45");
  CHECK(f.after([&] { f.settings.dynamic_range_db = 50; }) == "5");
  CHECK(f.after([&] { f.settings.grey_map = GreyMap::soft; }) == "5");
}

TEST_CASE("the picture's version changes with the picture alone") {
  Fixture f;
  const long before = f.simulator.image_version();
  f.simulator.image();
  CHECK(f.simulator.image_version() == before);
  f.settings.gain_db = 6;
  f.simulator.set_settings(f.settings);
  f.simulator.image();
  CHECK(f.simulator.image_version() > before);
}

TEST_CASE("a picture after a change is the picture that a new simulator draws") {
  const std::function<void(Settings&)> changes[] = {
      [](Settings& s) { s.speckle = false; },
      [](Settings& s) { s.speckle_seed = 7, s.speckle_cell_mm = 0.8; },  // first unused, then used
      [](Settings& s) { s.speckle = true; },
      [](Settings& s) { s.speckle = false; },
      [](Settings& s) { s.speckle_seed = 1, s.speckle = true; },  // as before it was off and another seed was set
      [](Settings& s) { s.beam_lines = 15, s.beam_window = BeamWindow::box; },
      [](Settings& s) { s.slice_thickness_mm = 5, s.elevation_focus_mm = 60; },
      [](Settings& s) { s.absorption = !s.absorption; },
      [](Settings& s) { s.focused_beam = !s.focused_beam; },
      [](Settings& s) { s.clutter = !s.clutter; },
      [](Settings& s) { s.electronic_noise = !s.electronic_noise; },
      [](Settings& s) { s.transmission_sigma_mm = 1; },
      [](Settings& s) { s.reflection_sigma_mm = 0; },
      [](Settings& s) { s.grey_map = GreyMap::s_curve; },
      [](Settings& s) { s.reference_level = ReferenceLevel::frame_maximum; },
      [](Settings& s) { s.fixed_level *= 2; },
      [](Settings& s) { s.slice_planes = 3; },
      [](Settings& s) { s.reverberation = false, s.face_reflection = 0; },
      [](Settings& s) { s.reverberation = true; },
      [](Settings& s) { s.focused_beam = !s.focused_beam; },  // affects only the beam stage, with reverberation
      [](Settings& s) { s.clutter = s.electronic_noise = false; },
      // one change that affects only the beam stage, and one that makes invisible interfaces visible
      [](Settings& s) { s.two_way = !s.two_way, s.blend *= 1e-4; },
      // and back: weak interfaces are not seen any more
      [](Settings& s) { s.blend *= 1e4, s.clutter = true, s.clutter_db = 0; },
  };
  Fixture().compare_with_new(changes);
}
