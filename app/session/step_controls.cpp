#include "app/session/step_controls.h"

#include <utility>

#include "scenarios/steps/question.h"
#include "scenarios/steps/set_knobs.h"
#include "scenarios/words.h"
#include "sim/probe/probe.h"

namespace insonate {
namespace {

const Step& step_of(const Session& session) {
  return session.runner()->scenario().steps[session.runner()->live().step];
}

StepControls::Knob knob(const char* name, const Range& asked, double is, double per_unit, const char* unit) {
  return {name, short_number(asked.least / per_unit) + " to " + short_number(asked.most / per_unit) + " " + unit,
          short_number(is / per_unit) + " " + unit, is >= asked.least && is <= asked.most};
}

}  // namespace

bool StepControls::active(const Session& session) {
  return session.runner() && !session.result() && !session.runner()->live().finished && !session.source().recording();
}

void StepControls::see(const Session& session) {
  if (!session.latest_samples().empty()) told_ = false;
  const auto step = active(session) ? std::optional(session.runner()->live().step) : std::nullopt;
  if (session.attempt() == attempt_ && step == step_) return;
  attempt_ = session.attempt();
  step_ = step;
  question_ = step ? dynamic_cast<const Question*>(step_of(session).task.get()) : nullptr;
  draft_.clear();
  asks_again_ = told_ = false;
}

void StepControls::tell(Session& session, const Action& action) {
  if (!std::exchange(told_, true)) session.act(action);
}

bool StepControls::can_answer() const {
  if (!question_) return false;
  return question_->answer == Question::Answer::number ? Question::number_in(draft_).has_value() : !draft_.empty();
}

void StepControls::answer(Session& session) {
  if (can_answer()) tell(session, {ActionKind::answer, {}, draft_});
}

void StepControls::go_on(Session& session) {
  if (!active(session) || !session.runner()->live().started) return;
  if (question_) return answer(session);
  if (!session.runner()->live().enough && !std::exchange(asks_again_, true)) return;
  asks_again_ = false;
  tell(session, {ActionKind::go_on});
}

std::optional<double> StepControls::hint_cost(const Session& session) {
  if (!active(session) || session.strict() || session.runner()->live().hints_left == 0) return std::nullopt;
  const Step& step = step_of(session);
  return step.counts ? step.hints[session.runner()->live().hints.size()].cost : 0;
}

void StepControls::take_hint(Session& session) {
  if (hint_cost(session)) tell(session, {ActionKind::hint});
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
    tell(session, {ActionKind::go_to, {}, session.runner()->scenario().steps[step].name});
}

std::vector<StepControls::Knob> StepControls::knobs(const Session& session) {
  std::vector<Knob> found;
  const auto* asked = active(session) ? dynamic_cast<const SetKnobs*>(step_of(session).task.get()) : nullptr;
  if (!asked) return found;
  const Machine& machine = session.machine();
  const Probe* probe = find_probe(asked->probe);
  if (probe) found.push_back({"Probe", probe->title, machine.transducer().title, machine.probe == probe->name});
  if (asked->depth_mm) found.push_back(knob("Depth", *asked->depth_mm, machine.depth_mm, 10, "cm"));
  if (asked->gain_db) found.push_back(knob("Gain", *asked->gain_db, machine.gain_db, 1, "dB"));
  if (asked->frequency_mhz) found.push_back(knob("Frequency", *asked->frequency_mhz, machine.frequency_mhz, 1, "MHz"));
  return found;
}

}  // namespace insonate
