#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "sim/core/hash.h"
#include "sim/core/pose.h"
#include "sim/model/display_filter.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/wein/wein_settings.h"
#include "tests/model/amplitudes.h"

/// Stress inputs for the pipeline: everything that a picture depends on, up to the ends of its range.
namespace insonate::test {

struct Scene {
  AcousticVolume volume;
  Probe probe;
  double depth_mm = 60;
  Settings settings;
  Pose pose;  ///< the middle of the volume lies at the origin
};

/// Returns a voxel's Hounsfield units for its index.
using HuAt = std::function<int(const glm::ivec3&)>;

inline int checkerboard(const glm::ivec3& i, int one, int other) {
  return (i.x + i.y + i.z) % 2 ? one : other;
}

inline AcousticVolume make_volume(const glm::ivec3& size, const glm::dvec3& spacing, const HuAt& hu) {
  AcousticVolume volume;
  volume.grid.size = size;
  volume.grid.spacing = spacing;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const double share = unit_float(hash(std::uint32_t(volume.voxels.size())));
        volume.voxels.push_back({std::int16_t(hu({x, y, z})), std::int16_t(std::lround(-6000 + 9000 * share))});
      }
  volume.grid.origin = -volume.grid.centre();
  return volume;
}

/// Rotates the volume's axes to `direction` and moves its middle to the origin.
inline void turn(AcousticVolume& volume, const glm::dmat3& direction) {
  volume.grid.origin = {};
  volume.grid.direction = direction;
  volume.grid.origin = -volume.grid.centre();
}

/// Returns soft tissue of all densities with specks of gas and bone.
inline int mixed(const glm::ivec3& i) {
  const std::uint32_t bits = hash(std::uint32_t(i.x), std::uint32_t(i.y), std::uint32_t(i.z), 7u);
  if (bits % 23 == 0) return 900;
  if (bits % 29 == 0) return -980;
  return int(bits >> 8) % 200 - 110;
}

/// Returns a small picture of mixed tissue with every effect on, from which the extreme scenes differ.
inline Scene ordinary_scene() {
  Scene scene;
  scene.volume = make_volume({12, 16, 10}, {5, 5, 5}, mixed);
  scene.probe = *find_probe("curvilinear");
  scene.probe.lines = 12;
  scene.settings = test::trainer_with_amplitudes(3.5, scene.depth_mm);
  scene.settings.samples = 100;
  scene.settings.reflection_length_mm = 0.9;
  scene.settings.image_width = 48;
  scene.settings.image_height = 40;
  scene.settings.skipping = false;  // which the reference does not implement
  scene.pose.translation = {0, -30, 0};
  return scene;
}

/// Draws numbers from a seed, equal on every machine.
class Draw {
public:
  explicit Draw(std::uint32_t seed) : seed_(seed) {}
  double share() { return unit_float(hash(seed_, count_++)); }
  bool chance(double share_of_yes) { return share() < share_of_yes; }
  int whole(int least, int most) { return std::min(most, least + int(share() * (most - least + 1))); }
  template <typename T>
  T one_of(std::initializer_list<T> choices) {
    return choices.begin()[whole(0, int(choices.size()) - 1)];
  }
  /// Returns the least, the most, or a value between.
  double within(double least, double most) {
    const double at = share();
    if (at < 0.15) return least;
    if (at > 0.85) return most;
    return least > 0 ? least * std::pow(most / least, share()) : least + (most - least) * share();
  }

private:
  std::uint32_t seed_, count_ = 0;
};

inline Scene random_scene(std::uint32_t seed) {
  Draw draw(seed);
  Scene scene = ordinary_scene();

  const glm::dvec3 spacing(draw.within(0.05, 20), draw.within(0.05, 20), draw.within(0.05, 20));
  const glm::ivec3 size(draw.whole(1, 9), draw.whole(1, 9), draw.whole(1, 9));
  const int one = draw.one_of({-32768, -1000, -501, -300, 0, 60, 300, 1500, 32767});
  const int other = draw.one_of({-32768, -1000, -400, -100, 8, 60, 1000, 3071, 32767});
  const int pattern = draw.whole(0, 2);
  scene.volume = make_volume(size, spacing, [&](const glm::ivec3& i) {
    return pattern == 0 ? one : pattern == 1 ? checkerboard(i, one, other) : mixed(i);
  });
  const glm::dmat3 turned(glm::rotate(glm::dmat4(1), draw.within(0, 6), glm::dvec3(0.3, 1, draw.share() - 0.5)));
  turn(scene.volume, draw.chance(0.5) ? turned : glm::dmat3(-turned[0], turned[1], turned[2]));

  Probe& probe = scene.probe;
  probe.kind = draw.one_of({ProbeKind::linear, ProbeKind::curvilinear});
  probe.radius_mm = draw.within(5, 200);
  probe.field_of_view_deg = draw.within(5, 150);
  probe.width_mm = draw.within(5, 200);
  probe.lines = draw.whole(1, 24);
  scene.depth_mm = draw.within(10, 400);

  Settings& s = scene.settings;
  s.samples = draw.whole(1, 150);
  s.reflection_length_mm =
      draw.chance(0.3) ? std::clamp(draw.whole(1, 3) * scene.depth_mm / s.samples, 0.01, 20.0) : draw.within(0.01, 20);
  s.frequency_mhz = draw.within(0.5, 30);
  s.absorption = draw.chance(0.7);
  s.gel_mm = draw.within(0, 100);
  s.beam_window = draw.one_of({BeamWindow::box, BeamWindow::triangle, BeamWindow::hann});
  s.beam_lines = draw.one_of({1, 3, 7, 31, 255});
  s.speckle = draw.chance(0.7);
  s.speckle_cell_mm = draw.within(0.05, 10);
  s.reflection_sigma_mm = draw.one_of({0.0, 0.45, 5.0, 1000.0});
  s.transmission_sigma_mm = draw.one_of({0.0, 0.45, 5.0, 1000.0});
  s.blend = draw.one_of({0.0, 4e-5, 1.0, 1000.0});
  s.two_way = draw.chance(0.5);
  s.electronic_noise = draw.chance(0.3);
  s.noise_db = draw.within(-200, -0.5);
  s.gain_db = draw.within(-60, 60);
  const double most_time_gain = draw.one_of({0.0, 60.0, 300.0});
  for (double& db : s.tgc_db) db = most_time_gain * (2 * draw.share() - 1);
  s.dynamic_range_db = draw.within(1, 200);
  s.reference_level = draw.one_of({ReferenceLevel::frame_maximum, ReferenceLevel::fixed});
  s.fixed_level = draw.within(1e-12, 1e6);
  s.image_width = draw.whole(1, 48);
  s.image_height = draw.whole(1, 48);

  const glm::dvec3 axis(draw.share() - 0.5, draw.share() - 0.5, 0.1 + draw.share());
  const double angle = draw.one_of({0.0, 1e-9, 0.3, 3.14159, 6 * draw.share()});
  scene.pose.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), angle, axis));
  const double away = draw.one_of({0.0, 1.0, 30.0, 300.0, 99999.0});
  scene.pose.translation = scene.pose.rotation * glm::dvec3(0, -away, 0);
  s.focused_beam = draw.chance(0.6);
  return scene;
}

/// Returns the same scene with all effects of the receiver and the beam drawn too, and any probe.
inline Scene random_scene_of_everything(std::uint32_t seed) {
  Scene scene = random_scene(seed);
  Draw draw(hash(seed, 0xeffec7u));
  scene.probe.kind = draw.one_of({ProbeKind::linear, ProbeKind::curvilinear, ProbeKind::phased});
  Settings& s = scene.settings;
  s.focused_beam = draw.chance(0.5);
  s.focus_mm = draw.within(5, 400);
  s.f_number = draw.within(0.5, 30);
  s.slice_planes = draw.one_of({1, 1, 3, 7, 31});
  s.slice_thickness_mm = draw.within(0.1, 20);
  s.reverberation = draw.chance(0.5);
  s.face_reflection = draw.chance(0.5) ? 0 : draw.within(0, 1);
  s.clutter = draw.chance(0.5);
  s.clutter_db = draw.within(-100, -0.01);
  s.grey_map = draw.one_of({GreyMap::linear, GreyMap::soft, GreyMap::contrast, GreyMap::s_curve});
  s.skipping = draw.chance(0.5);
  s.edge_shadow = draw.chance(0.3);
  s.elevation_focus_mm = draw.chance(0.5) ? 0 : draw.within(5, 400);
  if (draw.chance(0.3)) {
    s.edge_enhancement = draw.one_of({0.0, draw.within(0, 4)});
    s.speckle_reduction = draw.one_of({0.0, draw.within(0, 1)});
  }
  return scene;
}

/// Returns the same scene; in three quarters of the cases the probe begins at the volume or in it instead of anywhere.
inline Scene random_scene_at_body(std::uint32_t seed) {
  Scene scene = random_scene_of_everything(seed);
  Draw draw(hash(seed, 0xb0d7u));
  if (draw.chance(0.75)) {
    const Grid& grid = scene.volume.grid;
    const double half_mm = glm::length(grid.spacing * glm::dvec3(grid.size)) / 2;
    scene.pose.translation = scene.pose.rotation * glm::dvec3(0, -draw.within(0, half_mm), 0);
  }
  return scene;
}

/// Returns the same scene with echoes that add up as waves (sim/model/waves.h).
inline Scene random_scene_of_waves(std::uint32_t seed) {
  Scene scene = random_scene_at_body(seed);
  Draw draw(hash(seed, 0x3a7eu));
  scene.settings.waves = true;
  scene.settings.specular_exponent = draw.within(1, 64);
  scene.settings.mirror_image = draw.chance(0.5) ? 0 : draw.within(0, 1);
  scene.settings.ring_down = draw.chance(0.5) ? 0 : draw.within(0, 10);
  return scene;
}

/// Returns `scene` with those settings changed that would need compiling again after `first`: compiling takes as long
/// as hundreds of small pictures. Volume, probe, depth, pose and all other settings stay.
inline Scene compiled_as(const Scene& first, Scene scene) {
  const Settings& as = first.settings;
  Settings& s = scene.settings;
  const auto take = [&](auto... members) { ((s.*members = as.*members), ...); };
  using S = Settings;
  take(&S::waves, &S::absorption, &S::speckle, &S::edge_shadow, &S::slice_planes, &S::focused_beam, &S::beam_lines,
       &S::reverberation, &S::electronic_noise, &S::clutter, &S::grey_map, &S::reference_level, &S::image_width,
       &S::image_height, &S::edge_enhancement, &S::speckle_reduction);
  if (as.elevation_focus_mm == 0) s.elevation_focus_mm = 0;
  if (as.elevation_focus_mm > 0 && s.elevation_focus_mm == 0) s.elevation_focus_mm = as.elevation_focus_mm;
  if (as.face_reflection == 0) s.face_reflection = 0;
  if (as.face_reflection > 0 && s.face_reflection == 0) s.face_reflection = as.face_reflection;

  // One, two or any number of samples per reflection length, as far as the ends of the range allow.
  const auto samples_per_length = [](const Scene& of) {
    return of.settings.reflection_length_mm * of.settings.samples / of.depth_mm;
  };
  const auto one_or_two = [](double n) { return std::abs(n - 1) < 1e-6 || std::abs(n - 2) < 1e-6; };
  double wanted = samples_per_length(one_or_two(samples_per_length(first)) ? first : scene);
  if (one_or_two(wanted) && !one_or_two(samples_per_length(first))) wanted *= 1.25;
  s.reflection_length_mm = std::clamp(wanted * scene.depth_mm / s.samples, 0.01, 20.0);

  // Smoothed over equally many pixels.
  const auto mm_per_pixel = [](const Scene& of) {
    return image_geometry(of.probe, of.depth_mm, of.settings.image_width, of.settings.image_height).mm_per_pixel;
  };
  const double larger = mm_per_pixel(scene) / mm_per_pixel(first);
  if (is_filtered(s)) s.frequency_mhz = std::clamp(as.frequency_mhz / larger, 0.5, 30.0);
  s.reflection_sigma_mm = std::min(as.reflection_sigma_mm * larger, 1000.0);
  s.transmission_sigma_mm = std::min(as.transmission_sigma_mm * larger, 1000.0);
  return scene;
}

/// Returns model W's settings for the scene of the same seed.
inline WeinSettings random_wein_settings(std::uint32_t seed) {
  Draw draw(hash(seed, 0x77u));
  WeinSettings s;
  s.samples = draw.whole(1, 150);
  s.reflection_length_mm = draw.within(0.01, 20);
  s.contact_mm = draw.within(0, 100);
  s.compression = draw.within(0.001, 1e6);
  s.dark_hu = draw.one_of({-1000.0, -200.0, -50.0, 2999.0});
  s.bright_hu = std::min(s.dark_hu + draw.within(1, 4000), 3000.0);
  s.shadows = draw.chance(0.7);
  s.reflection_share = draw.within(0, 1);
  s.image_width = draw.whole(1, 48);
  s.image_height = draw.whole(1, 48);
  s.similarity_patch = draw.one_of({0, 0, kMinPatch, 17, kMaxPatch});
  return s;
}

}  // namespace insonate::test
