#include "sim/phantom/recipe.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "sim/core/input_error.h"
#include "sim/phantom/arithmetic.h"

namespace insonate {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string range_remedy(double least, double most) {
  return "give a number from " + short_number(least) + " to " + short_number(most);
}

}  // namespace

Recipe::Recipe(std::string name, const std::string& text,
               const std::vector<std::pair<std::string, std::string>>& options)
    : name_(std::move(name)), root_(parse_toml(name_, text)) {
  if (const toml::node* declared = root_.get("options")) {
    if (!declared->is_table()) refuse(*declared, "'options' is no table", "write [options]");
    for (const auto& [key, value] : *declared->as_table()) {
      const std::string option(key.str());
      if (!value.is_table())
        refuse(value, "option '" + option + "' is no table",
               "write " + option + " = { default = ..., about = \"...\" }");
      options_[option] = declared_option(option, *value.as_table());
    }
  }
  for (const auto& [option, value] : options)
    if (const auto wrong = set_option(option, value))
      throw InputError(name_, "option '" + option + "'", wrong->problem, wrong->remedy);
}

Recipe::Option Recipe::declared_option(const std::string& option, const toml::table& declared) const {
  RecipeTable table(*this, declared, "option '" + option + "'");
  table.text("about");
  Option made;
  if (const toml::node* otherwise = table.node("default"); otherwise != nullptr && otherwise->is_boolean()) {
    made.is_flag = true;
    made.value = table.flag_or("default", false) ? 1 : 0;
  } else {
    made.least = table.number("least", -1e6, 1e6);
    made.most = table.number("most", made.least, 1e6);
    made.value = table.number("default", made.least, made.most);
  }
  table.finish();
  return made;
}

std::optional<OptionProblem> Recipe::set_option(const std::string& option, const std::string& value) {
  const auto found = options_.find(option);
  if (found == options_.end())
    return OptionProblem{option, "the recipe has no such option", suggest_from(option, options_)};
  Option& made = found->second;
  if (made.is_flag) {
    if (value != "true" && value != "false")
      return OptionProblem{option, "'" + value + "' is neither true nor false", "set it to true or false"};
    made.value = value == "true" ? 1 : 0;
    return std::nullopt;
  }
  const std::optional<double> number = parse_number(value);
  if (!number || *number < made.least || *number > made.most)
    return OptionProblem{option, "'" + value + "' is " + (number ? "out of range" : "no number"),
                         range_remedy(made.least, made.most)};
  made.value = *number;
  return std::nullopt;
}

std::vector<OptionProblem> problems_with_options(const std::string& recipe_name, const std::string& recipe_text,
                                                 const std::vector<std::pair<std::string, std::string>>& options) {
  Recipe recipe(recipe_name, recipe_text, {});
  std::vector<OptionProblem> problems;
  for (const auto& [option, value] : options)
    if (const auto wrong = recipe.set_option(option, value)) problems.push_back(*wrong);
  return problems;
}

double Recipe::evaluate(const std::string& expression, const toml::node& where) const {
  std::map<std::string, double> values;
  for (const auto& [option, declared] : options_) values[option] = declared.value;
  const ArithmeticResult result = evaluate_arithmetic(expression, values);
  if (result.unknown_name)
    refuse(where, "'" + *result.unknown_name + "' is no option of this recipe",
           suggest_from(*result.unknown_name, values));
  if (!result.value)
    refuse(where, "'" + expression + "' cannot be worked out (" + result.problem + ")",
           "write a number, or arithmetic over numbers and options");
  return *result.value;
}

void Recipe::refuse(const toml::node& where, const std::string& problem, const std::string& remedy) const {
  const toml::source_position at = where.source().begin;
  throw InputError(name_, "line " + std::to_string(at.line) + ", column " + std::to_string(at.column), problem, remedy);
}

std::string RecipeTable::name() {
  std::string name = text("name");
  if (!std::all_of(name.begin(), name.end(),
                   [](unsigned char c) { return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_'; }))
    refuse("name", "the name is '" + name + "'", "use lower-case letters, digits and underscores");
  return name;
}

double RecipeTable::number_at(const toml::node& node, const std::string& key, double least, double most) const {
  double value = 0;
  if (const auto* expression = node.as_string())
    value = recipe_.evaluate(expression->get(), node);
  else if (node.is_number())
    value = *node.value<double>();
  else
    recipe_.refuse(node, plain_.name() + ": '" + key + "' is no number", range_remedy(least, most));
  if (!(value >= least && value <= most))
    recipe_.refuse(node, plain_.name() + ": '" + key + "' is " + short_number(value), range_remedy(least, most));
  return value;
}

double RecipeTable::number(const std::string& key, double least, double most) {
  if (!has(key)) refuse("", "the key '" + key + "' is missing", "add it: a number");
  return number_at(*table_.get(key), key, least, most);
}

double RecipeTable::number_or(const std::string& key, double otherwise, double least, double most) {
  return has(key) ? number(key, least, most) : otherwise;
}

const toml::array& RecipeTable::array(const std::string& key, const std::string& wanted) {
  if (!has(key)) refuse("", "the key '" + key + "' is missing", "add it: " + wanted);
  const toml::array* array = table_.get(key)->as_array();
  if (array == nullptr) refuse(key, "'" + key + "' is no list", "write " + wanted);
  return *array;
}

glm::dvec3 RecipeTable::vector(const std::string& key, double least, double most) {
  const toml::array& numbers = array(key, "[x, y, z]");
  if (numbers.size() != 3)
    refuse(key, "'" + key + "' has " + std::to_string(numbers.size()) + " numbers", "write [x, y, z]");
  return {number_at(numbers[0], key, least, most), number_at(numbers[1], key, least, most),
          number_at(numbers[2], key, least, most)};
}

glm::dvec3 RecipeTable::vector_or(const std::string& key, const glm::dvec3& otherwise, double least, double most) {
  return has(key) ? vector(key, least, most) : otherwise;
}

std::vector<std::vector<double>> RecipeTable::rows(const std::string& key, std::size_t count, std::size_t fewest,
                                                   std::size_t widest, double least, double most) {
  const std::string wanted = "a list of at least " + std::to_string(count) + " rows [...] of " +
                             std::to_string(fewest) + (widest > fewest ? " or more" : "") + " numbers";
  const toml::array& list = array(key, wanted);
  if (list.size() < count) refuse(key, "'" + key + "' has " + std::to_string(list.size()) + " rows", "write " + wanted);
  std::vector<std::vector<double>> values;
  for (const toml::node& node : list) {
    const toml::array* row = node.as_array();
    if (row == nullptr || row->size() < fewest || row->size() > widest)
      recipe_.refuse(node, plain_.name() + ": a row of '" + key + "' has the wrong number of values",
                     "give it " + std::to_string(fewest) + (widest > fewest ? " to " + std::to_string(widest) : ""));
    values.emplace_back();
    for (const toml::node& value : *row) values.back().push_back(number_at(value, key, least, most));
  }
  return values;
}

std::vector<const toml::table*> RecipeTable::tables(const std::string& key) {
  ask(key).tables(key);  // throws if it is not a list of tables
  std::vector<const toml::table*> tables;
  if (const toml::node* list = node(key))
    for (const toml::node& entry : *list->as_array()) tables.push_back(entry.as_table());
  return tables;
}

}  // namespace insonate
