#pragma once

#include <glm/vec3.hpp>
#include <toml++/toml.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace insonate {

/// A recipe's text, and the values that its options have in this run.
///
/// Wherever a recipe takes a number it also takes a text: arithmetic over numbers and option names
/// ("aorta_diameter_mm / 2 + 1"), with + - * / ( ), min(a, b) and max(a, b). A true option counts 1, a false one 0.
class Recipe {
public:
  /// Parses the text and its [options], and puts the given values in place of the recipe's own. Throws InputError.
  Recipe(std::string name, const std::string& text, const std::vector<std::pair<std::string, std::string>>& options);

  const std::string& name() const { return name_; }
  const toml::table& root() const { return root_; }

  /// The value of a text of arithmetic; `where` is blamed when it is none.
  double evaluate(const std::string& expression, const toml::node& where) const;

  /// Throws an InputError that points at `where` in the text.
  [[noreturn]] void refuse(const toml::node& where, const std::string& problem, const std::string& remedy) const;

private:
  void declare_options(const toml::node& node);
  void set_option(const std::string& option, const std::string& value);

  struct Option {
    double value = 0, least = 0, most = 1;
    bool is_flag = false;
  };
  std::string name_;
  toml::table root_;
  std::map<std::string, Option> options_;
};

/// One table of a recipe, read key by key. What was never asked for is unknown: finish() refuses it. Every reader
/// throws InputError with line and column when the value is missing, of another type or out of range.
class RecipeTable {
public:
  /// `what` names the table in messages: "shape 'liver'".
  RecipeTable(const Recipe& recipe, const toml::table& table, std::string what);

  bool has(const std::string& key);
  std::string text(const std::string& key);
  std::string text_or(const std::string& key, const std::string& otherwise);
  bool flag_or(const std::string& key, bool otherwise);
  double number(const std::string& key, double least, double most);
  double number_or(const std::string& key, double otherwise, double least, double most);
  glm::dvec3 vector(const std::string& key, double least, double most);
  glm::dvec3 vector_or(const std::string& key, const glm::dvec3& otherwise, double least, double most);
  std::vector<std::string> texts_or_none(const std::string& key);

  /// Rows of numbers, each with at least `fewest` and at most `widest` of them, and at least `rows` rows.
  std::vector<std::vector<double>> rows(const std::string& key, std::size_t rows, std::size_t fewest,
                                        std::size_t widest, double least, double most);

  /// The array of tables under a key; empty when it is missing.
  std::vector<const toml::table*> tables(const std::string& key);

  /// Points at the key's value, or at the table when there is none.
  [[noreturn]] void refuse(const std::string& key, const std::string& problem, const std::string& remedy) const;

  void finish() const;

  const toml::table& table() const { return table_; }
  const Recipe& recipe() const { return recipe_; }
  const std::string& what() const { return what_; }

private:
  const toml::node* ask(const std::string& key);
  const toml::node& need(const std::string& key, const std::string& type);
  double number_at(const toml::node& node, const std::string& key, double least, double most) const;

  const Recipe& recipe_;
  const toml::table& table_;
  std::string what_;
  std::set<std::string> asked_;
};

/// "did you mean 'radius'?" for the candidate closest to a misspelt name, else the whole list.
std::string suggestion(const std::string& misspelt, const std::set<std::string>& candidates);

}  // namespace insonate
