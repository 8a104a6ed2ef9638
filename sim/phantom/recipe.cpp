#include "sim/phantom/recipe.h"

#include <algorithm>
#include <cctype>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/phantom/arithmetic.h"

namespace insonate {

Recipe::Recipe(const std::string& name, const std::string& text,
               const std::vector<std::pair<std::string, std::string>>& options)
    : document_(name, text) {
  document_.evaluate_texts([this](const std::string& expression) { return evaluate(expression); });
  if (root().has("options")) {
    const TomlTable declared = root().table("options");
    std::vector<std::string> names = declared.keys();
    std::sort(names.begin(), names.end());  // an option's numbers may use the options before it in the alphabet
    for (const std::string& option : names) {
      const TomlTable table = declared.table(option);
      table.rename("option " + in_quotes(option));
      options_[option] = read_option(table);
    }
    declared.refuse_unknown_keys();
  }
  for (const auto& [option, value] : options)
    if (const auto wrong = set_option(option, value))
      throw InputError(name, "option '" + option + "'", wrong->problem, wrong->remedy);
}

Recipe::Option Recipe::read_option(const TomlTable& table) {
  table.text("about");
  Option made;
  if (table.kind("default") == TomlKind::boolean) {
    made.is_flag = true;
    made.value = table.boolean("default") ? 1 : 0;
  } else {
    made.least = table.number("least", {-1e6, 1e6});
    made.most = table.number("most", {made.least, 1e6});
    made.value = table.number("default", {made.least, made.most});
  }
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
    return OptionProblem{option, "'" + value + "' is " + (number ? "out of range" : "not a number"),
                         "give a number from " + exact_text(made.least) + " to " + exact_text(made.most)};
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

TomlDocument::Evaluation Recipe::evaluate(const std::string& expression) const {
  std::map<std::string, double> values;
  for (const auto& [option, declared] : options_) values[option] = declared.value;
  const ArithmeticResult result = evaluate_arithmetic(expression, values);
  if (result.value) return {result.value, "", ""};
  if (result.unknown_name)
    return {std::nullopt, in_quotes(*result.unknown_name) + " is not an option of this recipe",
            suggest_from(*result.unknown_name, values)};
  return {std::nullopt, in_quotes(expression) + " cannot be evaluated (" + result.problem + ")",
          "write a number, or arithmetic over numbers and options"};
}

std::string read_name(const TomlTable& table) {
  const std::string name = table.text("name");
  if (!std::all_of(name.begin(), name.end(),
                   [](unsigned char c) { return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_'; }))
    table.fail("name", "the name is " + in_quotes(name), "use lower-case letters, digits and underscores");
  return name;
}

void rename_after_key(const TomlTable& table, const std::string& noun) {
  if (table.kind("name") == TomlKind::text) table.rename(noun + " " + in_quotes(table.text("name")));
}

}  // namespace insonate
