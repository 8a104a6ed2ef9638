#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace insonate {

/// Returns `text`, which may quote a file, as one line that is safe to show. Control characters, which a terminal would
/// obey, become blanks. Text beyond some 1000 bytes is cut off.
std::string in_one_line(std::string_view text);

/// Reports that an input from a person (a file, an option) cannot be used.
///
/// Thrown where outside data enters and nowhere else. Programs print what() and exit with code 2; the trainer shows it
/// in a dialog and continues. what() is one sentence, "FILE: PLACE: PROBLEM; REMEDY.", of these parts:
///     place    where in the file: "header", "line 12, column 3", "frame 41", "[[step]] 2, key 'hold_s'"; may be empty,
///     problem  what was found and what was expected, with numbers: "the spacing is 0 mm along axis 2",
///     remedy   what to do, as an imperative: "export the series again".
/// Each part goes through in_one_line().
class InputError : public std::runtime_error {
public:
  InputError(const std::string& file, const std::string& place, const std::string& problem, const std::string& remedy);

  /// Takes a whole sentence that another process has built from its parts.
  explicit InputError(const std::string& made_sentence) : std::runtime_error(made_sentence) {}
};

}  // namespace insonate
