#pragma once

#include <cstddef>
#include <cstdint>

#include "devices/filter/sample_filters.h"

// Measures the filters on synthetic hand motions. insonate-devices bench prints the results, and the tests compare them
// with what the headers promise. The results are the same every time.

namespace insonate {

/// Effect of the filters on a sensor with 0.10 mm of white noise on each axis.
struct SmoothingFigures {
  double rest_before_mm = 0;  ///< RMS of one axis of a sensor at rest
  double rest_after_mm = 0;
  double lag_s = 0;  ///< lag behind a sinusoidal sweep at its middle, where the speed is 100 mm/s, to 0.25 ms
};
SmoothingFigures measure_smoothing(const FilterSettings& settings, double rate_hz);

/// RMS distance between the shown pose and the true pose of the probe when the newest sample is `ahead_s` old. The hand
/// moves smoothly at about 90 mm/s, with 0.10 mm of noise on each axis.
struct PredictionFigures {
  double held_mm = 0;       ///< with the newest sample as it is
  double predicted_mm = 0;  ///< with PoseHistory's prediction
};
PredictionFigures measure_prediction(double rate_hz, double ahead_s);

/// Results for impossible samples among those of a hand: single strays, and spells in the other hemisphere.
struct RejectionFigures {
  std::size_t good = 0, good_rejected = 0;
  std::size_t strays = 0, strays_rejected = 0;
  std::size_t mirrored = 0, mirrored_rejected = 0;
};
RejectionFigures measure_rejection(const FilterSettings& settings, double rate_hz);

/// Results for a hand that passes a piece of steel again and again. The steel shifts the readings towards it by up to
/// 100 mm. The tracker grades each reading by its error. Only a real tracker can show how well it grades.
struct DistortionFigures {
  double worst_before_mm = 0, worst_after_mm = 0;  ///< distance from the true position, among the samples that pass
  double rms_before_mm = 0, rms_after_mm = 0;
  double rejected = 0;  ///< fraction of the samples
};
/// Measures at 60 Hz, with the gate's limit on a scale where 1 mm is one grade.
DistortionFigures measure_distortion(std::uint32_t most_distortion);

}  // namespace insonate
