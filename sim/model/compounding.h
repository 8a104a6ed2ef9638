#pragma once

#include <glm/mat4x4.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include "sim/model/settings.h"
#include "sim/probe/probe.h"

/// Spatial compounding with Settings::steering_angles > 1: a picture is the mean of several looks. A look is what the
/// probe sees with its lines turned by one angle (LineFan::steering). The looks are averaged as envelopes, at the
/// pixels, after detection (Shattuck, von Ramm, Ultrasonic Imaging 4, 1982; Entrekin et al., Seminars in Ultrasound, CT
/// and MRI 22, 2001):
///
///     U = (sum_i U_i^(1/2) / n)^2        over the n looks whose lines reach the pixel; the straight one always does
///
/// So speckle, which differs from look to look, has a contrast lower by up to n^(1/2); interfaces are met squarely by
/// one look or another; and shadows become triangles. Looks need waves, and a face from which lines can be steered: a
/// phased array has one look. A sweep's volume (sim/imaging/sweep_simulator.h) is not compounded.
///
/// Looks see other speckle because their carriers run across each other: with k = 2 pi / lambda, a scatterer at x has
/// in a look of direction d the phase 2 k d . x. The phase of the straight look is part of the scatterer's amplitude
/// (waves.h). In another look the amplitude a_s becomes
///
///     a_s i^q,  q = floor(4 f mod 4),  f = (2 / lambda) (d - d_0) . x_s,  lambda = 1.54 mm MHz / frequency_mhz
///
/// with d_0 the direction of the probe's axis and d that of the axis turned by the look's angle, for all lines. (d -
/// d_0 turns with the lines of a fan; its length, which decides how speckle decorrelates, does not change.) x_s is in
/// the patient's frame, so grain stays in the tissue when the probe moves along. The quarters of a turn keep amplitudes
/// real or imaginary. They lower the correlation of neighbouring positions of the probe by up to a fifth.
namespace insonate {

/// Returns the angles of the looks, rad, evenly spaced from the outermost towards -x to the outermost towards +x. The
/// middle one is 0.
std::vector<double> look_angles(const Probe& probe, const Settings& settings);

/// Returns f per step of 1/1024 cell along each axis of the scatterers' cells, in 2^-32 turns modulo 2^32. Whole
/// numbers make q exact: f of a scatterer is the sum over the axes of step times place, modulo 2^32, where the place is
/// 1024 cell + m (Scatterer).
/// @param probe_from_cells  the inverse of cells_from_patient() (waves.h), then the probe's frame
std::array<std::uint32_t, 3> phase_steps(const glm::dmat4& probe_from_cells, const Settings& settings, double steering);

}  // namespace insonate
