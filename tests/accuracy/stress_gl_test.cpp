// Takes everything to the ends of its range, through the shaders and through the reference.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/accuracy/extreme_cases.h"
#include "tests/accuracy/stressed.h"
#include "tests/imaging/test_divisions.h"

using namespace insonate;
using namespace insonate::test;

namespace {

/// Runs `cases` one by one on an ordinary scene, with both work divisions, as amplitudes and as waves. Of amplitudes,
/// U must be known well enough to compare grey in a sufficient share of the pixels with an echo. The share is lowest
/// with few pixels (8192 samples, 0.40), and 0.70 or more overall. Of waves, e and f are compared everywhere, but grey
/// may be compared nowhere: gas is 40 dB louder than tissue, and what is rounded of it hides the grains beside it.
void check_each(const std::vector<ExtremeCase>& cases) {
  const gl::WorkDivision division = GENERATE(line_an_invocation(), line_per_group(32));
  const bool waves = GENERATE(false, true);
  CAPTURE(division.lines_that_fill, waves);
  Stressed stressed(division);
  for (const ExtremeCase& extreme : cases) {
    INFO(extreme.name);
    Scene scene = ordinary_scene();
    scene.settings.waves = waves;
    extreme.apply(scene);
    const Compared before = stressed.compared();
    stressed.check(scene);
    const Compared all = stressed.compared();
    const Compared of_extreme{all.with_echo - before.with_echo, all.in_grey - before.in_grey};
    CHECK((waves || of_extreme.with_echo == 0 || of_extreme.share() > 0.35));
  }
  CHECK((waves || stressed.compared().share() > 0.65));
}

}  // namespace

TEST_CASE("settings at the ends of their ranges") {
  using S = Settings;
  const auto maximum = [](double gain_db, double time_gain_db, double blend) {
    return [=](Scene& scene) {
      scene.settings.reference_level = ReferenceLevel::frame_maximum;
      scene.settings.gain_db = gain_db;
      scene.settings.tgc_db.fill(time_gain_db);
      scene.settings.blend = blend;
    };
  };
  const auto unfocused = [](int beam_lines) {
    return [=](Scene& scene) {
      scene.settings.focused_beam = false;
      scene.settings.beam_lines = beam_lines;
    };
  };
  const auto slice = [](int planes, double thickness_mm) {
    return [=](Scene& scene) {
      scene.settings.slice_planes = planes;
      scene.settings.slice_thickness_mm = thickness_mm;
    };
  };
  const std::vector<ExtremeCase> of_model_s = {
      {"no smoothing", set(&S::reflection_sigma_mm, 0.0)},
      {"a frame of zeros, whose brightest is white",
       [](Scene& scene) {
         scene.volume = make_volume({8, 8, 8}, {40, 40, 40}, [](const glm::ivec3&) { return 0; });  // exceeds the fan
         scene.settings.reference_level = ReferenceLevel::frame_maximum;
         scene.settings.speckle = scene.settings.electronic_noise = scene.settings.clutter = false;
         scene.settings.blend = 0;
       }},
      {"0.5 MHz", set(&S::frequency_mhz, 0.5)},
      {"30 MHz", set(&S::frequency_mhz, 30.0)},
      {"dynamic range 1 dB", set(&S::dynamic_range_db, 1.0)},
      {"dynamic range 200 dB", set(&S::dynamic_range_db, 200.0)},
      {"blend 0", set(&S::blend, 0.0)},
      {"blend 1000", set(&S::blend, 1000.0)},
      {"gain -60 dB", set(&S::gain_db, -60.0)},
      {"gain 60 dB", set(&S::gain_db, 60.0)},
      {"time gain 300 dB", [](Scene& scene) { scene.settings.tgc_db.fill(300); }},
      {"time gain -300 dB", [](Scene& scene) { scene.settings.tgc_db.fill(-300); }},
      {"brightest is white, all gains at their most", maximum(60, 300, 1000)},
      {"brightest is white, all gains at their least", maximum(-60, -300, 0)},
      {"white at 1e-12", set(&S::fixed_level, 1e-12)},
      {"white at 1e6", set(&S::fixed_level, 1e6)},
      {"beam of 255 lines, which are 20 times as many as there are", unfocused(255)},
      {"beam of 1 line", unfocused(1)},
      {"focus at 5 mm", set(&S::focus_mm, 5.0)},
      {"focus at 400 mm", set(&S::focus_mm, 400.0)},
      {"aperture twice as wide as the focus is deep", set(&S::f_number, 0.5)},
      {"aperture a thirtieth of the focus", set(&S::f_number, 30.0)},
      {"slice of 31 planes over 20 mm", slice(31, 20)},
      {"slice of 3 planes over 0.1 mm", slice(3, 0.1)},
      {"reverberation", set(&S::reverberation, true)},
      {"clutter as loud as the tissue", set(&S::clutter_db, 0.0)},
      {"clutter at -100 dB", set(&S::clutter_db, -100.0)},
      {"noise as loud as white", set(&S::noise_db, 0.0)},
      {"noise at -200 dB", set(&S::noise_db, -200.0)},
      {"soft", set(&S::grey_map, GreyMap::soft)},
      {"contrast", set(&S::grey_map, GreyMap::contrast)},
      {"S-curve", set(&S::grey_map, GreyMap::s_curve)},
      {"edges at their most", set(&S::edge_enhancement, 4.0)},
      {"speckle at its least", set(&S::speckle_reduction, 1.0)},
      {"filtered over twelve wavelengths of 3 mm",
       [](Scene& scene) {
         scene.settings.edge_enhancement = 4;
         scene.settings.speckle_reduction = 1;
         scene.settings.frequency_mhz = 0.5;
         scene.settings.reference_level = ReferenceLevel::frame_maximum;
       }},
      {"scatterers 0.05 mm apart", set(&S::speckle_cell_mm, 0.05)},
      {"scatterers 10 mm apart", set(&S::speckle_cell_mm, 10.0)},
      {"an echo of what is met squarely alone", set(&S::specular_exponent, 64.0)},
      {"an echo whatever the angle", set(&S::specular_exponent, 1.0)},
      {"gas that mirrors all", set(&S::mirror_image, 1.0)},
      {"a transducer that rings ten times as loud as white", set(&S::ring_down, 10.0)},
      {"reflections smoothed by 1000 mm", set(&S::reflection_sigma_mm, 1000.0)},
      {"transmission smoothed by 1000 mm", set(&S::transmission_sigma_mm, 1000.0)},
      {"shadows at every edge", set(&S::edge_shadow, true)},
      {"a face that reflects everything", set(&S::face_reflection, 1.0)},
      {"every pair of interfaces rings",
       [](Scene& scene) {
         scene.settings.reverberation = true;
         scene.settings.face_reflection = 1;
       }},
      {"a slice thin at the far end of what is seen, wide before",
       [](Scene& scene) {
         scene.settings.slice_planes = 31;
         scene.settings.slice_thickness_mm = 0.1;
         scene.settings.elevation_focus_mm = 400;
       }},
  };
  check_each(joined(extreme_views(), of_model_s));
}

TEST_CASE("volumes at the ends of what a grid and a voxel can hold") {
  check_each(extreme_volumes());
}

TEST_CASE("thousands of interfaces in a row") {
  check_each(layers_in_a_row());
}

TEST_CASE("no stage holds a denormal number, with which a processor is slow, where sound fades through all that are") {
  // Gas and bone leave about 10^-18 of it, and absorption reduces the rest: R and T pass through 10^-38.
  Scene scene = ordinary_scene();
  scene.volume = make_volume({2, 2000, 2}, {40, 0.1, 40}, [](const glm::ivec3& i) {
    const int layer = i.y / 10;
    return layer % 2 == 0 || layer > 11 ? 60 + i.y % 2 : layer < 6 ? -1000 : 1500;
  });
  for (AcousticVoxel& voxel : scene.volume.voxels) voxel.echogenicity_cdb = 0;
  scene.probe.kind = ProbeKind::linear;
  scene.probe.lines = 40;
  scene.depth_mm = 190;
  scene.pose.translation = {0, -100, 0};
  scene.settings.samples = 1000;
  scene.settings.gel_mm = 0;
  scene.settings.speckle = scene.settings.clutter = scene.settings.electronic_noise = false;
  Stressed stressed;
  for (const bool skipping : {true, false}) {
    CAPTURE(skipping);
    scene.settings.skipping = skipping;
    const Stages<float> stages = stressed.check_shaders(scene);
    CHECK(std::ranges::any_of(stages.intensity.pixels, [](float i) { return i > 0 && i < 1e-18f; }));
    for (const auto stage : {&Stages<float>::intensity, &Stages<float>::reflection, &Stages<float>::reflection_beam,
                             &Stages<float>::transmission, &Stages<float>::repeated, &Stages<float>::fused})
      CHECK(std::ranges::none_of((stages.*stage).pixels, [](float v) { return std::fpclassify(v) == FP_SUBNORMAL; }));
  }
}

TEST_CASE("extreme poses give finite and bounded stages") {
  check_each(extreme_poses());
}
