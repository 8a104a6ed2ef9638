#include "sim/volume/phantom_recipe.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "sim/core/input_error.h"
#include "sim/volume/phantom_arithmetic.h"

namespace insonate {
namespace {

std::string short_number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string place_of(const toml::source_region& region) {
  if (region.begin.line == 0) return "";
  return "line " + std::to_string(region.begin.line) + ", column " + std::to_string(region.begin.column);
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(const std::string& misspelt, const std::set<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, misspelt.size() / 3) + 1;
  for (const std::string& candidate : candidates)
    if (const std::size_t distance = edit_distance(misspelt, candidate); distance < least) {
      least = distance;
      best = candidate;
    }
  if (!best.empty()) return "did you mean '" + best + "'?";
  std::string all;
  for (const std::string& candidate : candidates) all += (all.empty() ? "" : ", ") + candidate;
  return all.empty() ? "take it out" : "take one of: " + all;
}

Recipe::Recipe(std::string name, const std::string& text,
               const std::vector<std::pair<std::string, std::string>>& options)
    : name_(std::move(name)) {
  try {
    root_ = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(name_, place_of(error.source()), std::string(error.description()), "correct the recipe there");
  }
  if (const toml::node* declared = root_.get("options")) declare_options(*declared);
  for (const auto& [option, value] : options) set_option(option, value);
}

void Recipe::declare_options(const toml::node& node) {
  const toml::table* table = node.as_table();
  if (table == nullptr) refuse(node, "'options' is no table", "write [options]");
  for (const auto& [key, value] : *table) {
    const std::string option(key.str());
    const toml::table* declared = value.as_table();
    if (declared == nullptr)
      refuse(value, "option '" + option + "' is no table", "write " + option + " = { default = ..., about = \"...\" }");
    RecipeTable reader(*this, *declared, "option '" + option + "'");
    reader.text("about");
    Option made;
    if (const toml::node* flag = declared->get("default"); flag != nullptr && flag->is_boolean()) {
      made.is_flag = true;
      made.value = reader.flag_or("default", false) ? 1 : 0;
    } else {
      made.least = reader.number("least", -1e6, 1e6);
      made.most = reader.number("most", made.least, 1e6);
      made.value = reader.number("default", made.least, made.most);
    }
    reader.finish();
    options_[option] = made;
  }
}

void Recipe::set_option(const std::string& option, const std::string& value) {
  const auto found = options_.find(option);
  if (found == options_.end()) {
    std::set<std::string> known;
    for (const auto& entry : options_) known.insert(entry.first);
    throw InputError(name_, "option '" + option + "'", "the recipe has no such option", suggestion(option, known));
  }
  Option& made = found->second;
  if (made.is_flag) {
    if (value != "true" && value != "false")
      throw InputError(name_, "option '" + option + "'", "'" + value + "' is neither true nor false",
                       "set it to true or false");
    made.value = value == "true" ? 1 : 0;
    return;
  }
  const std::string range = short_number(made.least) + " to " + short_number(made.most);
  const std::optional<double> number = parse_number(value);
  if (!number)
    throw InputError(name_, "option '" + option + "'", "'" + value + "' is no number", "give a number from " + range);
  if (*number < made.least || *number > made.most)
    throw InputError(name_, "option '" + option + "'", value + " is out of range", "give a number from " + range);
  made.value = *number;
}

double Recipe::evaluate(const std::string& expression, const toml::node& where) const {
  std::map<std::string, double> values;
  for (const auto& [option, declared] : options_) values[option] = declared.value;
  const ArithmeticResult result = evaluate_arithmetic(expression, values);
  if (result.unknown_name) {
    std::set<std::string> known;
    for (const auto& entry : options_) known.insert(entry.first);
    refuse(where, "'" + *result.unknown_name + "' is no option of this recipe",
           suggestion(*result.unknown_name, known));
  }
  if (!result.value)
    refuse(where, "'" + expression + "' cannot be worked out (" + result.problem + ")",
           "write a number, or arithmetic over numbers and options");
  return *result.value;
}

void Recipe::refuse(const toml::node& where, const std::string& problem, const std::string& remedy) const {
  throw InputError(name_, place_of(where.source()), problem, remedy);
}

RecipeTable::RecipeTable(const Recipe& recipe, const toml::table& table, std::string what)
    : recipe_(recipe), table_(table), what_(std::move(what)) {}

const toml::node* RecipeTable::ask(const std::string& key) {
  asked_.insert(key);
  return table_.get(key);
}

const toml::node& RecipeTable::need(const std::string& key, const std::string& type) {
  const toml::node* node = ask(key);
  if (node == nullptr) recipe_.refuse(table_, what_ + " has no '" + key + "'", "add " + key + ", " + type);
  return *node;
}

void RecipeTable::refuse(const std::string& key, const std::string& problem, const std::string& remedy) const {
  const toml::node* node = table_.get(key);
  recipe_.refuse(node != nullptr ? *node : static_cast<const toml::node&>(table_), what_ + ": " + problem, remedy);
}

bool RecipeTable::has(const std::string& key) {
  return ask(key) != nullptr;
}

std::string RecipeTable::text(const std::string& key) {
  const toml::node& node = need(key, "a text");
  const std::optional<std::string> value = node.value<std::string>();
  if (!node.is_string() || value->empty()) refuse(key, "'" + key + "' is no text", "write it in quotes");
  return *value;
}

std::string RecipeTable::text_or(const std::string& key, const std::string& otherwise) {
  return has(key) ? text(key) : otherwise;
}

bool RecipeTable::flag_or(const std::string& key, bool otherwise) {
  const toml::node* node = ask(key);
  if (node == nullptr) return otherwise;
  if (!node->is_boolean()) refuse(key, "'" + key + "' is neither true nor false", "write true or false");
  return *node->value<bool>();
}

double RecipeTable::number_at(const toml::node& node, const std::string& key, double least, double most) const {
  double value = 0;
  if (node.is_string())
    value = recipe_.evaluate(*node.value<std::string>(), node);
  else if (node.is_number())
    value = *node.value<double>();
  else
    recipe_.refuse(node, what_ + ": '" + key + "' is no number",
                   "write a number from " + short_number(least) + " to " + short_number(most));
  if (!(value >= least && value <= most))
    recipe_.refuse(node, what_ + ": '" + key + "' is " + short_number(value),
                   "give a number from " + short_number(least) + " to " + short_number(most));
  return value;
}

double RecipeTable::number(const std::string& key, double least, double most) {
  return number_at(need(key, "a number"), key, least, most);
}

double RecipeTable::number_or(const std::string& key, double otherwise, double least, double most) {
  return has(key) ? number(key, least, most) : otherwise;
}

glm::dvec3 RecipeTable::vector(const std::string& key, double least, double most) {
  const toml::array* array = need(key, "three numbers").as_array();
  if (array == nullptr || array->size() != 3)
    refuse(key, "'" + key + "' has to be three numbers", "write " + key + " = [x, y, z]");
  return {number_at((*array)[0], key, least, most), number_at((*array)[1], key, least, most),
          number_at((*array)[2], key, least, most)};
}

glm::dvec3 RecipeTable::vector_or(const std::string& key, const glm::dvec3& otherwise, double least, double most) {
  return has(key) ? vector(key, least, most) : otherwise;
}

std::vector<std::string> RecipeTable::texts_or_none(const std::string& key) {
  if (!has(key)) return {};
  const toml::array* array = table_.get(key)->as_array();
  if (array == nullptr) refuse(key, "'" + key + "' is no list", "write " + key + " = [\"...\"]");
  std::vector<std::string> texts;
  for (const toml::node& node : *array) {
    if (!node.is_string()) recipe_.refuse(node, what_ + ": '" + key + "' has to hold names", "write them in quotes");
    texts.push_back(*node.value<std::string>());
  }
  return texts;
}

std::vector<std::vector<double>> RecipeTable::rows(const std::string& key, std::size_t rows, std::size_t fewest,
                                                   std::size_t widest, double least, double most) {
  const toml::array* array = need(key, "a list of rows of numbers").as_array();
  if (array == nullptr || array->size() < rows)
    refuse(key, "'" + key + "' has to be a list of at least " + std::to_string(rows) + " rows of numbers",
           "write " + key + " = [[...], [...]]");
  std::vector<std::vector<double>> values;
  for (const toml::node& node : *array) {
    const toml::array* row = node.as_array();
    if (row == nullptr || row->size() < fewest || row->size() > widest)
      recipe_.refuse(node, what_ + ": a row of '" + key + "' has not the right number of values",
                     "give it " + std::to_string(fewest) +
                         (widest > fewest ? " to " + std::to_string(widest) : std::string()) + " numbers");
    values.emplace_back();
    for (const toml::node& value : *row) values.back().push_back(number_at(value, key, least, most));
  }
  return values;
}

std::vector<const toml::table*> RecipeTable::tables(const std::string& key) {
  if (!has(key)) return {};
  const toml::array* array = table_.get(key)->as_array();
  if (array == nullptr) refuse(key, "'" + key + "' is no list of tables", "write [[" + key + "]]");
  std::vector<const toml::table*> tables;
  for (const toml::node& node : *array) {
    if (!node.is_table())
      recipe_.refuse(node, "'" + key + "' holds something that is no table", "write [[" + key + "]]");
    tables.push_back(node.as_table());
  }
  return tables;
}

void RecipeTable::finish() const {
  for (const auto& [key, node] : table_)
    if (asked_.count(std::string(key.str())) == 0)
      recipe_.refuse(node, what_ + " has no key '" + std::string(key.str()) + "'",
                     suggestion(std::string(key.str()), asked_));
}

}  // namespace insonate
