#pragma once

#include <string>
#include <vector>

#include "devices/calibration/steps/finding_step.h"
#include "devices/calibration/steps/held_point.h"

namespace insonate {

/// A series of touches, each after a mark.
class TouchingStep : public FindingStep {
protected:
  TouchingStep(const Calibration& base, std::string title, std::size_t touches)
      : FindingStep(base, std::move(title)), touches_(touches) {}
  void marked(double time_s) override;
  void taken_back(bool all) override;
  void ask(SetupView& view) const override;
  std::size_t part() const override { return points_.size(); }
  void take(const SensorSample& sample) override;

  /// Returns the task for a touch: what to touch.
  virtual std::string task(std::size_t touch) const = 0;
  /// Returns the point (mm) that a pose gives for a touch.
  virtual glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const = 0;
  /// Computes the result from all touches.
  virtual void finish() = 0;

  std::vector<glm::dvec3> points_;

private:
  std::size_t touches_;
  HeldPoint held_;
  double wander_mm_ = 0;
};

}  // namespace insonate
