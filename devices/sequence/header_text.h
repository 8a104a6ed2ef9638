#pragma once

#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The words and numbers of a text header, whatever the locale.

namespace insonate {

/// Header fields by name, as they stand in the file's bytes.
using HeaderFields = std::map<std::string_view, std::string_view>;

/// The remedy for a header that its writer got wrong.
inline constexpr const char* kExportAgain = "record or export the file again";

/// Without blanks and carriage returns at both ends.
std::string_view trimmed(std::string_view text);

bool same_ignoring_case(std::string_view a, std::string_view b);

/// The parts between blanks.
std::vector<std::string_view> words(std::string_view text);

/// `text` for a message: in quotes, short, and without what a terminal could trip over.
std::string quoted(std::string_view text);

/// The number that the whole of `text` is, or nothing.
template <typename Number>
std::optional<Number> to_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace insonate
