#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/calibration/sensor_sample.h"
#include "devices/tracker.h"

namespace insonate {

/// Reads the raw poses of a tracker's sensor. It owns a tracker that does not place the probe in the patient, so that
/// the poses it polls are the sensor's in the tracker's frame, and gives them their own type: no other code takes a
/// sensor's pose for a probe's.
class SensorTracker {
public:
  /// @param raw  a tracker opened with sensor_uri(), or a replay of a recording of such a tracker
  explicit SensorTracker(std::unique_ptr<Tracker> raw) : raw_(std::move(raw)) {}

  /// Appends the samples up to `now_s`, as Tracker::poll() does.
  void poll(double now_s, std::vector<SensorSample>& samples);

  /// Returns the tracker for everything but its samples.
  const Tracker& tracker() const { return *raw_; }
  Tracker& tracker() { return *raw_; }

private:
  std::unique_ptr<Tracker> raw_;
  std::vector<ProbeSample> polled_;  ///< kept to reuse its memory
};

/// Returns a pose sample of a tracker that does not place the probe in the patient as what it is.
SensorSample sensor_sample(const ProbeSample& raw);

}  // namespace insonate
