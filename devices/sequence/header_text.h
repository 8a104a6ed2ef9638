#pragma once

#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Splits a text header into words and numbers, independently of the locale.

#include "sim/core/text.h"

namespace insonate {

/// Header fields by name, as views of the file's bytes.
using HeaderFields = std::map<std::string_view, std::string_view>;

/// The remedy for a header that its writer wrote incorrectly.
inline constexpr const char* kExportAgain = "record or export the file again";

bool same_ignoring_case(std::string_view a, std::string_view b);

/// Returns the parts between blanks.
std::vector<std::string_view> words(std::string_view text);

/// Returns `text` for a message: in quotes, shortened to 60 characters, and without characters that a terminal could
/// interpret.
std::string quoted(std::string_view text);

/// Returns the number that the whole of `text` represents, or nothing.
template <typename Number>
std::optional<Number> to_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace insonate
