#pragma once

#include <charconv>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

// Splits a text header into lines, words and numbers, independently of the locale.

namespace insonate {

/// Returns `text` with A to Z as a to z.
std::string lower_case(std::string_view text);

/// Returns whether the texts are equal but for the case of A to Z.
bool same_ignoring_case(std::string_view a, std::string_view b);

/// Returns the parts between blanks.
std::vector<std::string_view> words(std::string_view text);

/// Returns `text` for a message: in quotes, shortened to 60 characters, and without characters that a terminal could
/// interpret.
std::string quoted(std::string_view text);

/// Returns the number that the whole of `text` represents, or nothing. A float may have a plus sign.
template <typename Number>
std::optional<Number> to_number(std::string_view text) {
  if (std::is_floating_point_v<Number> && text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Receives one field of a header: views of the file's bytes, without blanks around them, and the line's number from 1
/// on.
using TakeField = std::function<void(std::string_view name, std::string_view value, std::size_t line)>;

/// Splits a header into lines, which end in LF or CR LF; the last one may end with the bytes.
class HeaderLines {
public:
  /// @param file  the file's name in error messages
  HeaderLines(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  /// Moves to the next line. Returns whether there is one.
  bool next();
  std::string_view text() const { return text_; }  ///< the line without blanks around it
  std::size_t number() const { return number_; }   ///< from 1 on
  std::size_t end() const { return at_; }          ///< offset behind the line

  /// Returns the line's name, which ends before the first `separator`. Throws InputError, with the form that the line
  /// should have, if there is none or if it holds control characters.
  std::string_view name(char separator, const std::string& form) const;
  /// Throws an InputError about this line.
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const;

private:
  std::string_view bytes_, text_;
  const std::string& file_;
  std::size_t at_ = 0, number_ = 0;
};

}  // namespace insonate
