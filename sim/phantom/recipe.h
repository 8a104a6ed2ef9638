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

/// A recipe's text, and the values that its options have in this run.
///
/// Wherever a recipe takes a number it also takes a text: arithmetic over numbers and option names
/// ("aorta_diameter_mm / 2 + 1"), with + - * / ( ), min(a, b) and max(a, b). A true option counts 1, a false one 0.
class Recipe {
public:
  /// Parses the text and its [options], and puts the given values in place of the recipe's own. Throws InputError.
  Recipe(std::string name, const std::string& text, const std::vector<std::pair<std::string, std::string>>& options);

  /// Puts a value in place of the recipe's own, or says why not.
  std::optional<OptionProblem> set_option(const std::string& option, const std::string& value);

  const std::string& name() const { return name_; }
  const toml::table& root() const { return root_; }

  /// The value of a text of arithmetic; `where` is blamed when it has none.
  double evaluate(const std::string& expression, const toml::node& where) const;

  /// Throws an InputError that points at `where` in the text.
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

/// One table of a recipe, read key by key: numbers may be arithmetic, and finish() refuses every key that was never
/// asked for. Each reader throws InputError with line and column when the value is missing, of another type or out of
/// range.
class RecipeTable {
public:
  /// `what` names the table in messages: "shape 'liver'"; empty for the recipe's top level.
  RecipeTable(const Recipe& recipe, const toml::table& table, const std::string& what)
      : recipe_(recipe), table_(table), plain_(recipe.name(), what, table) {}

  bool has(const std::string& key) { return ask(key).has(key); }
  std::string text(const std::string& key) { return ask(key).text(key); }
  std::vector<std::string> texts(const std::string& key) { return ask(key).texts(key); }
  bool flag_or(const std::string& key, bool otherwise) { return has(key) ? plain_.boolean(key) : otherwise; }

  /// A text of lower-case letters, digits and underscores, for which a case's files have room.
  std::string name();

  double number(const std::string& key, double least, double most);
  double number_or(const std::string& key, double otherwise, double least, double most);
  glm::dvec3 vector(const std::string& key, double least, double most);
  glm::dvec3 vector_or(const std::string& key, const glm::dvec3& otherwise, double least, double most);

  /// At least `count` rows of `fewest` to `widest` numbers.
  std::vector<std::vector<double>> rows(const std::string& key, std::size_t count, std::size_t fewest,
                                        std::size_t widest, double least, double most);

  /// The array of tables under a key; empty when it is missing.
  std::vector<const toml::table*> tables(const std::string& key);

  /// The value under a key as it stands; null when it is missing.
  const toml::node* node(const std::string& key) { return has(key) ? table_.get(key) : nullptr; }

  /// Points at the key's value, or at the table when there is none.
  [[noreturn]] void refuse(const std::string& key, const std::string& problem, const std::string& remedy) const {
    plain_.fail(key, problem, remedy);
  }

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

/// The remedy for a name that a map does not have.
template <typename Value>
std::string suggest_from(const std::string& unknown, const std::map<std::string, Value>& known) {
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const auto& entry : known) names.push_back(entry.first);
  return names.empty() ? "define it first" : suggest(unknown, names);
}

}  // namespace insonate
