#pragma once

#include <cstddef>
#include <cstdint>

#include "devices/filter/sample_filters.h"

// What the filters do to made-up hands, in figures: insonate-devices bench prints them, and the tests hold them against
// what the headers promise. The same every time.

namespace insonate {

/// A sensor with 0.10 mm of white noise on each axis, before and after the filters.
struct SmoothingFigures {
  double rest_before_mm = 0;  ///< RMS of an axis of a sensor that lies still
  double rest_after_mm = 0;
  double lag_s = 0;  ///< behind a sweep to and fro of 100 mm/s at its middle, to 0.25 ms
};
SmoothingFigures measure_smoothing(const FilterSettings& settings, double rate_hz);

/// How far the shown pose is from where the probe is when the newest sample is `ahead_s` old, RMS, along a hand's
/// smooth way at about 90 mm/s with 0.10 mm of noise on each axis.
struct PredictionFigures {
  double held_mm = 0;       ///< the newest sample as it is
  double predicted_mm = 0;  ///< PoseHistory's answer
};
PredictionFigures measure_prediction(double rate_hz, double ahead_s);

/// Samples that no hand has made, put among a hand's: single ones elsewhere, and spells of the other hemisphere.
struct RejectionFigures {
  std::size_t good = 0, good_rejected = 0;
  std::size_t strays = 0, strays_rejected = 0;
  std::size_t mirrored = 0, mirrored_rejected = 0;
};
RejectionFigures measure_rejection(const FilterSettings& settings, double rate_hz);

/// A hand that passes a piece of steel again and again, which draws the readings towards it by up to 100 mm, and a
/// tracker that grades each reading by how far it is off. How well a real one does that, only it can tell.
struct DistortionFigures {
  double worst_before_mm = 0, worst_after_mm = 0;  ///< off where the probe is, among the samples that are handed over
  double rms_before_mm = 0, rms_after_mm = 0;
  double rejected = 0;  ///< share of the samples
};
/// At 60 Hz, with the gate's limit on a scale where a millimetre is one grade.
DistortionFigures measure_distortion(std::uint32_t most_distortion);

}  // namespace insonate
