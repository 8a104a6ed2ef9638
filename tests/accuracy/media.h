#pragma once

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

#include "sim/reference/reference.h"

/// Media given by formulas, and the results of model S for them, written without the reference's code.
namespace insonate::test {

/// 1.0 MRayl per 100 HU and an absorption of 0.5 dB/(cm MHz) throughout: simple numbers instead of tissue.
inline TissueTable plain_table() {
  return {{{0, 1.0, 0.5, 0}, {1000, 11.0, 0.5, 0}}, {}};
}

inline ScanLines one_line(double r_max_mm, int samples) {
  ScanLines lines;
  lines.lines = {ScanLine{}};
  lines.samples = samples;
  lines.r_max_mm = r_max_mm;
  return lines;
}

inline Settings without_absorption(double reflection_length_mm) {
  Settings settings;
  settings.absorption = false;
  settings.gel_mm = 0;
  settings.speckle = false;
  settings.reflection_length_mm = reflection_length_mm;
  return settings;
}

/// Returns two media that meet in the plane y = depth, rotated about z by `tilt_deg` and blurred over `ramp_mm`.
inline MediumField interface_at(double depth, double hu_before, double hu_behind, double tilt_deg = 0,
                                double ramp_mm = 0) {
  const double c = std::cos(glm::radians(tilt_deg)), s = std::sin(glm::radians(tilt_deg));
  return [=](const glm::dvec3& p) {
    const double behind = c * (p.y - depth) + s * p.x;
    const double share = ramp_mm > 0 ? std::clamp(behind / ramp_mm + 0.5, 0.0, 1.0) : (behind > 0 ? 1.0 : 0.0);
    return Medium{hu_before + share * (hu_behind - hu_before), 0};
  };
}

/// Returns the reflection coefficient (1) of two impedances.
inline double alpha_between(double z1, double z2) {
  return (z2 - z1) * (z2 - z1) / ((z2 + z1) * (z2 + z1));
}

/// Returns the reflection coefficient (1) of two densities of plain_table().
inline double plain_alpha(double hu1, double hu2) {
  return alpha_between(1 + hu1 / 100, 1 + hu2 / 100);
}

}  // namespace insonate::test
