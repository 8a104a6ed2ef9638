#include "scenarios/machine.h"

#include <algorithm>
#include <stdexcept>

#include "sim/model/effects.h"

namespace insonate {

const Probe& Machine::transducer() const {
  const Probe* found = find_probe(probe);
  if (!found) throw std::logic_error("the machine has no probe yet");
  return *found;
}

void Machine::choose(const std::string& name) {
  const Probe* chosen = find_probe(name);
  if (!chosen) return;
  probe = name;
  depth_mm = chosen->depth_mm;
  frequency_mhz = chosen->frequency_mhz;
}

bool Machine::refuses(ActionKind kind) const {
  return frozen && (kind == ActionKind::probe || kind == ActionKind::depth || kind == ActionKind::frequency ||
                    kind == ActionKind::compounding || kind == ActionKind::effect);
}

void Machine::apply(const Action& action, const std::optional<Pose>& last_valid) {
  if (refuses(action.kind)) return;
  switch (action.kind) {
    case ActionKind::probe:
      choose(action.text);
      break;
    case ActionKind::depth:
      depth_mm = std::clamp(action.numbers[0], kMinDepth_mm, kMaxDepth_mm);
      break;
    case ActionKind::frequency:
      frequency_mhz = action.numbers[0];
      break;
    case ActionKind::gain:
      gain_db = action.numbers[0];
      break;
    case ActionKind::dynamic_range:
      dynamic_range_db = std::clamp(action.numbers[0], kMinDynamicRange_db, kMaxDynamicRange_db);
      break;
    case ActionKind::time_gain:
      time_gain_db.at(std::size_t(action.slot() - 1)) =
          std::clamp(action.numbers[1], -kMaxTimeGain_db, kMaxTimeGain_db);
      break;
    case ActionKind::compounding:
      steering_angles = 2 * (int(std::clamp(action.numbers[0], 1.0, double(kMaxSteeringAngles))) / 2) + 1;
      break;
    case ActionKind::persistence:
      persistence = std::clamp(action.numbers[0], 0.0, kMaxPersistence);
      break;
    case ActionKind::edge_enhancement:
      edge_enhancement = std::clamp(action.numbers[0], 0.0, kMaxEdgeEnhancement);
      break;
    case ActionKind::speckle_reduction:
      speckle_reduction = std::clamp(action.numbers[0], 0.0, 1.0);
      break;
    case ActionKind::effect:
      if (action.text.empty()) effects.clear();
      if (const Effect* effect = find_effect(action.text))
        effects[action.text] = std::clamp(action.numbers[0], effect->least, effect->most);
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

std::vector<Action> actions_between(const Machine& from, const Machine& to) {
  std::vector<Action> actions;
  Machine machine = from;
  const auto set = [&](ActionKind kind, double value) { actions.push_back({kind, {value}}); };
  if (machine.frozen) actions.push_back({ActionKind::unfreeze});
  if (machine.probe != to.probe) {
    actions.push_back({ActionKind::probe, {}, to.probe});
    machine.choose(to.probe);
  }
  if (machine.depth_mm != to.depth_mm) set(ActionKind::depth, to.depth_mm);
  if (machine.frequency_mhz != to.frequency_mhz) set(ActionKind::frequency, to.frequency_mhz);
  if (machine.gain_db != to.gain_db) set(ActionKind::gain, to.gain_db);
  if (machine.dynamic_range_db != to.dynamic_range_db) set(ActionKind::dynamic_range, to.dynamic_range_db);
  if (machine.steering_angles != to.steering_angles) set(ActionKind::compounding, to.steering_angles);
  if (machine.persistence != to.persistence) set(ActionKind::persistence, to.persistence);
  if (machine.edge_enhancement != to.edge_enhancement) set(ActionKind::edge_enhancement, to.edge_enhancement);
  if (machine.speckle_reduction != to.speckle_reduction) set(ActionKind::speckle_reduction, to.speckle_reduction);
  if (std::ranges::any_of(machine.effects, [&](const auto& each) { return !to.effects.contains(each.first); })) {
    actions.push_back({ActionKind::effect});
    machine.effects.clear();
  }
  for (const auto& [name, value] : to.effects)
    if (const auto now = machine.effects.find(name); now == machine.effects.end() || now->second != value)
      actions.push_back({ActionKind::effect, {value}, name});
  for (std::size_t i = 0; i < to.time_gain_db.size(); ++i)
    if (machine.time_gain_db[i] != to.time_gain_db[i])
      actions.push_back({ActionKind::time_gain, {double(i + 1), to.time_gain_db[i]}});
  if (to.frozen) actions.push_back({ActionKind::freeze});
  return actions;
}

Machine starting_machine(const Scenario& scenario, const Case& subject) {
  Machine machine;
  machine.choose(probes().front().name);
  for (const Step& step : scenario.steps) {
    const ReferenceView* view = subject.find_view(step.view);
    if (!view || !find_probe(view->probe)) continue;
    machine.choose(view->probe);
    machine.depth_mm = std::clamp(view->depth_mm, Machine::kMinDepth_mm, Machine::kMaxDepth_mm);
    break;
  }
  return machine;
}

}  // namespace insonate
