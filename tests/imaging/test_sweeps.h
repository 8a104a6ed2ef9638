#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

#include "sim/imaging/sweep_simulator.h"
#include "tests/imaging/test_body.h"
#include "tests/model/amplitudes.h"

/// Sweeps over the test body, and settings in which all of it is visible.
namespace insonate::test {

inline constexpr double kDepth_mm = 110;

inline Probe small_probe(const char* name) {
  Probe probe = *find_probe(name);
  probe.lines = 30;  // not a multiple of a work group, nor of the four lines that share their windows
  return probe;
}

/// Returns a sweep over the rib, the cyst and the gas.
inline Sweep swept(const char* probe_name, int planes = 9) {
  const Probe probe = small_probe(probe_name);
  return {probe, kDepth_mm, swept_planes(on_the_skin(0, 9, 0), planes, 40, 30)};
}

/// Returns a sweep as a hand moves: each plane is rotated and moved differently relative to the one before.
inline Sweep by_hand() {
  Sweep sweep{small_probe("curvilinear"), kDepth_mm, {}};
  Pose patient_from_plane = on_the_skin(-6, 7, -12);
  for (int k = 0; k < 9; ++k) {
    sweep.patient_from_plane.push_back(patient_from_plane);
    const glm::dmat4 turn =
        glm::rotate(glm::dmat4(1.0), 0.03 + 0.02 * (k % 3), glm::normalize(glm::dvec3(1, 0.5 * std::sin(k), 0.2)));
    patient_from_plane = patient_from_plane * Pose{glm::dmat3(turn), {std::cos(k), 0.3, 2.5 + k % 2}};
  }
  return sweep;
}

/// Returns settings with every effect on, strong enough to be visible.
inline Settings everything() {
  Settings settings = test::trainer_with_amplitudes(3.5, kDepth_mm);
  settings.samples = 150;
  settings.reverberation = settings.clutter = settings.electronic_noise = settings.edge_shadow = true;
  settings.face_reflection = 0.3;
  settings.clutter_db = -15;
  settings.noise_db = -80;
  settings.slice_planes = 3;
  settings.gain_db = 10;
  return settings;
}

inline Settings of_the_paper() {
  Settings settings = paper_settings(kDepth_mm, 150);
  settings.blend = 1e-3;  // otherwise its brightest voxel leaves the rest black
  return settings;
}

inline gl::SweepSimulator simulator_of(const Sweep& sweep, const Settings& settings, const Grid& grid,
                                       const gl::WorkDivision& division = gl::WorkDivision::of_device()) {
  gl::SweepSimulator simulator({}, division);
  simulator.set_volume(test_body(), tissues());
  simulator.set_sweep(sweep);
  simulator.set_settings(settings);
  simulator.set_grid(grid);
  return simulator;
}

}  // namespace insonate::test
