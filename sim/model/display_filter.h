#pragma once

#include "sim/model/settings.h"

/// Edge enhancement and speckle reduction of a picture, with Settings::edge_enhancement e and speckle_reduction s. Both
/// act on the compressed echo g of (7), 0 to 1, before the grey map. m and v are its local mean and variance, weighted
/// by a Gaussian of filter_sigma_mm() over the pixels inside the fan:
///
///     w  = min(1, v_0 / v),  1 where v = 0
///     g' = clamp(g + (e (1 - w) - s w) (g - m), 0, 1)
///
/// w is the share of the local variance that speckle alone explains: v_0 is the variance of fully developed speckle,
/// which on a logarithmic scale is the same at every brightness. So where there is only speckle, s draws g to its mean
/// and e does nothing; at an edge, e is an unsharp mask and s does nothing. This is the adaptive unsharp mask of Bamber
/// and Daft (Ultrasonics 24, 1986), with the local statistics of Lee (IEEE Transactions on Pattern Analysis and Machine
/// Intelligence 2, 1980). Sweeps and the paper's mode have neither.
namespace insonate {

/// Standard deviation of the window, in wavelengths (1.54 mm MHz / frequency_mhz): about half a grain across.
inline constexpr double kFilterSigma_wavelengths = 2;
/// The window is cut off at so many standard deviations.
inline constexpr double kFilterCut = 2;

/// Returns whether the settings ask for the filter.
inline bool is_filtered(const Settings& settings) {
  return settings.edge_enhancement > 0 || settings.speckle_reduction > 0;
}

/// Returns the standard deviation of the window, mm.
inline double filter_sigma_mm(const Settings& settings) {
  return kFilterSigma_wavelengths * 1.54 / settings.frequency_mhz;
}

/// Returns the half width of the window, pixels, at most the longer side of the picture less 1.
int filter_radius_px(const Settings& settings, double mm_per_pixel);

/// Returns v_0 for a mean of n looks (compounding.h), n >= 1. With waves it is the variance of the logarithm of a mean
/// of n independent intensities, each exponentially distributed (psi_1(n) by Abramowitz and Stegun 6.4.2 and 6.4.3):
///
///     v_0 = (10 / ln 10)^2 psi_1(n) / dynamic_range_db^2,  psi_1(n) = pi^2 / 6 - sum_{k < n} 1 / k^2
///
/// so its root is 5.57 dB for one look and 2.73 dB for three. Looks are averaged as envelopes rather than as
/// intensities, which makes it 3.54 rather than 3.49 dB for two and 2.80 dB for three. Where amplitudes count as
/// intensities (waves.h) there is one look, and v_0 is a quarter of that.
double speckle_variance(const Settings& settings, int looks);

}  // namespace insonate
