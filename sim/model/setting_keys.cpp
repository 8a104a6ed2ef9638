#include "sim/model/setting_keys.h"

namespace insonate::keys {

std::string from_to(double least, double most) {
  return "from " + number_text(least) + " to " + number_text(most);
}

std::string in_words(const SettingValue& value) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t n) const { return std::to_string(n); }
    std::string operator()(double x) const { return number_text(x); }
    std::string operator()(const std::string& text) const { return in_quotes(text); }
    std::string operator()(const std::vector<double>& list) const {
      std::string text;
      for (double x : list) text += (text.empty() ? "[" : ", ") + number_text(x);
      return text.empty() ? "[]" : text + "]";
    }
  } words;
  return std::visit(words, value);
}

std::optional<SettingValue> value_of(const toml::node& node, const SettingValue& kind) {
  if (std::holds_alternative<bool>(kind)) {
    if (const auto* b = node.as_boolean()) return b->get();
  } else if (std::holds_alternative<std::int64_t>(kind)) {
    if (const auto* n = node.as_integer()) return n->get();
  } else if (std::holds_alternative<double>(kind)) {
    if (node.is_number()) return *node.value<double>();
  } else if (std::holds_alternative<std::string>(kind)) {
    if (const auto* text = node.as_string()) return text->get();
  } else if (const toml::array* array = node.as_array()) {
    std::vector<double> list;
    for (const toml::node& element : *array) {
      if (!element.is_number()) return std::nullopt;
      list.push_back(*element.value<double>());
    }
    return list;
  }
  return std::nullopt;
}

}  // namespace insonate::keys
