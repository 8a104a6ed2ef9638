#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace insonate {

/// How an attempt came about: scores of one kind are not to be compared with those of another.
enum class AttemptMode {
  exam,      ///< it counted: taken once, without help (ExamRules::strict)
  practice,  ///< a live run as often as one likes, with the ghost plane and hints at hand
  recording  ///< a recorded scan that was scored
};

/// As files and command lines have it: "exam", "practice" or "recording".
inline constexpr std::array<std::string_view, 3> kAttemptModes{"exam", "practice", "recording"};

/// Empty for attempts of databases that did not say it yet (results_schema.cpp).
inline std::string name_of(std::optional<AttemptMode> mode) {
  return mode ? std::string(kAttemptModes[std::size_t(*mode)]) : std::string();
}

/// Empty for a name that is none.
inline std::optional<AttemptMode> find_attempt_mode(std::string_view name) {
  for (std::size_t i = 0; i < kAttemptModes.size(); ++i)
    if (kAttemptModes[i] == name) return AttemptMode(i);
  return std::nullopt;
}

/// Whether an attempt is one of those asked for. One that does not say may have counted, and is taken to have.
inline bool is_of(std::optional<AttemptMode> mode, AttemptMode asked) {
  return mode.value_or(AttemptMode::exam) == asked;
}

}  // namespace insonate
