#include "sim/core/input_error.h"

#include <algorithm>

namespace insonate {
namespace {

bool is_control(unsigned char c) {
  return c < ' ' || c == 0x7f;
}

/// Returns whether `c` is a continuation byte of UTF-8.
bool goes_on(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

std::string sentence(const std::string& file, const std::string& place, const std::string& problem,
                     const std::string& remedy) {
  std::string text = in_one_line(file) + ": ";
  if (!place.empty()) text += in_one_line(place) + ": ";
  text += in_one_line(problem) + "; " + in_one_line(remedy);
  return text.back() == '?' ? text : text + ".";
}

}  // namespace

std::string in_one_line(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  std::size_t end = std::min(text.size(), kLongest);
  while (end < text.size() && end > 0 && goes_on(text[end])) --end;
  std::string line(text.substr(0, end));
  std::replace_if(line.begin(), line.end(), is_control, ' ');
  // U+0080 to U+009F, the control characters beyond ASCII.
  for (std::size_t at = 0; (at = line.find('\xc2', at)) != std::string::npos && at + 1 < line.size(); ++at)
    if (static_cast<unsigned char>(line[at + 1]) < 0xa0) line.replace(at, 2, "  ");
  return end < text.size() ? line + "..." : line;
}

InputError::InputError(const std::string& file, const std::string& place, const std::string& problem,
                       const std::string& remedy)
    : std::runtime_error(sentence(file, place, problem, remedy)) {}

}  // namespace insonate
