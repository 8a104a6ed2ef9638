#pragma once

#include <memory>
#include <span>

#include "scenarios/steps/step_task.h"

namespace insonate {

class TableReader;

enum class ViewUse { none, optional, required };

/// A kind of step: how the file names it, whether it takes the key 'view', and who reads the keys of its own. The
/// common ones of `step` have been read by then.
struct StepKind {
  const char* name;
  ViewUse view;
  std::shared_ptr<const StepTask> (*read)(TableReader& table, const Step& step);
};

std::span<const StepKind> step_kinds();

}  // namespace insonate
