#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/session.h"

namespace insonate {

/// What the learner does with the step of the exam under way as a whole: answers, takes hints, turns to another step
/// and goes on. Hands actions to the session. Knows no screen.
class StepControls {
public:
  /// A step that may be turned to, where the order is free.
  struct Turn {
    std::size_t step;
    std::string title;
    bool current, ended, can_turn;
  };

  /// To be called after each Session::advance().
  void see(const Session& session);

  /// There is a step under way that takes something from the learner: none of a log, which brings its own actions.
  static bool active(const Session& session);

  /// The question under way; nullptr for none.
  const AnswerInput* question() const { return std::get_if<AnswerInput>(&input_); }
  /// What is answered when it is confirmed: of a choice its text, else what is typed. The session hears nothing of it
  /// before.
  void draft(const std::string& answer) { draft_ = answer; }
  const std::string& draft() const { return draft_; }
  /// Whether that can be given: a choice or a text is there, a number is one.
  bool can_answer() const;
  /// Gives it; the first answer counts.
  void answer(Session& session);

  /// Ends the step; a step that would not count as done is asked about first, and ended at the second time. Of a
  /// question that can be answered this is the answer; else nothing happens.
  void go_on(Session& session);
  /// Whether it was asked once.
  bool asks_again() const { return asks_again_; }

  /// What the next hint costs in points; empty when there is none left.
  static std::optional<double> hint_cost(const Session& session);
  void take_hint(Session& session);

  /// Empty where the order is fixed.
  static std::vector<Turn> turns(const Session& session);
  void turn_to(Session& session, std::size_t step);

  /// The settings that the step under way asks for, beside the machine's; empty if it asks for none.
  std::vector<SettingsInput::Setting> settings(const Session& session) const;

private:
  void tell(Session& session, const Action& action);

  int attempt_ = 0;
  std::optional<std::size_t> step_;
  StepInput input_;  ///< of the step under way
  std::string draft_;
  bool asks_again_ = false;
  bool told_ = false;  ///< something that the session has not taken yet: pressed twice, it would reach the next step
};

}  // namespace insonate
