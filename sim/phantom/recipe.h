#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/core/suggest.h"
#include "sim/files/toml_table.h"
#include "sim/phantom/phantom.h"

namespace insonate {

/// Holds a recipe's text and the values of its options in this run.
///
/// Wherever a recipe takes a number it also takes arithmetic over numbers and option names, as a text:
/// "aorta_diameter_mm / 2 + 1". The operators are + - * / ( ), min(a, b) and max(a, b). A true option counts as 1, a
/// false one as 0.
class Recipe {
public:
  /// Parses the text and its [options], and replaces the recipe's own values by those given. Throws InputError.
  Recipe(const std::string& name, const std::string& text,
         const std::vector<std::pair<std::string, std::string>>& options);

  /// Replaces an option's value, or returns why it cannot.
  std::optional<OptionProblem> set_option(const std::string& option, const std::string& value);

  /// Returns the top level, whose readers of numbers evaluate arithmetic. They throw InputError.
  TomlTable root() const { return document_.root(); }

private:
  struct Option {
    double value = 0, least = 0, most = 1;
    bool is_flag = false;
  };
  static Option read_option(const TomlTable& table);
  TomlDocument::Evaluation evaluate(const std::string& expression) const;

  TomlDocument document_;
  std::map<std::string, Option> options_;
};

/// Reads the `name` key's text: lower-case letters, digits and underscores, as a case's files require.
std::string read_name(const TomlTable& table);

/// Names a table in error sentences after its `name` key, if it has one: "shape 'liver'".
void rename_after_key(const TomlTable& table, const std::string& noun);

/// Returns the remedy for a name that is missing from a map.
template <typename Value>
std::string suggest_from(const std::string& unknown, const std::map<std::string, Value>& known) {
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const auto& entry : known) names.push_back(entry.first);
  return names.empty() ? "define it first" : suggest(unknown, names);
}

}  // namespace insonate
