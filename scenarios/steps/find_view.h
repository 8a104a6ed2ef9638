#pragma once

#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"

namespace insonate {

class TomlTable;

/// kind = "find_view": show the step's view and hold it.
struct FindView : StepTask {
  double hold_s = 1;  ///< hold_s = 1.0: how long the picture has to stay within all tolerances, 0.1 to 60
  std::vector<Tolerance> tolerance;  ///< `[step.tolerance]`, one or more

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepWords words() const override;
  bool holds_view() const override { return true; }
  std::vector<Metric> metrics() const override { return {Metric::longest_hold_s}; }
  bool judges_picture() const override { return true; }
  std::vector<ActionKind> settings() const override;
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<Mistake>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
