// Everything at the ends of its range, through the shaders and through the reference.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "tests/accuracy/stressed.h"
#include "tests/gl/test_schemes.h"

using namespace insonate;
using namespace insonate::test;

namespace {

struct Strain {
  const char* name;
  std::function<void(Scene&)> apply;
};

/// `strains` one by one on an ordinary scene, walked along either way. Of what echoes, enough is to be known well
/// enough for its grey to be compared: least with few pixels (8192 samples, 0.40), 0.70 and more of all.
void check_each(const std::vector<Strain>& strains) {
  const gl::Scheme scheme = GENERATE(line_an_invocation(), line_a_group(32));
  CAPTURE(scheme.lines_that_fill);
  Stressed stressed(scheme);
  for (const Strain& strain : strains) {
    INFO(strain.name);
    Scene scene = ordinary_scene();
    strain.apply(scene);
    const Compared before = stressed.compared();
    stressed.check(scene);
    const Compared all = stressed.compared();
    const Compared of_strain{all.with_echo - before.with_echo, all.in_grey - before.in_grey};
    CHECK((of_strain.with_echo == 0 || of_strain.share() > 0.35));
  }
  CHECK(stressed.compared().share() > 0.65);
}

template <typename T>
std::function<void(Scene&)> set(T Settings::*member, T value) {
  return [=](Scene& scene) { scene.settings.*member = value; };
}

std::function<void(Scene&)> filled(const glm::ivec3& size, const glm::dvec3& spacing, int one, int other) {
  return [=](Scene& scene) {
    scene.volume = make_volume(size, spacing, [&](const glm::ivec3& i) { return checkerboard(i, one, other); });
  };
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
  const auto deep = [](double depth_mm) { return [=](Scene& scene) { scene.depth_mm = depth_mm; }; };
  const auto probe = [](ProbeKind kind) { return [=](Scene& scene) { scene.probe.kind = kind; }; };
  check_each({
      {"nothing strained", [](Scene&) {}},
      {"linear probe", probe(ProbeKind::linear)},
      {"phased probe", probe(ProbeKind::phased)},
      {"0.1 mm deep", deep(0.1)},
      {"1000 mm deep", deep(1000)},
      {"no smoothing", set(&S::reflection_sigma_mm, 0.0)},
      {"a frame of zeros, whose brightest is white",
       [](Scene& scene) {
         scene.volume = make_volume({8, 8, 8}, {40, 40, 40}, [](const glm::ivec3&) { return 0; });  // beyond the fan
         scene.settings.reference_level = ReferenceLevel::frame_maximum;
         scene.settings.speckle = scene.settings.electronic_noise = scene.settings.clutter = false;
         scene.settings.blend = 0;
       }},
      {"1 sample", set(&S::samples, 1)},
      {"8192 samples",
       [](Scene& scene) {
         scene.settings.samples = 8192;
         scene.probe.lines = 3;
         scene.settings.image_width = scene.settings.image_height = 12;
       }},
      {"reflection length 0.01 mm", set(&S::reflection_length_mm, 0.01)},
      {"reflection length 20 mm", set(&S::reflection_length_mm, 20.0)},
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
      {"no gel", set(&S::gel_mm, 0.0)},
      {"gel 100 mm", set(&S::gel_mm, 100.0)},
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
      {"scatterers 0.05 mm apart", set(&S::speckle_cell_mm, 0.05)},
      {"scatterers 10 mm apart", set(&S::speckle_cell_mm, 10.0)},
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
      {"1 pixel", [](Scene& scene) { scene.settings.image_width = scene.settings.image_height = 1; }},
      {"8192 x 16 pixels",
       [](Scene& scene) {
         scene.settings.image_width = 8192;
         scene.settings.image_height = 16;
       }},
      {"1 line", [](Scene& scene) { scene.probe.lines = 1; }},
      {"4096 lines",
       [](Scene& scene) {
         scene.probe.lines = 4096;
         scene.settings.samples = 8;
       }},
  });
}

TEST_CASE("volumes at the ends of what a grid and a voxel can hold") {
  check_each({
      {"one voxel", filled({1, 1, 1}, {5, 5, 5}, 60, 60)},
      {"one voxel of 0.05 mm", filled({1, 1, 1}, {0.05, 0.05, 0.05}, 60, 60)},
      {"one slice", filled({20, 20, 1}, {3, 3, 3}, 60, 0)},
      {"one row", filled({1, 20, 1}, {3, 3, 3}, 60, 0)},
      {"2 x 2 x 2", filled({2, 2, 2}, {20, 20, 20}, 60, -100)},
      {"spacing 0.05 mm", filled({40, 40, 40}, {0.05, 0.05, 0.05}, 60, -100)},
      {"spacing 20 mm", filled({8, 8, 8}, {20, 20, 20}, 60, -100)},
      {"spacing 0.4 x 20 x 1 mm", filled({60, 6, 30}, {0.4, 20, 1}, 60, -100)},
      {"reflected", [](Scene& scene) { turn(scene.volume, glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1)); }},
      {"-32768 everywhere", filled({8, 8, 8}, {10, 10, 10}, -32768, -32768)},
      {"32767 everywhere", filled({8, 8, 8}, {10, 10, 10}, 32767, 32767)},
      {"-32768 beside 32767", filled({8, 8, 8}, {10, 10, 10}, -32768, 32767)},
      {"air beside bone", filled({16, 16, 16}, {4, 4, 4}, -1000, 1500)},
      {"air", filled({8, 8, 8}, {10, 10, 10}, -1000, -1000)},
      {"air to the gel", filled({8, 8, 8}, {10, 10, 10}, -301, -301)},
      {"tissue to the gel", filled({8, 8, 8}, {10, 10, 10}, -300, -300)},
      {"the head of air's ramp", filled({8, 8, 8}, {10, 10, 10}, -299, -299)},
      {"on air's ramp", filled({8, 8, 8}, {10, 10, 10}, -499, -499)},
      {"bone", filled({8, 8, 8}, {10, 10, 10}, 1500, 1500)},
      {"water", filled({8, 8, 8}, {10, 10, 10}, 0, 0)},
  });
}

TEST_CASE("thousands of interfaces in a row") {
  const auto layers = [](int one, int other) {
    return [=](Scene& scene) {
      scene.volume =
          make_volume({2, 2000, 2}, {40, 0.1, 40}, [&](const glm::ivec3& i) { return i.y % 2 ? one : other; });
      scene.probe.kind = ProbeKind::linear;
      scene.probe.width_mm = 20;
      scene.probe.lines = 4;
      scene.depth_mm = 200;
      scene.settings.samples = 8192;
      scene.settings.reflection_length_mm = 0.1;
      scene.settings.gel_mm = 0;
      scene.settings.image_width = scene.settings.image_height = 16;
      scene.pose.translation = {0, -100, 0};
    };
  };
  check_each({
      {"weak", layers(60, 62)},
      {"strong", layers(60, 1500)},
      {"total", layers(-1000, 1500)},
  });
}

TEST_CASE("no stage holds a denormal number, with which a processor is slow, where sound fades through all that are") {
  // Gas and bone take all but some 10^-18 of it, and what is left fades by absorption: R and T through 10^-38.
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

TEST_CASE("poses that no hand holds") {
  const auto at = [](const glm::dvec3& place, double angle = 0, const glm::dvec3& axis = {0, 0, 1}) {
    return [=](Scene& scene) { scene.pose = {glm::dmat3(glm::rotate(glm::dmat4(1), angle, axis)), place}; };
  };
  check_each({
      {"100 m away, looking towards the body", at({0, -99999, 0})},
      {"100 m away, looking elsewhere", at({99999, 0, 0})},
      {"behind the body", at({0, 100, 0})},
      {"in the middle", at({0, 0, 0})},
      {"within bone",
       [](Scene& scene) {
         filled({8, 8, 8}, {10, 10, 10}, 1500, 1500)(scene);
         scene.pose.translation = {};
       }},
      {"within a bone that ends 15 mm before the face",
       [](Scene& scene) {
         scene.volume = make_volume({8, 8, 8}, {10, 10, 10}, [](const glm::ivec3& i) { return i.y < 5 ? 1500 : 60; });
         scene.pose.translation = {};
       }},
      {"along an axis, on the faces between voxels",
       [](Scene& scene) {
         scene.probe.kind = ProbeKind::linear;
         scene.probe.lines = 8;
         scene.probe.width_mm = 40;  // lines at odd multiples of 2.5 mm, as are the centres of voxels in x; z lies
         scene.pose.translation = {0, -30, 0};  // between two of them
       }},
      {"along an axis, through the centres of voxels",
       [](Scene& scene) {
         scene.probe.kind = ProbeKind::linear;
         scene.probe.lines = 8;
         scene.probe.width_mm = 40;
         scene.pose.translation = {0, -30, 2.5};
       }},
      {"rotated by 1e-9", at({0, -30, 0}, 1e-9)},
      {"tangent to the body", at({29.999, -30, 0}, 1.5707963)},
      {"touching a ball of bone",
       [](Scene& scene) {
         scene.volume = make_volume({24, 24, 24}, {3, 3, 3}, [](const glm::ivec3& i) {
           return glm::length(3.0 * (glm::dvec3(i) - 11.5)) < 25 ? 1500 : 60;
         });
         scene.pose.translation = {0, -25, 0};
       }},
      {"lines along the face of a bone",
       [](Scene& scene) {
         scene.volume = make_volume({16, 16, 10}, {5, 5, 5}, [](const glm::ivec3& i) { return i.x < 8 ? 1500 : 60; });
         scene.probe.kind = ProbeKind::linear;
         scene.probe.lines = 9;
         scene.probe.width_mm = 45;  // the fifth line on the face between voxels, the others on others
       }},
      {"half of the face in air",
       [](Scene& scene) {
         scene.volume =
             make_volume({16, 16, 10}, {5, 5, 5}, [](const glm::ivec3& i) { return i.x < 8 ? -1000 : mixed(i); });
         scene.probe.kind = ProbeKind::linear;
         scene.settings.gel_mm = 0;
       }},
      {"half of the face in air behind gel",
       [](Scene& scene) {
         scene.volume =
             make_volume({16, 16, 10}, {5, 5, 5}, [](const glm::ivec3& i) { return i.x < 8 ? -1000 : mixed(i); });
       }},
      {"against the axes", at({0, 40, 0}, 3.141592653589793)},
  });
}
