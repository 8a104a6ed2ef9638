#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/annotations.h"
#include "app/session/session.h"

namespace insonate {

/// Places annotations in the frozen picture: calipers and ellipses, and points or names where a step asks for them.
/// Takes pointer positions in mm of the imaging plane and passes actions to the session. Does not depend on the screen.
///
/// A caliper takes two clicks, or one drag from end to end. The axis of an ellipse is placed the same way; a third
/// click sets its width. Placed annotations are grabbed by their ends, their point or their name. For a name, the place
/// is clicked first and named afterwards.
///
/// In a `measure` step only the step's own measurements can be placed, slot by slot. Elsewhere anything may be
/// measured, and no step scores it. All annotations disappear when the step or the attempt changes. Those that no step
/// scores also disappear when the picture changes.
class PictureTools {
public:
  enum class Tool { distance, ellipse, point, label };
  static constexpr double kMin_mm = 0.5;  ///< a shorter caliper is an accidental click

  /// To be called after each Session::advance().
  void see(const Session& session);

  /// Returns whether a frozen picture accepts the pointer. False in an exam that a log plays: it places the annotations
  /// of its recording.
  static bool ready(const Session& session);
  Tool tool() const { return tool_; }
  /// Returns whether the learner chooses the tool because no step prescribes it.
  bool free_choice() const { return !measuring() && tool_ != Tool::point && tool_ != Tool::label; }
  /// Selects distance or ellipse. Does nothing if free_choice() is false.
  void choose(Tool tool);

  /// Returns what the current step measures; nullptr if it measures nothing.
  const MeasureInput* measuring() const { return std::get_if<MeasureInput>(&input_); }
  /// Returns whether the current step asks for names.
  bool labelling() const { return std::holds_alternative<LabelInput>(input_); }
  /// Returns whether all that the current step asks to place is placed, and nothing was begun or chosen since. False
  /// in a step that asks for none.
  bool has_all() const;
  /// Returns the slot of the next caliper.
  int slot() const;
  void choose_slot(int slot);
  /// Returns the name of a slot: in a measuring step after its target, elsewhere after what it measures.
  std::string slot_name(int slot) const;
  /// Returns the combined value of the measuring step once all is placed: "Ratio 1.25", "Volume 123 ml". Empty for
  /// single values.
  std::string total_text() const;
  /// Returns the names to give, in an order that reveals nothing.
  const std::vector<std::string>& names() const { return names_; }
  /// Names the place that was clicked.
  void name_place(Session& session, const std::string& name);
  const std::optional<glm::dvec2>& unnamed_place() const { return place_; }

  /// Pointer events, in mm of the plane.
  /// @param reach_mm  the largest distance from a handle at which the pointer grabs it
  void press(Session& session, const glm::dvec2& at, double reach_mm);
  void move(const glm::dvec2& at);
  void release(Session& session, const glm::dvec2& at, double reach_mm);
  /// Discards what is being placed. Returns whether there was anything.
  bool cancel();
  /// Discards what is being placed; otherwise undoes the last action.
  void undo(Session& session);
  /// Removes all annotations.
  void clear(Session& session);
  bool can_undo() const { return drawing_ || place_ || !done_.empty(); }
  /// Returns whether the last thing that the learner did is undone by undo(): it is being placed, or was placed in the
  /// frozen picture, and the machine is as it was then.
  bool did_last(const Session& session) const;

  const Annotations& annotations() const { return annotations_; }
  /// Returns what is being placed or moved, as it would be if the pointer were released now.
  const std::optional<Action>& in_hand() const { return in_hand_; }

private:
  struct Undo {
    Action action;
    Pose picture;     ///< in which it was done
    Machine machine;  ///< as it was then
  };
  void begin_step(const Session& session);
  void begin(const glm::dvec2& at);
  bool grab(const Pose& picture, const glm::dvec2& at, double reach_mm);
  void commit(Session& session, Action action);
  void drop();

  int attempt_ = 0;
  std::optional<std::size_t> step_;  ///< of the exam
  StepInput input_;                  ///< of that step
  Tool tool_ = Tool::distance;
  std::optional<int> chosen_slot_;
  std::vector<std::string> names_;
  std::optional<Pose> picture_;

  Annotations annotations_;
  std::vector<Undo> done_;  ///< the actions that undo each action
  std::optional<Action> in_hand_;
  bool drawing_ = false;               ///< what is in hand is new and needs more clicks
  bool first_press_ = false;           ///< the press that began it is not released yet
  bool has_axis_ = false;              ///< the ellipse in hand has its axis
  std::optional<std::size_t> handle_;  ///< of what is in hand, while it is being moved
  std::optional<glm::dvec2> place_;    ///< clicked and not named yet
};

}  // namespace insonate
