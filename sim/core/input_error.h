#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace insonate {

/// A text that may quote a file, as one line that is safe to show: control characters, which a terminal would obey,
/// become blanks, and what goes beyond some 1000 bytes is cut.
std::string in_one_line(std::string_view text);

/// Something a person handed over (a file, an option) cannot be used.
///
/// Thrown where outside data enters and nowhere else; programs print what() and exit with code 2, the trainer shows it
/// in a dialog and goes on. what() is one sentence, "FILE: PLACE: PROBLEM; REMEDY.", so write
///   place    where in the file: "header", "line 12, column 3", "frame 41", "[[step]] 2, key 'hold_s'"; may be empty,
///   problem  what is there and what was expected, with the numbers: "the spacing is 0 mm along axis 2",
///   remedy   what to do, as an imperative: "export the series again".
/// Each part goes through in_one_line().
class InputError : public std::runtime_error {
public:
  InputError(const std::string& file, const std::string& place, const std::string& problem, const std::string& remedy);

  /// A sentence that another process has made of its parts.
  explicit InputError(const std::string& made_sentence) : std::runtime_error(made_sentence) {}
};

}  // namespace insonate
