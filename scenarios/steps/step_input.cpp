#include "scenarios/steps/step_input.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace insonate {

bool AnswerInput::accepts(const std::string& answer) const {
  return form == Form::number ? number_in(answer).has_value() : !answer.empty();
}

std::optional<double> AnswerInput::number_in(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + first, text.data() + text.size(), value);
  const bool rest = std::any_of(end, text.data() + text.size(), [](char c) { return c != ' ' && c != '\t'; });
  if (error != std::errc() || rest || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace insonate
