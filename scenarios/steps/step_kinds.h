#pragma once

#include <memory>
#include <span>

#include "scenarios/steps/step_task.h"

namespace insonate {

class TomlTable;

/// Whether a kind of step takes the key 'view'.
enum class ViewUse { none, optional, required };

/// A kind of step: its name in the file, whether it takes the key 'view', and the function that reads its own keys. The
/// common keys of `step` are read before.
struct StepKind {
  const char* name;
  ViewUse view;
  std::shared_ptr<const StepTask> (*read)(const TomlTable& table, const Step& step);
};

/// Returns all kinds, those of Insonate first.
std::span<const StepKind> step_kinds();

/// Adds a kind of a program's own. Call it before the first scenario is read; it invalidates what step_kinds()
/// returned. The name must be new.
void add_step_kind(const StepKind& kind);

}  // namespace insonate
