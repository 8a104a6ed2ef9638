#include "sim/image_headers/header_text.h"

#include <algorithm>
#include <cctype>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return lower;
}

bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> all;
  for (;;) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return all;
    text.remove_prefix(first);
    const std::size_t length = std::min(text.find_first_of(" \t"), text.size());
    all.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::string shown = "'";
  for (const char c : text.substr(0, kShown)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > kShown ? "...'" : "'");
}

bool HeaderLines::next() {
  if (at_ >= bytes_.size()) return false;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  text_ = trimmed(bytes_.substr(at_, end - at_));
  at_ = std::min(end + 1, bytes_.size());
  ++number_;
  return true;
}

std::string_view HeaderLines::name(char separator, const std::string& form) const {
  const std::size_t end = std::min(text_.find(separator), text_.size());
  const std::string_view name = trimmed(text_.substr(0, end));
  const bool is_text = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
  if (end == text_.size() || name.empty() || !is_text)
    refuse(quoted(text_) + " is not of the form " + form, "correct it, or export the file again");
  return name;
}

void HeaderLines::refuse(const std::string& problem, const std::string& remedy) const {
  throw InputError(file_, "line " + std::to_string(number_), problem, remedy);
}

}  // namespace insonate
