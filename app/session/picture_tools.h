#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/annotations.h"
#include "app/session/session.h"

namespace insonate {

/// What the learner can place in the frozen picture: calipers and ellipses, and where a step asks for it a point or
/// names. Takes the pointer in mm of the imaging plane and hands actions to the session. Knows no screen.
///
/// A caliper is two clicks, or one drag from end to end; an ellipse's axis likewise, and a third click sets its width.
/// What has been placed is taken hold of by its ends, its point or its name. A place is clicked first and named then.
///
/// In a `measure` step only what it measures can be placed, slot by slot; elsewhere anything may be measured, which no
/// step counts. What was placed is gone when the step or the attempt changes; what no step counts, when the picture
/// moves on.
class PictureTools {
public:
  enum class Tool { distance, ellipse, point, label };
  static constexpr double kLeast_mm = 0.5;  ///< a shorter caliper is a click too many

  /// To be called after each Session::advance().
  void see(const Session& session);

  /// There is a frozen picture that takes the pointer: none of an exam that a log does, which places what it placed.
  static bool ready(const Session& session);
  Tool tool() const { return tool_; }
  /// Whether the learner chooses what to measure with, as no step says it.
  bool free_choice() const { return !measuring() && tool_ != Tool::point && tool_ != Tool::label; }
  /// Distance or ellipse; nothing happens where there is no free choice.
  void choose(Tool tool);

  /// What the step under way measures; nullptr if it measures nothing.
  const MeasureInput* measuring() const { return std::get_if<MeasureInput>(&input_); }
  /// Whether the step under way asks for names.
  bool labelling() const { return std::holds_alternative<LabelInput>(input_); }
  /// Which caliper the next one will be.
  int slot() const;
  void choose_slot(int slot);
  /// What it is called: in a measuring step by its target, elsewhere by what it measures.
  std::string slot_name(int slot) const;
  /// Of the measuring step when all is placed: "Ratio 1.25", "Volume 123 ml"; empty for single values.
  std::string total_text() const;
  /// The names to give, in an order that tells nothing.
  const std::vector<std::string>& names() const { return names_; }
  /// Gives the place that was clicked its name.
  void name_place(Session& session, const std::string& name);
  const std::optional<glm::dvec2>& unnamed_place() const { return place_; }

  /// The pointer, mm in the plane. @param reach_mm  how far from a handle it takes hold of it
  void press(Session& session, const glm::dvec2& at, double reach_mm);
  void move(const glm::dvec2& at);
  void release(Session& session, const glm::dvec2& at, double reach_mm);
  /// Gives up what is being placed. Whether there was anything.
  bool cancel();
  /// Gives it up, or else takes back what was done last.
  void undo(Session& session);
  /// Takes back everything.
  void clear(Session& session);
  bool can_undo() const { return drawing_ || place_ || !done_.empty(); }

  const Annotations& annotations() const { return annotations_; }
  /// What is being placed or moved, as it would be if the pointer were let go now.
  const std::optional<Action>& in_hand() const { return in_hand_; }

private:
  struct Undo {
    Action action;
    Pose picture;  ///< that it was done in
  };
  void begin_step(const Session& session);
  void begin(const glm::dvec2& at);
  bool grab(const Pose& picture, const glm::dvec2& at, double reach_mm);
  void commit(Session& session, const Action& action);
  void drop();

  int attempt_ = 0;
  std::optional<std::size_t> step_;  ///< of the exam
  StepInput input_;                  ///< of that step
  Tool tool_ = Tool::distance;
  std::optional<int> chosen_slot_;
  std::vector<std::string> names_;
  std::optional<Pose> picture_;

  Annotations annotations_;
  std::vector<Undo> done_;  ///< what takes back each thing that was done
  std::optional<Action> in_hand_;
  bool drawing_ = false;               ///< what is in hand is new and has clicks to come
  bool first_press_ = false;           ///< the press that began it still lasts
  bool has_axis_ = false;              ///< the ellipse's
  std::optional<std::size_t> handle_;  ///< of what is in hand, while it is moved
  std::optional<glm::dvec2> place_;    ///< clicked, without a name yet
};

}  // namespace insonate
