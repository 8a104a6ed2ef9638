#include "sim/files/mistake.h"

#include <algorithm>
#include <utility>

namespace insonate {
namespace {

constexpr std::size_t kMaxListed = 100;

}  // namespace

std::string in_words(const SourcePlace& place) {
  return place.line > 0 ? "line " + std::to_string(place.line) + ", column " + std::to_string(place.column) : "";
}

std::vector<Mistake> in_order_of_file(std::vector<Mistake> mistakes) {
  const auto at = [](const Mistake& mistake) { return std::pair(mistake.place.line, mistake.place.column); };
  std::stable_sort(mistakes.begin(), mistakes.end(), [&](const Mistake& a, const Mistake& b) { return at(a) < at(b); });
  std::vector<Mistake> once;
  for (Mistake& mistake : mistakes) {
    const auto same = [&](const Mistake& other) {
      return at(other) == at(mistake) && other.problem == mistake.problem;
    };
    auto before = once.rbegin();
    while (before != once.rend() && at(*before) == at(mistake) && !same(*before)) ++before;
    if (before == once.rend() || !same(*before)) once.push_back(std::move(mistake));
  }
  return once;
}

InputError input_error(const std::string& file, std::vector<Mistake> mistakes) {
  mistakes = in_order_of_file(std::move(mistakes));
  if (mistakes.size() == 1) {
    const Mistake& only = mistakes.front();
    return InputError(file, in_words(only.place), only.problem, only.remedy);
  }
  std::string text = in_one_line(file) + ": " + std::to_string(mistakes.size()) + " problems; correct them:";
  for (std::size_t i = 0; i < std::min(mistakes.size(), kMaxListed); ++i) {
    const std::string place = in_words(mistakes[i].place);
    text += "\n  " + place + (place.empty() ? "" : ": ") + in_one_line(mistakes[i].problem) + "; " +
            in_one_line(mistakes[i].remedy);
  }
  if (mistakes.size() > kMaxListed)
    text += "\n  and so on.";
  else if (text.back() != '?')
    text += '.';
  return InputError(text);
}

}  // namespace insonate
