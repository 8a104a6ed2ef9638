#include "app/session/undo_history.h"

#include <glm/geometric.hpp>

#include <utility>

namespace insonate {
UndoHistory::State UndoHistory::state_of(const Session& session) {
  State state{session.machine(), std::nullopt};
  state.machine.frozen = false;  // no knob: Space lets the picture go
  state.machine.frozen_at.reset();
  if (session.holder() == Holder::learner && !session.strict()) state.pose = session.newest_pose();
  return state;
}

/// A pose comes back from the tracker with rounding errors.
bool UndoHistory::same(const State& a, const State& b) {
  constexpr double kRounding_mm = 1e-4, kRounding = 1e-6;
  if (a.machine != b.machine || a.pose.has_value() != b.pose.has_value()) return false;
  if (!a.pose) return true;
  if (glm::distance(a.pose->translation, b.pose->translation) > kRounding_mm) return false;
  for (int column = 0; column < 3; ++column)
    if (glm::distance(a.pose->rotation[column], b.pose->rotation[column]) > kRounding) return false;
  return true;
}

void UndoHistory::watch(const Session& session) {
  const State state = state_of(session);
  if (session_ != &session || attempt_ != session.attempt()) {
    session_ = &session;
    attempt_ = session.attempt();
    settled_ = latest_ = state;
    past_.clear();
    future_.clear();
    return;
  }
  if (!same(std::exchange(latest_, state), state)) moved_s_ = session.now_s();
  // A log changes the machine by itself, and another hand has another pose.
  if (session.source().recording() || latest_.pose.has_value() != settled_.pose.has_value()) settled_ = latest_;
  if (session.now_s() - moved_s_ > kStill_s) settle();
}

/// Remembers what has been moved since the last step.
void UndoHistory::settle() {
  if (same(latest_, settled_)) return;
  past_.push_back(std::exchange(settled_, latest_));
  if (past_.size() > kMax) past_.erase(past_.begin());
  future_.clear();
}

std::string UndoHistory::undo(Session& session) {
  settle();
  return past_.empty() ? "Nothing to undo" : go(session, past_, future_);
}

std::string UndoHistory::redo(Session& session) {
  settle();
  return future_.empty() ? "Nothing to do again" : go(session, future_, past_);
}

std::string UndoHistory::go(Session& session, std::vector<State>& from, std::vector<State>& to) {
  const State target = from.back();
  Machine unfrozen = session.machine();
  unfrozen.frozen = false;
  unfrozen.frozen_at.reset();
  const std::vector<Action> actions = actions_between(unfrozen, target.machine);
  for (const Action& action : actions)
    if (std::string why_not = session.why_not(action.kind); !why_not.empty()) return why_not;
  from.pop_back();
  to.push_back(settled_);
  settled_ = latest_ = target;
  moved_s_ = session.now_s();
  for (const Action& action : actions) session.set(action);
  if (target.pose && session.holder() == Holder::learner)
    session.move_probe([&](const ProbeHand&, const Pose&) { return target.pose; });
  return "";
}

}  // namespace insonate
