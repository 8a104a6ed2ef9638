#pragma once

#include <span>
#include <vector>

#include "devices/calibration/outcome.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// Values at even steps of a clock.
struct Signal {
  double begin_s = 0;
  double step_s = 0.005;
  std::vector<double> values;
};

struct LagFit {
  double lag_s = 0;        ///< how much later the one signal shows what the other shows; negative: earlier
  double correlation = 0;  ///< of the signals at that lag, from -1 to 1
};

struct KnockLag {
  double lag_s = 0;     ///< how much later the tracker shows a knock than the key did
  double spread_s = 0;  ///< standard deviation of the single knocks about it
  std::size_t knocks = 0;
};

inline constexpr double kLeastLagS = -0.1, kMostLagS = 0.5;
inline constexpr double kLeastCorrelation = 0.3;
inline constexpr std::size_t kLeastKnocks = 8;

/// How much `late` lags behind `early`, two signals of one kind and step on one clock (the speed of two sensors on one
/// hand, say): the peak of their normalised cross-correlation from kLeastLagS to kMostLagS, refined by a parabola.
/// Refused when they hardly correlate, or when another lag explains them nearly as well, as with a steady rhythm.
/// Throws std::invalid_argument when the steps differ.
Outcome<LagFit> lag_between(const Signal& late, const Signal& early);

/// How sharply the probe is stopped, mm/s^2: the loss of its speed, smoothed over 15 ms. Samples that are not ok are
/// bridged. Empty with fewer than two usable samples.
Signal stopping_of(std::span<const PoseSample> samples);

/// The lag of a tracker, measured with what every lab has: a key (the space bar, or a button of the tracker) is struck
/// with the probe itself, several times and not in a steady rhythm, and the times of the key are compared with those at
/// which the tracker shows the probe being stopped. Both on the tracker's clock. What is measured is from the blow to
/// the sample's time stamp, less the delay of the keyboard (5 to 20 ms): no delay of drawing or of the screen. Refused
/// with fewer than kLeastKnocks, or as lag_between() refuses.
Outcome<KnockLag> knock_lag(std::span<const PoseSample> samples, std::span<const double> key_times_s);

}  // namespace insonate
