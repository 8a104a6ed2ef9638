#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// What a learner does besides moving the probe. In brackets what the action says: numbers, then a text.
enum class ActionKind {
  probe,          ///< takes another probe [its name]; depth and frequency become that probe's own
  depth,          ///< [mm]
  frequency,      ///< [MHz]
  gain,           ///< [dB]
  dynamic_range,  ///< [dB]
  time_gain,      ///< [slider from 1 on, near to far; dB]
  freeze,         ///< the picture stands still: that of the last valid sample before the action
  unfreeze,
  caliper,    ///< puts a caliper [slot from 1 on, x1, y1, x2, y2]; a slot put again has moved
  ellipse,    ///< [slot, x1, y1, x2, y2 of one axis' ends, half the other axis]
  point,      ///< points at something [x, y]
  label,      ///< names what lies there [x, y; the structure's name]
  take_back,  ///< as if it had not been placed [slot of a caliper or ellipse, or 0; then the label's name, or "" for
              ///< the point]
  answer,     ///< answers the question [the choice, number or text]
  hint,       ///< asks for the next hint
  go_to,      ///< turns to another step [its name]
  go_on       ///< says that the step is done
};

/// As logs and scenarios call it: "depth".
std::string_view word_of(ActionKind kind);

/// Positions are mm in the probe's imaging plane: x lateral towards the marker, y along the central beam.
struct Action {
  static constexpr std::size_t kMostNumbers = 6;
  static constexpr double kLargestNumber = 1e6;
  static constexpr int kMostSlots = 9;
  static constexpr int kTimeGainSliders = 8;
  static constexpr std::size_t kLongestText = 240;  ///< bytes; more is cut when it is written

  ActionKind kind{};
  std::array<double, kMostNumbers> numbers{};
  std::string text{};

  int slot() const { return int(numbers[0]); }
  /// The point that begins at that number.
  glm::dvec2 point(std::size_t first) const { return {numbers[first], numbers[first + 1]}; }
  bool operator==(const Action&) const = default;
};

/// The actions that were done between the sample before and that of the time they stand under. They take effect at that
/// time and before that sample is looked at, so that a log of frames carries them without any clock of their own.
using ActionLog = std::map<double, std::vector<Action>>;

/// As a log's frame keeps them: "depth 120; caliper 1 -10.5 40 12 41; answer :a%20stone". Numbers are kept to the
/// bit; of a text, which begins with ':', all but printable ASCII is written as %XX, and so are blanks, '%' and ';'.
std::string to_text(std::span<const Action> actions);

/// Of a whole log, by the samples' times.
std::map<double, std::string> to_texts(const ActionLog& log);

/// Reads them back. Throws InputError naming file and place for words and numbers that are none.
std::vector<Action> parse_actions(std::string_view text, const std::string& file, const std::string& place);

/// The actions of a log, from their text by the time of the frame.
ActionLog parse_action_log(const std::map<double, std::string>& texts, const std::string& file);

}  // namespace insonate
