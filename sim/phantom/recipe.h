#pragma once

#include <glm/vec3.hpp>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/core/suggest.h"
#include "sim/core/toml_table.h"
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
  Recipe(std::string name, const std::string& text, const std::vector<std::pair<std::string, std::string>>& options);

  /// Replaces an option's value, or returns why it cannot.
  std::optional<OptionProblem> set_option(const std::string& option, const std::string& value);

  const std::string& name() const { return name_; }
  const toml::table& root() const { return root_; }

  /// Returns the value of an arithmetic text. Throws InputError at `where` if it has none.
  double evaluate(const std::string& expression, const toml::node& where) const;

  /// Throws an InputError with the line and column of `where`.
  [[noreturn]] void refuse(const toml::node& where, const std::string& problem, const std::string& remedy) const;

private:
  struct Option {
    double value = 0, least = 0, most = 1;
    bool is_flag = false;
  };
  Option declared_option(const std::string& option, const toml::table& declared) const;

  std::string name_;
  toml::table root_;
  std::map<std::string, Option> options_;
};

/// Reads one table of a recipe key by key. Numbers may be arithmetic, and finish() refuses every key that was never
/// asked for. Each reader throws InputError with line and column if the value is missing, of another type or out of
/// range.
class RecipeTable {
public:
  /// @param what  the table's name in messages: "shape 'liver'"; empty for the recipe's top level
  RecipeTable(const Recipe& recipe, const toml::table& table, const std::string& what)
      : recipe_(recipe), table_(table), plain_(recipe.name(), what, table) {}

  bool has(const std::string& key) { return ask(key).has(key); }
  std::string text(const std::string& key) { return ask(key).text(key); }
  std::vector<std::string> texts(const std::string& key) { return ask(key).texts(key); }
  bool flag_or(const std::string& key, bool otherwise) { return has(key) ? plain_.boolean(key) : otherwise; }

  /// Returns the `name` key's text: lower-case letters, digits and underscores, as a case's files require.
  std::string name();

  double number(const std::string& key, double least, double most);
  double number_or(const std::string& key, double otherwise, double least, double most);
  glm::dvec3 vector(const std::string& key, double least, double most);
  glm::dvec3 vector_or(const std::string& key, const glm::dvec3& otherwise, double least, double most);

  /// Returns at least `count` rows of `fewest` to `widest` numbers each.
  std::vector<std::vector<double>> rows(const std::string& key, std::size_t count, std::size_t fewest,
                                        std::size_t widest, double least, double most);

  /// Returns the array of tables under a key; empty if the key is missing.
  std::vector<const toml::table*> tables(const std::string& key);

  /// Returns the value under a key, unparsed; null if the key is missing.
  const toml::node* node(const std::string& key) { return has(key) ? table_.get(key) : nullptr; }

  /// Throws an InputError with the line and column of the key's value, or of the table if the key is missing.
  [[noreturn]] void refuse(const std::string& key, const std::string& problem, const std::string& remedy) const {
    plain_.fail(key, problem, remedy);
  }

  /// Throws InputError for every key that no reader has asked for.
  void finish() const { plain_.allow_only(asked_); }

private:
  const TomlTable& ask(const std::string& key) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
    return plain_;
  }
  const toml::array& array(const std::string& key, const std::string& wanted);
  double number_at(const toml::node& node, const std::string& key, double least, double most) const;

  const Recipe& recipe_;
  const toml::table& table_;
  TomlTable plain_;
  std::vector<std::string> asked_;
};

/// Returns the remedy for a name that is missing from a map.
template <typename Value>
std::string suggest_from(const std::string& unknown, const std::map<std::string, Value>& known) {
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const auto& entry : known) names.push_back(entry.first);
  return names.empty() ? "define it first" : suggest(unknown, names);
}

}  // namespace insonate
