#include "devices/tracker_uri.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"

namespace insonate {

TrackerUri parse_tracker_uri(std::string_view text) {
  TrackerUri uri;
  uri.text = text;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0)
    throw InputError("tracker '" + uri.text + "'", "", "it has no kind before a colon",
                     "write it as in 'replay:scan.igs.mha', 'synthetic:7' or 'mouse:'");
  uri.scheme = text.substr(0, colon);
  std::string_view rest = text.substr(colon + 1);
  const std::size_t question = rest.rfind('?');
  uri.subject = rest.substr(0, question);
  if (question == std::string_view::npos) return uri;

  rest.remove_prefix(question + 1);
  while (!rest.empty()) {
    const std::string_view option = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), option.size() + 1));
    const std::size_t equals = option.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == option.size())
      throw InputError("tracker '" + uri.text + "'", "option '" + std::string(option) + "'",
                       "it is not of the form name=value", "write options as in '?speed=2&loop=1'");
    const std::string name(option.substr(0, equals));
    if (!uri.options.emplace(name, option.substr(equals + 1)).second)
      throw InputError("tracker '" + uri.text + "'", "option '" + name + "'", "it is given twice", "give it once");
  }
  return uri;
}

void TrackerUri::allow_options(std::initializer_list<std::string_view> names) const {
  for (const auto& [option, value] : options) {
    if (std::find(names.begin(), names.end(), option) != names.end()) continue;
    throw InputError("tracker '" + text + "'", "option '" + option + "'", "there is no such option",
                     names.size() == 0 ? "leave it out: this tracker has no options"
                                       : suggest(option, {names.begin(), names.end()}));
  }
}

double TrackerUri::number(const std::string& option, double otherwise, double least, double most) const {
  const auto found = options.find(option);
  if (found == options.end()) return otherwise;
  const std::string& value = found->second;
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || !(number >= least && number <= most))
    throw InputError("tracker '" + text + "'", "option '" + option + "'",
                     "'" + value + "' is not a number from " + exact_text(least) + " to " + exact_text(most),
                     "change it");
  return number;
}

bool TrackerUri::flag(const std::string& option, bool otherwise) const {
  const auto found = options.find(option);
  if (found == options.end()) return otherwise;
  if (found->second != "0" && found->second != "1")
    throw InputError("tracker '" + text + "'", "option '" + option + "'", "'" + found->second + "' is neither 0 nor 1",
                     "write 1 for yes or 0 for no");
  return found->second == "1";
}

}  // namespace insonate
