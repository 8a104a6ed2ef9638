#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/session.h"

namespace insonate {

/// Takes back what a person has done to the machine's knobs and, with the probe in their own hand, to its pose. It
/// watches the session, so that no control has to report what it does. A change counts as one from when things begin
/// to move until they have stood still for kStill_s: a drag is one step, however long.
///
/// Going back is an action like any other: it is logged, and the machine's and the exam's rules hold for it. An exam
/// that counts has no undo of the probe, and a replayed log's own changes are not a person's.
class UndoHistory {
public:
  static constexpr double kStill_s = 0.4;
  static constexpr std::size_t kMax = 100;  ///< steps that are remembered

  /// To be called after each Session::advance().
  void watch(const Session& session);

  /// Goes one step back, or forward again. Returns a sentence on why it does not; empty if it does.
  std::string undo(Session& session);
  std::string redo(Session& session);

private:
  struct State {
    Machine machine;
    std::optional<Pose> pose;  ///< of the probe in the person's hand
  };

  static State state_of(const Session& session);
  static bool same(const State& a, const State& b);
  void settle();
  std::string go(Session& session, std::vector<State>& from, std::vector<State>& to);

  const Session* session_ = nullptr;
  int attempt_ = 0;
  State settled_, latest_;
  double moved_s_ = 0;  ///< when `latest_` last changed
  std::vector<State> past_, future_;
};

}  // namespace insonate
