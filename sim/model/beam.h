#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Returns the window (4) over the lines of the active aperture: `beam_lines` weights, symmetric, sum 1.
std::vector<double> beam_weights(const Settings& settings);

/// Returns the lateral full width at half maximum, mm, of a beam at a distance r >= 0 from the face. The beam is
/// transmitted with a fixed focus F and received with a dynamic one, both with the f-number N as far as the aperture D
/// allows. With lambda = 1.54 mm MHz / frequency:
///
///     w(n)      0.8859 lambda n
///     sent      hypot(w_F, (r - F) 2 ln 2 lambda / (pi w_F)),      w_F = w(max(N, F/D))
///     received  w(max(N, r/D))
///     both      (1/sent^2 + 1/received^2)^(-1/2)
///
/// w is the width of sinc^2(x / (lambda n)), the intensity of an evenly weighted aperture at its focus (Szabo,
/// Diagnostic Ultrasound Imaging, 6). The transmitted beam is Gaussian with a waist of that width (Siegman, Lasers,
/// 17.1). The combined beam is the product of two Gaussians: 0.626 lambda N at the focus, where sinc^4 has 0.638.
/// docs/speckle.md compares it with the arrays' own.
/// @param aperture_mm  D, Probe::aperture_mm
double focused_beam_fwhm_mm(const Settings& settings, double aperture_mm, double r_mm);

/// The largest half width of a focused beam's window, in lines to either side.
inline constexpr int kMaxFocusedRadius = 127;

/// Returns the focused beam's window at each sample, as the standard deviation of a Gaussian, in lines. The window is
/// cut off at three standard deviations or kMaxFocusedRadius lines. Wider beams are narrowed to fit; 0 for a single
/// line.
std::vector<double> focused_beam_sigma(const ScanLines& lines, const Settings& settings);

/// Returns the half width of that window, in lines to either side.
int focused_radius(double sigma_lines);

/// Returns the window at one sample, for the beam that the settings select: an odd number of weights, symmetric, sum 1.
/// @param sigma_lines  standard deviation of the focused beam at this sample, in lines
std::vector<double> beam_weights_at(const Settings& settings, double sigma_lines);

/// Returns the full width at half maximum of the slice in elevation, mm, at a distance r from the face. Without an
/// elevation focus it is slice_thickness_mm. With an elevation focus F it is the width of a Gaussian beam about its
/// waist, transmitted and received by one lens:
///
///     hypot(slice_thickness_mm, (r - F) ln 2 lambda / (pi slice_thickness_mm))      lambda = 1.54 mm MHz / frequency
///
/// (Siegman, Lasers, 17.1, both ways; Goldstein, Ultrasound in Medicine and Biology 14, 1988: slice thickness).
double slice_thickness_at_mm(const Settings& settings, double r_mm);

/// Returns whether the slice has a thickness: several planes, or scatterers (waves.h).
bool has_slice(const Settings& settings);

/// Returns whether the slice gets thicker away from an elevation focus.
bool has_elevation_focus(const Settings& settings);

/// Returns how much thicker the slice gets far from its focus, mm per mm; 0 without an elevation focus.
double slice_spread(const Settings& settings);

/// One of the parallel planes of lines that sample the beam in elevation. It lies in different places for even and
/// odd lines.
struct SlicePlane {
  struct Place {
    double offset = 0;   ///< distance from the imaging plane in elevation, in thicknesses of the slice
    double weight = 1;   ///< weight of its I, R and scatterer amplitudes; those of a line sum to 1
    double lateral = 0;  ///< towards the next line, in distances of lines (line_beside())
  };
  std::array<Place, 2> places;  ///< of even and of odd lines

  const Place& of_line(std::size_t line) const { return places[line % places.size()]; }
};

/// Returns `slice_planes` planes that sample the slice's thickness: at the middles of equal parts of four standard
/// deviations, with weights of the Gaussian across the beam. With an elevation focus, their distances follow the
/// thickness.
///
/// With waves and several planes, those of even lines are moved in elevation by a quarter of their distance, and those
/// of odd lines by as much to the other side. The beam sums over neighbouring lines, and thus over twice as many
/// planes. Otherwise a rib that is steep in elevation would be a ladder: one echo for each plane. Patterns of more than
/// two lines would show as stripes in shadows. For the same reason every second plane lies halfway to a neighbouring
/// line: a diaphragm that is steep in the plane would be a row of dashes, one for each line. Both halves of the slice
/// meet between two lines, one half from either line. So these places are not their own mirror image.
std::vector<SlicePlane> slice_planes(const Settings& settings);

/// Returns what lies beside a line, at a share of the distance to the next one (-1 to 1; below 0 to the one before).
/// Beside the outer lines it goes on as within.
ScanLine line_beside(const ScanLines& lines, std::size_t line, double share);

/// Returns the factor on the speckle's envelope at each sample that gives fully developed speckle a mean of 1.
///
/// Where lines are closer together than the scatterers' cells, neighbouring lines see the same scatterers, and their
/// window averages out less. Without this factor the near field of a fan would be brighter than its depth. The
/// correlation between lines a distance d apart is that of linear interpolation: the cubic B-spline in d / cell.
std::vector<double> envelope_scale(const ScanLines& lines, const Settings& settings);

}  // namespace insonate
