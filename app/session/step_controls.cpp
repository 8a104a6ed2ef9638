#include "app/session/step_controls.h"

#include <utility>

namespace insonate {
namespace {

const Step& step_of(const Session& session) {
  return session.runner()->scenario().steps[session.runner()->live().step];
}

}  // namespace

bool StepControls::active(const Session& session) {
  return session.runner() && !session.result() && !session.runner()->live().finished && !session.source().recording();
}

void StepControls::see(const Session& session) {
  if (!session.latest_samples().empty()) acted_ = false;
  const auto step = active(session) ? std::optional(session.runner()->live().step) : std::nullopt;
  if (step && session.runner()->live().counts_as_done) asks_again_ = false;
  if (session.attempt() == attempt_ && step == step_) return;
  attempt_ = session.attempt();
  step_ = step;
  input_ = step ? step_of(session).task->input() : StepInput();
  draft_.clear();
  asks_again_ = acted_ = false;
}

void StepControls::record(Session& session, const Action& action) {
  if (!std::exchange(acted_, true)) session.act(action);
}

bool StepControls::can_answer() const {
  return question() && question()->accepts(draft_);
}

void StepControls::answer(Session& session) {
  if (can_answer()) record(session, {ActionKind::answer, {}, draft_});
}

void StepControls::go_on(Session& session) {
  if (!active(session) || !session.runner()->live().started) return;
  if (question()) return answer(session);
  if (!session.runner()->live().counts_as_done && !std::exchange(asks_again_, true)) return;
  asks_again_ = false;
  record(session, {ActionKind::go_on});
}

std::optional<double> StepControls::hint_cost(const Session& session) {
  if (!active(session) || session.strict() || session.runner()->live().hints_left == 0) return std::nullopt;
  const Step& step = step_of(session);
  return step.counts ? step.hints[session.runner()->live().hints.size()].cost : 0;
}

void StepControls::take_hint(Session& session) {
  if (hint_cost(session)) record(session, {ActionKind::hint});
}

std::vector<StepControls::Turn> StepControls::turns(const Session& session) {
  std::vector<Turn> found;
  if (!active(session)) return found;
  const Runner& runner = *session.runner();
  if (runner.scenario().order != Scenario::Order::free) return found;
  const std::vector<Step>& steps = runner.scenario().steps;
  for (std::size_t i = 0; i < steps.size(); ++i)
    found.push_back({i, steps[i].title, i == runner.live().step, runner.has_ended(i), runner.can_go_to(i)});
  return found;
}

void StepControls::turn_to(Session& session, std::size_t step) {
  if (active(session) && session.runner()->can_go_to(step))
    record(session, {ActionKind::go_to, {}, session.runner()->scenario().steps[step].name});
}

std::vector<SettingsInput::Setting> StepControls::settings(const Session& session) const {
  const auto* asked = std::get_if<SettingsInput>(&input_);
  return asked ? asked->compare(session.machine()) : std::vector<SettingsInput::Setting>();
}

}  // namespace insonate
