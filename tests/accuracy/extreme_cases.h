#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "tests/accuracy/stress_scene.h"

/// Extreme conditions for both models, each applied to an otherwise ordinary scene.
namespace insonate::test {

struct ExtremeCase {
  const char* name;
  std::function<void(Scene&)> apply;
};

inline std::vector<ExtremeCase> joined(std::vector<ExtremeCase> cases, const std::vector<ExtremeCase>& more) {
  cases.insert(cases.end(), more.begin(), more.end());
  return cases;
}

template <typename T>
std::function<void(Scene&)> set(T Settings::*member, T value) {
  return [=](Scene& scene) { scene.settings.*member = value; };
}

inline std::function<void(Scene&)> filled_with(const glm::ivec3& size, const glm::dvec3& spacing, HuAt hu) {
  return [size, spacing, hu = std::move(hu)](Scene& scene) { scene.volume = make_volume(size, spacing, hu); };
}

inline std::function<void(Scene&)> filled(const glm::ivec3& size, const glm::dvec3& spacing, int hu) {
  return filled_with(size, spacing, [=](const glm::ivec3&) { return hu; });
}

/// Returns extreme views, which both models share.
inline std::vector<ExtremeCase> extreme_views() {
  using S = Settings;
  const auto deep = [](double depth_mm) { return [=](Scene& scene) { scene.depth_mm = depth_mm; }; };
  const auto probe = [](ProbeKind kind) { return [=](Scene& scene) { scene.probe.kind = kind; }; };
  return {
      {"nothing extreme", [](Scene&) {}},
      {"linear probe", probe(ProbeKind::linear)},
      {"phased probe", probe(ProbeKind::phased)},
      {"0.1 mm deep", deep(0.1)},
      {"1000 mm deep", deep(1000)},
      {"1 sample", set(&S::samples, 1)},
      {"8192 samples",
       [](Scene& scene) {
         scene.settings.samples = 8192;
         scene.probe.lines = 3;
         scene.settings.image_width = scene.settings.image_height = 12;
       }},
      {"reflection length 0.01 mm", set(&S::reflection_length_mm, 0.01)},
      {"reflection length 20 mm", set(&S::reflection_length_mm, 20.0)},
      {"no gel", set(&S::gel_mm, 0.0)},
      {"gel 100 mm", set(&S::gel_mm, 100.0)},
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
  };
}

/// Fills the volume with a checkerboard.
/// @param side  of its fields, voxels. With 1 each voxel has equal neighbours on either side, so that symmetric
///              differences find nothing.
inline std::function<void(Scene&)> board(const glm::ivec3& size, const glm::dvec3& spacing, int one, int other,
                                         int side) {
  return filled_with(size, spacing, [=](const glm::ivec3& i) { return checkerboard(i / side, one, other); });
}

/// @param side  as in board()
inline std::vector<ExtremeCase> extreme_volumes(int side = 1) {
  return {
      {"one voxel", filled({1, 1, 1}, {5, 5, 5}, 60)},
      {"one voxel of 0.05 mm", filled({1, 1, 1}, {0.05, 0.05, 0.05}, 60)},
      {"one slice", board({20, 20, 1}, {3, 3, 3}, 60, 0, side)},
      {"one row", board({1, 20, 1}, {3, 3, 3}, 60, 0, side)},
      {"2 x 2 x 2", board({2, 2, 2}, {20, 20, 20}, 60, -100, side)},
      {"spacing 0.05 mm", board({40, 40, 40}, {0.05, 0.05, 0.05}, 60, -100, side)},
      {"spacing 20 mm", board({8, 8, 8}, {20, 20, 20}, 60, -100, side)},
      {"spacing 0.4 x 20 x 1 mm", board({60, 6, 30}, {0.4, 20, 1}, 60, -100, side)},
      {"reflected", [](Scene& scene) { turn(scene.volume, glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1)); }},
      {"-32768 everywhere", filled({8, 8, 8}, {10, 10, 10}, -32768)},
      {"32767 everywhere", filled({8, 8, 8}, {10, 10, 10}, 32767)},
      {"-32768 beside 32767", board({8, 8, 8}, {10, 10, 10}, -32768, 32767, side)},
      {"air beside bone", board({16, 16, 16}, {4, 4, 4}, -1000, 1500, side)},
      {"air", filled({8, 8, 8}, {10, 10, 10}, -1000)},
      {"air to the gel", filled({8, 8, 8}, {10, 10, 10}, -301)},
      {"tissue to the gel", filled({8, 8, 8}, {10, 10, 10}, -300)},
      {"the head of air's ramp", filled({8, 8, 8}, {10, 10, 10}, -299)},
      {"on air's ramp", filled({8, 8, 8}, {10, 10, 10}, -499)},
      {"bone", filled({8, 8, 8}, {10, 10, 10}, 1500)},
      {"water", filled({8, 8, 8}, {10, 10, 10}, 0)},
  };
}

/// Fills the volume with as many layers as 2000 voxels hold, close to the largest axis that every device supports.
/// @param voxels_per_layer  thickness of a layer, as the side of board()
inline std::vector<ExtremeCase> layers_in_a_row(int voxels_per_layer = 1) {
  const auto layers = [=](int one, int other) {
    return [=](Scene& scene) {
      scene.volume = make_volume({2, 2000, 2}, {40, 0.1, 40},
                                 [&](const glm::ivec3& i) { return i.y / voxels_per_layer % 2 ? one : other; });
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
  return {
      {"weak", layers(60, 62)},
      {"strong", layers(60, 1500)},
      {"total", layers(-1000, 1500)},
  };
}

inline std::vector<ExtremeCase> extreme_poses() {
  const auto at = [](const glm::dvec3& place, double angle = 0, const glm::dvec3& axis = {0, 0, 1}) {
    return [=](Scene& scene) { scene.pose = {glm::dmat3(glm::rotate(glm::dmat4(1), angle, axis)), place}; };
  };
  return {
      {"100 m away, looking towards the body", at({0, -99999, 0})},
      {"100 m away, looking elsewhere", at({99999, 0, 0})},
      {"behind the body", at({0, 100, 0})},
      {"in the middle", at({0, 0, 0})},
      {"within bone",
       [](Scene& scene) {
         filled({8, 8, 8}, {10, 10, 10}, 1500)(scene);
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
         scene.probe.width_mm = 45;  // the fifth line lies on the face between voxels, as do the others on other faces
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
  };
}

}  // namespace insonate::test
