#include "scenarios/machine.h"

#include <algorithm>

#include "sim/probe/probe.h"

namespace insonate {

void Machine::choose(const std::string& name) {
  const Probe* chosen = find_probe(name);
  if (!chosen) return;
  probe = name;
  depth_mm = chosen->depth_mm;
  frequency_mhz = chosen->frequency_mhz;
}

void Machine::apply(const Action& action, const std::optional<Pose>& last_valid) {
  switch (action.kind) {
    case ActionKind::probe:
      choose(action.text);
      break;
    case ActionKind::depth:
      depth_mm = std::clamp(action.numbers[0], kLeastDepth_mm, kMostDepth_mm);
      break;
    case ActionKind::frequency:
      frequency_mhz = action.numbers[0];
      break;
    case ActionKind::gain:
      gain_db = action.numbers[0];
      break;
    case ActionKind::freeze:
      if (!frozen) frozen_at = last_valid;
      frozen = true;
      break;
    case ActionKind::unfreeze:
      frozen = false;
      frozen_at.reset();
      break;
    default:
      break;
  }
}

Machine starting_machine(const Scenario& scenario, const Case& subject) {
  Machine machine;
  machine.choose(probes().front().name);
  for (const Step& step : scenario.steps) {
    const ReferenceView* view = subject.find_view(step.view);
    if (!view || !find_probe(view->probe)) continue;
    machine.choose(view->probe);
    machine.depth_mm = std::clamp(view->depth_mm, Machine::kLeastDepth_mm, Machine::kMostDepth_mm);
    break;
  }
  return machine;
}

}  // namespace insonate
