#pragma once

#include <span>

namespace insonate {

/// The mean of the envelope of fully developed speckle over its standard deviation: sqrt(pi / (4 - pi)), that of a
/// Rayleigh distribution (Wagner et al., IEEE Trans. Sonics Ultrasonics 30, 1983).
inline constexpr double kRayleighSnr = 1.91305838;

/// Returns the mean over the standard deviation. Needs two values that differ.
double envelope_snr(std::span<const double> envelope);

/// How far an envelope is from a Rayleigh distribution of the same mean square.
struct RayleighTest {
  double distance = 0;   ///< of Kolmogorov and Smirnov: the largest difference of the cumulative distributions
  double statistic = 0;  ///< `distance`, scaled so that its distribution does not depend on the number of values
  /// The 5 % point of `statistic`. Squares of Rayleigh numbers are exponential, and for an exponential distribution
  /// whose mean comes from the values themselves it is this (Stephens, J. Amer. Statist. Assoc. 69, 1974).
  static constexpr double kLimit = 1.094;

  bool is_rayleigh() const { return statistic <= kLimit; }
};

/// Tests values for a Rayleigh distribution at the level of 5 %. They must be independent: of places further apart than
/// a resolution cell.
RayleighTest rayleigh_test(std::span<const double> envelope);

}  // namespace insonate
