#pragma once

#include "scenarios/steps/step_task.h"

namespace insonate {

class TomlTable;

/// kind = "free_scan": scan freely until going on or until the time runs out; both count as done. Only the motion is
/// measured. This kind has no keys of its own.
struct FreeScan : StepTask {
  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepWords words() const override { return {"Go on when you are ready.", "Looking around", "", false}; }
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
