#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace insonate {

/// The circumstances of an attempt. Do not compare scores of different modes.
enum class AttemptMode {
  exam,      ///< a graded attempt: taken once, without help (ExamRules::strict)
  practice,  ///< a live run, repeatable at will, with the ghost plane and hints available
  recording  ///< a recorded scan that was scored
};

/// The modes' names in files and on command lines: "exam", "practice" and "recording".
inline constexpr std::array<std::string_view, 3> kAttemptModes{"exam", "practice", "recording"};

/// Returns the mode's name. Returns an empty string for attempts from databases that do not record the mode
/// (results_schema.cpp).
inline std::string name_of(std::optional<AttemptMode> mode) {
  return mode ? std::string(kAttemptModes[std::size_t(*mode)]) : std::string();
}

/// Returns the mode of that name, or nothing for an unknown name.
inline std::optional<AttemptMode> find_attempt_mode(std::string_view name) {
  for (std::size_t i = 0; i < kAttemptModes.size(); ++i)
    if (kAttemptModes[i] == name) return AttemptMode(i);
  return std::nullopt;
}

/// Returns true if the attempt has the mode `asked`. An attempt without a recorded mode may have been graded and is
/// treated as an exam.
inline bool is_of(std::optional<AttemptMode> mode, AttemptMode asked) {
  return mode.value_or(AttemptMode::exam) == asked;
}

}  // namespace insonate
