// Model W at the ends of its ranges, as stress_gl_test.cpp has model S.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "sim/gl/wein_simulator.h"
#include "sim/model/wein_settings_file.h"
#include "sim/reference/wein_reference.h"
#include "tests/accuracy/stress_bounds.h"
#include "tests/accuracy/stress_scene.h"
#include "tests/gl/parity.h"
#include "tests/gl/test_context.h"

using namespace insonate;
using namespace insonate::test;

namespace {

struct WeinScene {
  Scene place;
  WeinSettings settings;
};

WeinScene ordinary_wein_scene() {
  WeinScene scene{ordinary_scene(), {}};
  scene.settings.image_width = 48;
  scene.settings.image_height = 40;
  return scene;
}

template <typename Real>
std::string out_of_bounds(const WeinStages<Real>& stages, const Image<std::uint8_t>& inside) {
  constexpr double kOne = 1 + 1e-6;  // a logarithm over another
  if (const auto fault = outside("I", stages.intensity, 1)) return *fault;
  if (const auto fault = outside("E", stages.scan_echogenicity, 1)) return *fault;
  if (const auto fault = outside("R", stages.scan_reflection, kOne)) return *fault;
  const std::size_t lines = std::size_t(stages.intensity.width);
  for (std::size_t i = lines; i < stages.intensity.pixels.size(); ++i)
    if (stages.intensity.pixels[i] > stages.intensity.pixels[i - lines]) return at("rising I", stages.intensity, i);
  for (std::size_t i = 0; i < stages.grey.pixels.size(); ++i)
    if (stages.grey.pixels[i] && !inside.pixels[i]) return at("grey outside the fan", stages.grey, i);
  return "";
}

class Stressed {
public:
  /// Bounds alone.
  void check_shaders(const WeinScene& scene) {
    REQUIRE(why_not_valid(scene.settings).value_or("") == "");
    gl::WeinSimulator simulator(scene.place.volume, scene.place.probe, scene.place.depth_mm,
                                exact_as_needed(scene.settings));
    got_ = simulator.read_stages(scene.place.pose);
    inside_ = simulator.inside();
    CHECK(out_of_bounds(got_, inside_) == "");
    Image<float> ultrasound(scene.settings.image_width, scene.settings.image_height);
    for (std::size_t i = 0; i < ultrasound.pixels.size(); ++i)
      ultrasound.pixels[i] = unit_float(hash(std::uint32_t(i)));
    simulator.set_ultrasound(ultrasound);
    const float similarity = simulator.similarity({&scene.place.pose, 1}).front();
    CHECK(similarity >= 0);  // not so for NaN
    CHECK(similarity <= 1);
  }

  /// Bounds of both, and agreement, for densities of which a CT is made: gradients beyond 4096 HU are cut off.
  void check(const WeinScene& scene) {
    check_shaders(scene);
    const Scene& place = scene.place;
    const WeinField field = wein_field(place.volume, scene.settings.reflection_length_mm);
    const auto reference = [&](const WeinField& of) {
      return wein_reference(of, place.probe, place.depth_mm, scene.settings, place.pose);
    };
    const WeinStages<double> expected = reference(field);
    REQUIRE(out_of_bounds(expected, inside_) == "");

    // As in wein_gl_test.cpp, with a place as uncertain as the furthest is far away; the stored gradient is rounded to
    // 1/16 HU, and drawn from twice that range, because a few draws need not come near the worst.
    const Grid& grid = place.volume.grid;
    const double reach =
        glm::length(grid.spacing * glm::dvec3(grid.size)) + glm::length(place.pose.translation) + place.depth_mm;
    std::array<WeinStages<double>, 4> uncertain;
    for (std::uint32_t i = 0; i < uncertain.size(); ++i)
      uncertain[i] = reference([&field, i, reach, count = std::uint32_t(0)](const glm::dvec3& p) mutable {
        const auto random = [&] { return 2.0 * unit_float(hash(i, count++)) - 1.0; };
        WeinMedium medium = field(p + 2e-7 * reach * glm::dvec3(random(), random(), random()));
        medium.hu += 1e-3 * random();
        medium.gradient_hu += glm::dvec3(random(), random(), random()) / 8.0;
        return medium;
      });
    const auto agree = [&](const char* what, Image<double> WeinStages<double>::*stage, const Image<float>& image,
                           auto&& basic) {
      const Worst found = worst(expected.*stage, image, tolerated(expected, uncertain, stage, basic));
      INFO(told(what, found));
      CHECK(found.error < 1);
    };
    agree("I", &WeinStages<double>::intensity, got_.intensity, [](double i) { return 1e-4 * std::max(i, 1e-6); });
    agree("R", &WeinStages<double>::scan_reflection, got_.scan_reflection, [](double) { return 1e-4; });
    agree("E", &WeinStages<double>::scan_echogenicity, got_.scan_echogenicity, [](double) { return 1e-4; });
  }

private:
  test::TestContext context_;
  WeinStages<float> got_;
  Image<std::uint8_t> inside_;
};

}  // namespace

TEST_CASE("model W: settings at the ends of their ranges") {
  using W = WeinSettings;
  const auto set = [](auto W::*member, auto value) {
    return [=](WeinScene& scene) { scene.settings.*member = value; };
  };
  const struct {
    const char* name;
    std::function<void(WeinScene&)> apply;
  } strains[] = {
      {"nothing strained", [](WeinScene&) {}},
      {"1 sample", set(&W::samples, 1)},
      {"8192 samples",
       [](WeinScene& scene) {
         scene.settings.samples = 8192;
         scene.place.probe.lines = 3;
       }},
      {"reflection length 0.01 mm", set(&W::reflection_length_mm, 0.01)},
      {"reflection length 20 mm", set(&W::reflection_length_mm, 20.0)},
      {"no contact", set(&W::contact_mm, 0.0)},
      {"contact 100 mm", set(&W::contact_mm, 100.0)},
      {"compression 0.001", set(&W::compression, 0.001)},
      {"compression 1e6", set(&W::compression, 1e6)},
      {"echogenicity from nothing to all within 1 HU", set(&W::bright_hu, -49.0)},
      {"no shadows", set(&W::shadows, false)},
      {"reflections alone", set(&W::reflection_share, 1.0)},
      {"echogenicity alone", set(&W::reflection_share, 0.0)},
      {"1 pixel", [](WeinScene& scene) { scene.settings.image_width = scene.settings.image_height = 1; }},
      {"1 line", [](WeinScene& scene) { scene.place.probe.lines = 1; }},
      {"100 m away",
       [](WeinScene& scene) {
         scene.place.pose.translation = {0, -99999, 0};
       }},
      {"air beside bone",
       [](WeinScene& scene) {
         scene.place.volume =
             make_volume({16, 16, 16}, {4, 4, 4}, [](const glm::ivec3& i) { return checkerboard(i, -1000, 1500); });
       }},
  };
  Stressed stressed;
  for (const auto& strain : strains) {
    INFO(strain.name);
    WeinScene scene = ordinary_wein_scene();
    strain.apply(scene);
    stressed.check(scene);
  }
  for (const int hu : {-32768, -1000, 0, 1500, 32767}) {
    INFO(hu << " HU beside 32767 everywhere");
    WeinScene scene = ordinary_wein_scene();
    scene.place.volume =
        make_volume({8, 8, 8}, {10, 10, 10}, [&](const glm::ivec3& i) { return checkerboard(i, hu, 32767); });
    stressed.check_shaders(scene);
  }
}

TEST_CASE("model W: random scenes, each from its seed") {
  const long frames = from_environment("INSONATE_STRESS_FRAMES", 25);
  const long first = from_environment("INSONATE_STRESS_SEED", 1);
  Stressed stressed;
  long compared = 0;  // most of the others hold an int16's ends
  for (long seed = first; seed < first + frames; ++seed) {
    INFO("seed " << seed);
    const WeinScene scene{random_scene(std::uint32_t(seed)), random_wein_settings(std::uint32_t(seed))};
    const auto [least, most] = std::ranges::minmax(scene.place.volume.voxels, {}, &AcousticVoxel::hu);
    if (most.hu - least.hu < 4096) {
      stressed.check(scene);
      ++compared;
    } else {
      stressed.check_shaders(scene);
    }
  }
  CHECK(compared > frames / 4);
}
