#include "sim/model/setting_keys.h"

namespace insonate::keys {

std::string from_to(double least, double most) {
  return "from " + exact_text(least) + " to " + exact_text(most);
}

std::string in_words(const SettingValue& value) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t n) const { return std::to_string(n); }
    std::string operator()(double x) const { return exact_text(x); }
    std::string operator()(const std::string& text) const { return in_quotes(text); }
    std::string operator()(const std::vector<double>& list) const {
      std::string text;
      for (double x : list) text += (text.empty() ? "[" : ", ") + exact_text(x);
      return text.empty() ? "[]" : text + "]";
    }
  } words;
  return std::visit(words, value);
}

}  // namespace insonate::keys
