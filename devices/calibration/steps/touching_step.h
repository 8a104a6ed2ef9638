#pragma once

#include <string>
#include <vector>

#include "devices/calibration/steps/finding_step.h"
#include "devices/calibration/steps/held_point.h"

namespace insonate {

/// A row of touches, each after a mark.
class TouchingStep : public FindingStep {
protected:
  TouchingStep(const Calibration& base, std::string title, std::size_t touches)
      : FindingStep(base, std::move(title)), touches_(touches) {}
  void marked(double time_s) override;
  void taken_back(bool all) override;
  void ask(SetupView& view) const override;
  std::size_t part() const override { return points_.size(); }
  void take(const PoseSample& sample) override;

  /// What to touch, as a task.
  virtual std::string task(std::size_t touch) const = 0;
  /// The point that a pose says of a touch, mm.
  virtual glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const = 0;
  /// Settles what the touches say.
  virtual void finish() = 0;

  std::vector<glm::dvec3> points_;

private:
  std::size_t touches_;
  HeldPoint held_;
  double wander_mm_ = 0;
};

}  // namespace insonate
