#include "scenarios/steps/step_kinds.h"

#include <vector>

#include "scenarios/steps/find_view.h"
#include "scenarios/steps/free_scan.h"
#include "scenarios/steps/mark_point.h"
#include "scenarios/steps/measure.h"
#include "scenarios/steps/question.h"
#include "scenarios/steps/set_knobs.h"
#include "scenarios/steps/sweep.h"

namespace insonate {

namespace {

std::vector<StepKind>& all_kinds() {
  static std::vector<StepKind> kinds{
      StepKind{"find_view", ViewUse::required, FindView::read},
      StepKind{"sweep", ViewUse::none, Sweep::read},
      StepKind{"set_knobs", ViewUse::none, SetKnobs::read},
      StepKind{"measure", ViewUse::optional, Measure::read},
      StepKind{"mark_point", ViewUse::none, MarkPoint::read},
      StepKind{"label_structures", ViewUse::none, LabelStructures::read},
      StepKind{"question", ViewUse::none, Question::read},
      StepKind{"free_scan", ViewUse::none, FreeScan::read},
  };
  return kinds;
}

}  // namespace

std::span<const StepKind> step_kinds() {
  return all_kinds();
}

void add_step_kind(const StepKind& kind) {
  all_kinds().push_back(kind);
}

}  // namespace insonate
