#pragma once

#include <vector>

#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The window (4) over the lines of the active aperture: `beam_lines` weights, symmetric, sum 1.
std::vector<double> beam_weights(const Settings& settings);

/// Lateral full width at half maximum, mm, of a beam sent with a fixed focus F and received with a moving one, at a
/// distance r >= 0 from the face. With N the f-number and lambda = 1.54 mm MHz / frequency:
///
///     w         0.8859 lambda N
///     sent      hypot(w, (r - F) 2 ln 2 lambda / (pi w))
///     received  w max(1, r/F)
///     both      (1/sent^2 + 1/received^2)^(-1/2)
///
/// w is the width of sinc^2(x / (lambda N)), the intensity that an evenly weighted aperture makes at its focus (Szabo,
/// Diagnostic Ultrasound Imaging, 6). What is sent is a Gaussian beam about a waist as wide (Siegman, Lasers, 17.1).
/// What is received keeps N until the aperture F/N is all in use. Both together is the product of two Gaussians: 0.626
/// lambda N at the focus, where sinc^4 has 0.638.
double focused_beam_fwhm_mm(const Settings& settings, double r_mm);

/// Most lines to either side that a focused beam's window reaches.
inline constexpr int kMostFocusedReach = 127;

/// The focused beam's window at each sample as the standard deviation in lines of a Gaussian, which is cut off at three
/// of them or kMostFocusedReach lines; wider beams are narrowed to fit.
std::vector<double> focused_beam_sigma(const ScanLines& lines, const Settings& settings);

/// How many lines to either side that is.
int focused_radius(double sigma_lines);

/// The window at one sample, of whichever beam the settings ask for: odd in number, symmetric, sum 1.
/// @param sigma_lines  of the focused beam there
std::vector<double> beam_weights_at(const Settings& settings, double sigma_lines);

/// Full width at half maximum of the slice in elevation, mm, at a distance r from the face: slice_thickness_mm, where
/// there is an elevation focus F that of a Gaussian beam about its waist, sent and received by one lens,
///
///     hypot(slice_thickness_mm, (r - F) ln 2 lambda / (pi slice_thickness_mm))      lambda = 1.54 mm MHz / frequency
///
/// (Siegman, Lasers, 17.1, both ways; Goldstein, Ultrasound in Medicine and Biology 14, 1988: slice thickness).
double slice_thickness_at_mm(const Settings& settings, double r_mm);

/// Whether there are several planes, and they lie further apart away from a focus.
bool slice_bends(const Settings& settings);

/// How much thicker the slice is far from its focus, a mm; 0 where there is none.
double slice_spread(const Settings& settings);

/// A plane of lines beside the imaging plane, which sees its share of the sound.
struct SlicePlane {
  double offset;  ///< in elevation, in thicknesses of the slice
  double weight;  ///< of I, R and the scatterers' amplitudes; all sum to 1
};

/// The slice's thickness as `slice_planes` planes: the middles of equal parts of four standard deviations, weighted by
/// the Gaussian across the beam. With an elevation focus they bend as the thickness does.
std::vector<SlicePlane> slice_planes(const Settings& settings);

/// What the speckle's envelope is multiplied by at each sample so that fully developed speckle has a mean of 1.
///
/// Where lines lie closer together than the scatterers' cells, neighbouring lines see the same scatterers and their
/// window averages less away; without this the near field of a fan would be brighter than its depth. The correlation
/// between lines a distance d apart is that of linear interpolation: the cubic B-spline in d / cell.
std::vector<double> envelope_scale(const ScanLines& lines, const Settings& settings);

}  // namespace insonate
