#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

// Texts as error sentences and readers of files need them.

/// Returns the text without blanks, tabs and line ends at its ends.
std::string_view trimmed(std::string_view text);

/// Returns the text between single quotation marks: "'depth_mm'".
std::string in_quotes(std::string_view text);

/// Returns the text as one word of a command that a person copies into a shell: between quotation marks if need be.
std::string shell_word(std::string_view text);

/// Returns the text without the line ends that wrap a paragraph in a file: each becomes a blank. An empty line, which
/// separates paragraphs, stays, and the ends are trimmed.
std::string unwrapped(std::string_view text);

/// Returns what std::printf writes for a format and its values.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// Returns a number with up to six significant digits: "0.25", "1e+30".
std::string number_text(double value);

/// Returns a number with the fewest digits that restore it: "0.1", "100000". Whole numbers below 1e15 have no exponent.
std::string exact_text(double number);

/// Returns a count with its noun: "1 shard", "2 shards".
std::string count_of(std::size_t count, const char* noun);

/// Returns the names of things that have one, in their order.
template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

}  // namespace insonate
