#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/session.h"

namespace insonate {

/// The learner's controls for the current step of an exam: answering, taking hints, choosing another step, going on.
/// Passes actions to the session. Does not depend on a screen.
class StepControls {
public:
  /// A step that the learner may choose, where the order is free.
  struct Turn {
    std::size_t step;
    std::string title;
    bool current, ended, can_turn;
  };

  /// Call it after each Session::advance().
  void see(const Session& session);

  /// Returns whether a step accepts input from the learner. A log brings its own actions, so its steps do not.
  static bool active(const Session& session);

  /// Returns the question of the current step; nullptr if it asks none.
  const AnswerInput* question() const { return std::get_if<AnswerInput>(&input_); }
  /// Sets the answer that answer() will give: the text of a choice, or what was typed. The session does not get it
  /// before.
  void draft(const std::string& answer) { draft_ = answer; }
  const std::string& draft() const { return draft_; }
  /// Returns whether the draft can be given: it is not empty, and a number where one is asked for.
  bool can_answer() const;
  /// Gives the draft as the answer. The first answer counts.
  void answer(Session& session);

  /// Ends the step. If it would not count as done, the first call only asks (asks_again()), and the second one ends it.
  /// For a question, gives the answer if there is one, and does nothing otherwise.
  void go_on(Session& session);
  /// Takes back what go_on() has asked.
  void stay() { asks_again_ = false; }
  /// Returns whether go_on() has asked once, and the step would still not count as done.
  bool asks_again() const { return asks_again_; }

  /// Returns what the next hint costs, points; nothing if none is left.
  static std::optional<double> hint_cost(const Session& session);
  void take_hint(Session& session);

  /// Returns the steps that the learner may choose from; empty where the order is fixed.
  static std::vector<Turn> turns(const Session& session);
  void turn_to(Session& session, std::size_t step);

  /// Returns the settings that the current step asks for, beside the machine's; empty if it asks for none.
  std::vector<SettingsInput::Setting> settings(const Session& session) const;

private:
  void record(Session& session, const Action& action);

  int attempt_ = 0;
  std::optional<std::size_t> step_;
  StepInput input_;  ///< of the current step
  std::string draft_;
  bool asks_again_ = false;
  bool acted_ = false;  ///< an action waits for the next sample; a second one would go to the next step
};

}  // namespace insonate
