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

/// Returns all kinds, those of Insonate first.
std::span<const StepKind> step_kinds();

/// Adds a kind of a program's own, before it reads the first scenario. Its name must be new.
void add_step_kind(const StepKind& kind);

}  // namespace insonate
