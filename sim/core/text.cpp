#include "sim/core/text.h"

#include <algorithm>
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

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace insonate
