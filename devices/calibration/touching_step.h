#pragma once

#include <string>
#include <vector>

#include "devices/calibration/held_point.h"
#include "devices/calibration/setup_step.h"

namespace insonate {

/// A row of touches, each after a mark.
class TouchingStep : public SetupStep {
public:
  void mark(double time_s) override;
  void undo() override;
  SetupView view() const override;

protected:
  TouchingStep(const Calibration& base, std::string title, std::size_t touches)
      : SetupStep(base), title_(std::move(title)), touches_(touches) {}
  void take(const PoseSample& sample) override;

  /// What to touch, as a task.
  virtual std::string task(std::size_t touch) const = 0;
  /// The point that a pose says of a touch, mm.
  virtual glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const = 0;
  /// Why the touches cannot be used, or nothing when result() has what they say.
  virtual std::string finish() = 0;
  virtual std::string result() const = 0;

  std::vector<glm::dvec3> points_;

private:
  std::string title_;
  std::size_t touches_;
  HeldPoint held_;
  double wander_mm_ = 0;
  bool done_ = false;
  std::string refusal_;
};

}  // namespace insonate
