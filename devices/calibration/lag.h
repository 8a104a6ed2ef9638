#pragma once

#include <span>
#include <vector>

#include "devices/calibration/outcome.h"
#include "devices/calibration/sensor_sample.h"

namespace insonate {

/// Values at equal time steps.
struct Signal {
  double begin_s = 0;
  double step_s = 0.005;
  std::vector<double> values;
};

/// The result of lag_between().
struct LagFit {
  double lag_s = 0;        ///< delay of the late signal behind the early one; negative: it is ahead
  double correlation = 0;  ///< correlation of the signals at that lag, from -1 to 1
};

/// The result of knock_lag().
struct KnockLag {
  double lag_s = 0;     ///< delay between a knock at the key and the same knock in the tracker's samples
  double spread_s = 0;  ///< standard deviation of the single knocks about `lag_s`
  std::size_t knocks = 0;
};

inline constexpr double kMinLag_s = -0.1, kMaxLag_s = 0.5;
inline constexpr double kMinCorrelation = 0.3;
inline constexpr std::size_t kMinKnocks = 8;

/// Returns the lag of `late` behind `early`: two signals of the same kind and step on one clock, such as the speeds of
/// two sensors on one hand. The lag is the peak of their normalised cross-correlation from kMinLag_s to kMaxLag_s,
/// refined by a parabola. Refused if the correlation is too weak, or if another lag explains them almost as well, as
/// with a steady rhythm. Throws std::invalid_argument if the steps differ.
Outcome<LagFit> lag_between(const Signal& late, const Signal& early);

/// Returns the deceleration of the probe in mm/s^2: the loss of its speed, smoothed over 15 ms. It interpolates over
/// samples that are not ok. Empty with fewer than two usable samples.
Signal stopping_of(std::span<const SensorSample> samples);

/// Measures the lag of a tracker with what every lab has. The user strikes a key (the space bar, or a button of the
/// tracker) with the probe itself, several times in an uneven rhythm. The times of the key are compared with the times
/// at which the tracker shows that the probe stops, both on the tracker's clock. The result is the time from the knock
/// to the sample's time stamp, less the delay of the keyboard (5 to 20 ms). It does not include the delay of drawing or
/// of the screen. Refused with fewer than kMinKnocks, or where lag_between() refuses.
Outcome<KnockLag> knock_lag(std::span<const SensorSample> samples, std::span<const double> key_times_s);

}  // namespace insonate
