#include "sim/core/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace insonate {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string in_quotes(std::string_view text) {
  return "'" + std::string(text) + "'";
}

std::string shell_word(std::string_view text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:=@%+,";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string_view::npos) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

std::string unwrapped(std::string_view text) {
  std::string out;
  for (text = trimmed(text); !text.empty();) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (line.empty())
      out += out.ends_with('\n') ? "" : "\n\n";
    else
      out.append(out.empty() || out.ends_with('\n') ? "" : " ") += line;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string formatted(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(std::size_t(std::max(std::vsnprintf(nullptr, 0, format, values), 0)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(values);
  return text;
}

std::string count_of(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string number_text(double value) {
  return formatted("%g", value);
}

std::string exact_text(double number) {
  char text[32];
  const bool is_short_whole = std::abs(number) < 1e15 && number == std::trunc(number);
  const std::to_chars_result end = is_short_whole
                                       ? std::to_chars(text, text + sizeof text, number, std::chars_format::fixed)
                                       : std::to_chars(text, text + sizeof text, number);
  return {text, end.ptr};
}

}  // namespace insonate
