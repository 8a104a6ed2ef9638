#pragma once

#include "scenarios/steps/step_task.h"
#include "sim/files/toml_table.h"

namespace insonate {

/// kind = "set_knobs": set the machine as required. The step is done after all required settings have been right for
/// hold_s. At least one of the four is required.
struct SetKnobs : StepTask {
  std::optional<NumberRange> depth_mm;       ///< depth_mm = [90, 120]: minimum and maximum, 1 to 1000
  std::optional<NumberRange> gain_db;        ///< gain_db = [-3, 3]: -100 to 100
  std::optional<NumberRange> frequency_mhz;  ///< frequency_mhz = [5, 8]: 0.1 to 100
  std::string probe;                         ///< probe = "linear"
  double hold_s = 1;                         ///< hold_s = 1.0: 0.1 to 60; default 1

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepInput input() const override;
  StepWords words() const override {
    return {"Set right and left so for a moment, the knobs are taken by themselves."};
  }
  std::vector<Metric> metrics() const override { return {Metric::knobs_right_percent}; }
  std::vector<ActionKind> settings() const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
