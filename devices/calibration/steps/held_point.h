#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "devices/calibration/sensor_sample.h"
#include "devices/calibration/still_point.h"

namespace insonate {

/// Reads a point of the probe that is held still for kRead_s after a mark.
class HeldPoint {
public:
  static constexpr double kRead_s = 0.5;

  /// @param point_of  returns the point (mm) for a usable pose
  void begin(double time_s, std::function<glm::dvec3(const Pose&)> point_of) {
    end_s_ = time_s + kRead_s;
    point_of_ = std::move(point_of);
    readings_.clear();
    reading_ = true;
  }
  void stop() { reading_ = false; }
  bool reading() const { return reading_; }
  /// Returns the point from the readings so far. Refused if these are too few or wandered too far.
  Outcome<StillPoint> so_far() const { return still_point(readings_); }

  /// Returns the point, or the refusal, once it was read long enough; empty before.
  std::optional<Outcome<StillPoint>> take(const SensorSample& sample) {
    if (!reading_) return std::nullopt;
    if (sample.time_s < end_s_) {
      if (sample.status == PoseStatus::ok) readings_.push_back(point_of_(sample.tracker_from_sensor));
      return std::nullopt;
    }
    reading_ = false;
    return still_point(readings_);
  }

private:
  double end_s_ = -std::numeric_limits<double>::infinity();
  std::function<glm::dvec3(const Pose&)> point_of_;
  std::vector<glm::dvec3> readings_;
  bool reading_ = false;
};

}  // namespace insonate
