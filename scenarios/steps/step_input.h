#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenarios/action.h"
#include "scenarios/machine.h"

namespace insonate {

// What a step takes from the learner besides the probe. Screens, keyboards and tools know these inputs and not the
// kinds of steps: a new kind that takes one of them needs nothing of theirs.

/// The learner chooses one of several texts, or types a number or a text.
struct AnswerInput {
  enum class Form { choice, number, text };
  Form form = Form::choice;
  std::vector<std::string> choices;  ///< 2 to 10; empty unless `form` is choice
  std::string unit;                  ///< shown beside a number; may be empty

  bool is_typed() const { return form != Form::choice; }
  /// Whether `answer` can be given: it is not empty, and a number where one is asked for.
  bool accepts(const std::string& answer) const;
  /// Returns an answer as a number; nothing if it is not one.
  static std::optional<double> number_in(const std::string& answer);
};

/// The learner places calipers or ellipses in a frozen picture, one per slot.
struct MeasureInput {
  ActionKind places = ActionKind::caliper;  ///< or ellipse
  std::vector<std::string> slots;           ///< what each is called, from slot 1 on: "aorta, width"; 1 to 3
  std::string convention;                   ///< where the calipers go: "outer to outer"
  std::string result;                       ///< what all slots together are called: "Ratio"; empty for one slot
  /// Returns the result with its unit from what all slots hold, in their order: "1.25".
  std::function<std::string(const std::vector<Action>&)> result_text;
};

/// The learner points at one place in a frozen picture.
struct PointInput {};

/// The learner puts names on places in a frozen picture.
struct LabelInput {
  std::vector<std::string> names;
};

/// The learner changes settings of the machine.
struct SettingsInput {
  struct Setting {
    std::string name;    ///< "Depth"
    std::string wanted;  ///< "11 to 13 cm"
    std::string now;     ///< "16 cm"
    bool right = false;
  };
  /// Returns each setting that is asked for, with its wanted value and the machine's.
  std::function<std::vector<Setting>(const Machine&)> compare;
};

using StepInput = std::variant<std::monostate, AnswerInput, MeasureInput, PointInput, LabelInput, SettingsInput>;

/// What the screen says of a step, by its kind.
struct StepWords {
  std::string prompt{};                  ///< what to do, where the input does not show it; a sentence
  const char* under_way = "To be done";  ///< until it is done
  const char* on_target = "As asked";    ///< while the picture or the machine is as asked for
  bool shows_progress = true;            ///< the screen shows the share that is done, and that it is enough
};

}  // namespace insonate
