#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// What a learner does besides moving the probe, and what a recording says of itself. The brackets list the action's
/// arguments: numbers, then a text.
enum class ActionKind {
  probe,              ///< selects another probe [its name] and sets that probe's own depth and frequency
  depth,              ///< [mm]
  frequency,          ///< [MHz]
  gain,               ///< [dB]
  dynamic_range,      ///< [dB]
  time_gain,          ///< [slider, 1 = nearest; dB]
  compounding,        ///< [steering angles, odd]
  persistence,        ///< [share of the frame before, 0 to 0.95]
  edge_enhancement,   ///< [0 to 4]
  speckle_reduction,  ///< [0 to 1]
  effect,             ///< changes an effect of the model (sim/model/effects.h) [value; its name], or takes all changes
                      ///< back [0; ""]
  freeze,             ///< stops the picture at the last valid sample before the action
  unfreeze,
  caliper,    ///< places a caliper [slot from 1, x1, y1, x2, y2]; placing the same slot again moves it
  ellipse,    ///< places an ellipse [slot, x1, y1, x2, y2: the ends of one axis, half the length of the other axis]
  point,      ///< points at a position [x, y]
  label,      ///< names the structure at a position [x, y; the structure's name]
  take_back,  ///< removes a placed item [slot of a caliper or ellipse, or 0; then the label's name, or "" for the
              ///< point]
  answer,     ///< answers the question [the choice, number or text]
  hint,       ///< requests the next hint
  go_to,      ///< switches to another step [its name]
  go_on,      ///< declares the step done
  guide,      ///< shows (1) or hides (0) the guide to the step's view; it costs nothing, and the result counts it
  patient     ///< says whom a recording shows [Session::patient()]; it changes nothing
};

/// Returns the action's name in logs and scenarios, such as "depth".
std::string_view word_of(ActionKind kind);

/// One action with its arguments. Positions are mm in the probe's imaging plane: x lateral towards the marker, y along
/// the central beam.
struct Action {
  static constexpr std::size_t kMaxNumbers = 6;
  static constexpr double kLargestNumber = 1e6;
  static constexpr int kMaxSlots = 9;
  static constexpr int kTimeGainSliders = 8;
  static constexpr std::size_t kLongestText = 240;  ///< bytes; longer text is cut when it is written

  ActionKind kind{};
  std::array<double, kMaxNumbers> numbers{};
  std::string text{};

  int slot() const { return int(numbers[0]); }
  /// Returns the point whose x is `numbers[first]`.
  glm::dvec2 point(std::size_t first) const { return {numbers[first], numbers[first + 1]}; }
  bool operator==(const Action&) const = default;
};

/// Actions by sample time. Each entry holds the actions between the previous sample and the sample at that time. They
/// take effect at that time, before that sample is evaluated. So a log of frames carries actions without a clock of
/// their own.
using ActionLog = std::map<double, std::vector<Action>>;

/// Returns the form that a log's frame stores: "depth 120; caliper 1 -10.5 40 12 41; answer :a%20stone". Numbers keep
/// every bit. A text begins with ':' and writes blanks, '%', ';' and all bytes except printable ASCII as %XX.
std::string to_text(std::span<const Action> actions);

/// Returns the stored form of a whole log, by sample time.
std::map<double, std::string> to_texts(const ActionLog& log);

/// Parses the output of to_text(). Throws InputError naming `file` and `place` if an action's name is unknown or an
/// argument is missing, malformed or out of range.
std::vector<Action> parse_actions(std::string_view text, const std::string& file, const std::string& place);

/// Parses the output of to_texts(). Throws InputError as parse_actions() does.
ActionLog parse_action_log(const std::map<double, std::string>& texts, const std::string& file);

}  // namespace insonate
