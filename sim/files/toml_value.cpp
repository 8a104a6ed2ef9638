#include "sim/files/toml_value.h"

#include <toml++/toml.h>

#include <sstream>

namespace insonate {
namespace {

template <typename T>
std::string formatted(const T& value) {
  std::ostringstream text;
  const toml::value<T> node(value);
  text << toml::toml_formatter(node, toml::format_flags::allow_unicode_strings);
  return std::move(text).str();
}

template <typename T>
std::string list(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + formatted(value);
  return "[" + text + "]";
}

}  // namespace

std::string toml_value(const std::string& text) {
  return formatted(text);
}
std::string toml_value(double number) {
  return formatted(number);
}
std::string toml_value(const std::vector<std::string>& texts) {
  return list(texts);
}
std::string toml_value(const std::vector<double>& numbers) {
  return list(numbers);
}

}  // namespace insonate
