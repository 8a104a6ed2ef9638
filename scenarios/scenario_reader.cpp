#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "scenarios/scenario.h"
#include "sim/core/digest.h"
#include "sim/core/files.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::size_t kMostSteps = 100;
constexpr std::size_t kMostCriteria = 100;
constexpr double kLongestExam_s = 36000;
constexpr double kLongestStep_s = 3600;
constexpr double kLargestLimit = 1000;

struct Range {
  double least;
  double most;
};

/// As short as it can be said without losing a bit.
std::string plain(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

SourcePlace place_of(const toml::source_region& source) {
  return {int(source.begin.line), int(source.begin.column)};
}

/// Takes keys out of one table, collects what is wrong with them, and at its end complains of keys nobody asked for.
class TableReader {
public:
  /// @param where  what to call the table in a sentence: "step 2"
  TableReader(const toml::table& table, std::string where, std::vector<ScenarioProblem>& problems)
      : table_(table), where_(std::move(where)), problems_(problems) {}

  ~TableReader() {
    const std::vector<std::string> known(asked_.begin(), asked_.end());
    for (const auto& [key, node] : table_)
      if (!asked_.contains(std::string(key.str())))
        problems_.push_back({place_of(key.source()), where_ + " has an unknown key '" + std::string(key.str()) + "'",
                             suggest(key.str(), known)});
  }
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;

  const toml::node* find(const char* key) {
    asked_.insert(key);
    return table_.get(key);
  }

  void problem(const SourcePlace& place, const std::string& what, const std::string& remedy) {
    problems_.push_back({place, where_ + " " + what, remedy});
  }

  SourcePlace place(const char* key) const {
    const toml::node* node = table_.get(key);
    return place_of(node ? node->source() : table_.source());
  }

  std::string text(const char* key, bool required = true) {
    const toml::node* node = find(key);
    if (!node) {
      if (required) missing(key, "\"...\"");
      return {};
    }
    const auto value = node->value_exact<std::string>();
    if (!value)
      problem(place(key), "has a '" + std::string(key) + "' that is no text", "put it between quotation marks");
    if (value && required && value->find_first_not_of(" \t\r\n") == std::string::npos)
      problem(place(key), "has an empty '" + std::string(key) + "'", "write something between the quotation marks");
    return value.value_or("");
  }

  double number(const char* key, const Range& range, std::optional<double> otherwise = std::nullopt) {
    const toml::node* node = find(key);
    if (!node) {
      if (!otherwise) missing(key, "a number");
      return otherwise.value_or(range.least);
    }
    const auto value = is_number(*node) ? node->value<double>() : std::nullopt;
    if (!value) {
      problem(place(key), "has a '" + std::string(key) + "' that is no number",
              "write a number from " + plain(range.least) + " to " + plain(range.most));
      return otherwise.value_or(range.least);
    }
    if (!(*value >= range.least && *value <= range.most)) {
      problem(place(key), "has " + std::string(key) + " = " + plain(*value),
              "choose from " + plain(range.least) + " to " + plain(range.most));
      return otherwise.value_or(range.least);
    }
    return *value;
  }

  bool yes_or_no(const char* key, bool otherwise) {
    const toml::node* node = find(key);
    if (!node) return otherwise;
    const auto value = node->value_exact<bool>();
    if (!value)
      problem(place(key), "has a '" + std::string(key) + "' that is neither true nor false", "write true or false");
    return value.value_or(otherwise);
  }

  const toml::table* table(const char* key, bool required) {
    const toml::node* node = find(key);
    if (!node) {
      if (required) missing(key, "a table");
      return nullptr;
    }
    if (!node->is_table())
      problem(place(key), "has a '" + std::string(key) + "' that is no table",
              "write [" + std::string(key) + "] above its keys");
    return node->as_table();
  }

  /// The tables of an array of tables, at most `most`.
  std::vector<const toml::table*> tables(const char* key, std::size_t most) {
    std::vector<const toml::table*> found;
    const toml::node* node = find(key);
    if (!node) return found;
    const toml::array* array = node->as_array();
    const bool all_tables =
        array && std::all_of(array->begin(), array->end(), [](const auto& n) { return n.is_table(); });
    if (!all_tables) {
      problem(place(key), "has a '" + std::string(key) + "' that is no list of tables",
              "write it in two brackets, [[" + std::string(key) + "]]");
      return found;
    }
    if (array->size() > most)
      problem(place(key), "has " + std::to_string(array->size()) + " of '" + key + "'",
              "keep to " + std::to_string(most) + " at most");
    for (const toml::node& one : *array)
      if (found.size() < most) found.push_back(one.as_table());
    return found;
  }

  static bool is_number(const toml::node& node) {
    return node.is_integer() || (node.is_floating_point() && std::isfinite(**node.as_floating_point()));
  }

private:
  void missing(const char* key, const std::string& example) {
    problem(place_of(table_.source()), "lacks the key '" + std::string(key) + "'",
            "add " + std::string(key) + " = " + example);
  }

  const toml::table& table_;
  std::string where_;
  std::vector<ScenarioProblem>& problems_;
  std::set<std::string> asked_;
};

std::vector<std::string> metric_names(MetricScope least) {
  std::vector<std::string> names;
  for (const MetricInfo& m : metrics())
    if (m.scope >= least) names.emplace_back(m.name);
  return names;
}

Criterion read_criterion(const toml::table& table, const std::string& where, bool whole_exam,
                         std::vector<ScenarioProblem>& problems) {
  TableReader reader(table, where, problems);
  Criterion criterion;
  criterion.place = reader.place("metric");
  const std::string name = reader.text("metric");
  criterion.full = reader.number("full", {-1e6, 1e6});
  criterion.zero = reader.number("zero", {-1e6, 1e6});
  criterion.weight = reader.number("weight", {0, 1000}, 1);
  criterion.critical = reader.yes_or_no("critical", false);
  if (table.contains("weight") && criterion.weight == 0)
    reader.problem(reader.place("weight"), "has no weight", "give it one above 0, or remove the criterion");

  const auto metric = find_metric(name);
  if (!metric) {
    if (!name.empty())
      reader.problem(criterion.place, "names the metric '" + name + "', which does not exist",
                     suggest(name, metric_names(whole_exam ? MetricScope::motion : MetricScope::picture)));
    return criterion;
  }
  criterion.metric = *metric;
  const MetricInfo& m = info(*metric);
  if (whole_exam && m.scope != MetricScope::motion)
    reader.problem(criterion.place, "asks for " + name + ", which only a step has", "move it to a [[step.criterion]]");
  const bool right_way = m.less_is_better ? criterion.full < criterion.zero : criterion.full > criterion.zero;
  if (table.contains("full") && table.contains("zero") && !right_way)
    reader.problem(
        reader.place("full"), "gives full points at " + plain(criterion.full) + " and none at " + plain(criterion.zero),
        std::string("for ") + name + " 'full' has to be " + (m.less_is_better ? "below" : "above") + " 'zero'");
  return criterion;
}

std::vector<Criterion> read_criteria(TableReader& parent, const std::string& where, bool whole_exam,
                                     std::vector<ScenarioProblem>& problems) {
  std::vector<Criterion> criteria;
  std::set<Metric> seen;
  for (const toml::table* table : parent.tables("criterion", kMostCriteria)) {
    const std::string name = "criterion " + std::to_string(criteria.size() + 1) + where;
    const std::size_t problems_before = problems.size();
    criteria.push_back(read_criterion(*table, name, whole_exam, problems));
    if (problems.size() == problems_before && !seen.insert(criteria.back().metric).second)
      problems.push_back({criteria.back().place,
                          name + " marks " + std::string(info(criteria.back().metric).name) + " a second time",
                          "keep one criterion for each metric"});
  }
  return criteria;
}

std::vector<Tolerance> read_tolerance(const toml::table& table, const std::string& where,
                                      std::vector<ScenarioProblem>& problems) {
  std::vector<std::string> usable;
  for (const MetricInfo& m : metrics())
    if (m.scope == MetricScope::picture) usable.emplace_back(m.name);

  const auto problem = [&](const toml::source_region& source, const std::string& what, const std::string& name,
                           const std::string& remedy) {
    problems.push_back({place_of(source), "the tolerance of " + where + " has " + what + " '" + name + "'", remedy});
  };
  std::vector<Tolerance> tolerance;
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const auto metric = find_metric(name);
    const double limit = TableReader::is_number(node) ? *node.template value<double>() : -1;
    if (!metric || info(*metric).scope != MetricScope::picture)
      problem(key.source(), "what is no metric of a picture,", name, suggest(name, usable));
    else if (!(limit >= 0 && limit <= kLargestLimit))
      problem(node.source(), "no usable limit for", name, "write a number from 0 to " + plain(kLargestLimit));
    else
      tolerance.push_back({*metric, limit, place_of(key.source())});
  }
  if (table.empty())
    problems.push_back({place_of(table.source()), "the tolerance of " + where + " is empty",
                        "add a limit, for example plane_distance_mm = 5"});
  // A table's keys are sorted by name; whoever reads the screen wants the order of the file.
  std::sort(tolerance.begin(), tolerance.end(), [](const Tolerance& a, const Tolerance& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  return tolerance;
}

Step read_step(const toml::table& table, std::size_t number, double exam_limit_s,
               std::vector<ScenarioProblem>& problems) {
  const std::string where = "step " + std::to_string(number);
  TableReader reader(table, where, problems);
  Step step;
  step.kind = reader.text("kind");
  if (!step.kind.empty() && step.kind != "find_view")
    reader.problem(reader.place("kind"), "is of the kind '" + step.kind + "', which does not exist",
                   suggest(step.kind, {"find_view"}));
  step.title = reader.text("title");
  step.instruction = reader.text("instruction");
  step.view = reader.text("view");
  step.view_place = reader.place("view");
  step.hold_s = reader.number("hold_s", {0.1, 60}, 1.0);
  step.time_limit_s = reader.number("time_limit_s", {1, kLongestStep_s}, exam_limit_s);
  if (table.contains("hold_s") && table.contains("time_limit_s") && step.hold_s >= step.time_limit_s)
    reader.problem(reader.place("hold_s"), "has to be held longer than its time limit allows",
                   "shorten hold_s or raise time_limit_s");
  if (const toml::table* tolerance = reader.table("tolerance", true))
    step.tolerance = read_tolerance(*tolerance, where, problems);
  step.criteria = read_criteria(reader, " of " + where, false, problems);
  return step;
}

/// The phantom's options as text, as the phantom's maker takes them.
std::vector<std::pair<std::string, std::string>> read_options(const toml::table& table,
                                                              std::vector<ScenarioProblem>& problems) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (const auto text = node.template value_exact<std::string>()) {
      options.emplace_back(name, *text);
    } else if (const auto yes = node.template value_exact<bool>()) {
      options.emplace_back(name, *yes ? "true" : "false");
    } else if (TableReader::is_number(node)) {
      options.emplace_back(name, plain(*node.template value<double>()));
    } else {
      problems.push_back({place_of(node.source()), "the phantom's option '" + name + "' is no single value",
                          "write true, false, a number or a text"});
    }
  }
  return options;
}

Scenario read_tables(const toml::table& root, std::vector<ScenarioProblem>& problems) {
  TableReader reader(root, "the scenario", problems);
  Scenario scenario;
  const double format = reader.number("format", {1, 1e6});
  if (root.contains("format") && format != Scenario::kFormat)
    reader.problem(reader.place("format"),
                   "is written for format " + plain(format) + " and this program reads format 1",
                   "set format = 1 and check the file against it, or use a newer program");
  scenario.title = reader.text("title");
  scenario.case_name = reader.text("case");
  scenario.briefing = reader.text("briefing", false);
  scenario.pass_mark_percent = reader.number("pass_mark_percent", {0, 100}, 80);
  scenario.time_limit_s = reader.number("time_limit_s", {1, kLongestExam_s});
  if (const toml::table* options = reader.table("phantom", false)) {
    scenario.phantom_options = read_options(*options, problems);
    if (!scenario.case_name.empty() && scenario.case_name != "abdomen")
      reader.problem(reader.place("phantom"), "gives phantom options for the case '" + scenario.case_name + "'",
                     "remove [phantom], or set case = \"abdomen\"");
  }
  for (const toml::table* table : reader.tables("step", kMostSteps))
    scenario.steps.push_back(read_step(*table, scenario.steps.size() + 1, scenario.time_limit_s, problems));
  if (!root.contains("step")) reader.problem({1, 1}, "has no steps", "add a [[step]]");
  scenario.criteria = read_criteria(reader, " of the exam", true, problems);

  const bool marked = !scenario.criteria.empty() || std::any_of(scenario.steps.begin(), scenario.steps.end(),
                                                                [](const Step& s) { return !s.criteria.empty(); });
  if (!marked && !scenario.steps.empty()) reader.problem({1, 1}, "marks nothing", "add a [[step.criterion]] to a step");
  return scenario;
}

std::string in_words(const ScenarioProblem& p) {
  return "line " + std::to_string(p.place.line) + ", column " + std::to_string(p.place.column) + ": " + p.problem +
         "; " + p.remedy;
}

std::string all_in_words(const std::vector<ScenarioProblem>& problems) {
  std::string text = "correct them:";
  for (const ScenarioProblem& p : problems) text += "\n  " + in_words(p);
  return text;
}

InputError as_input_error(const std::string& file, const std::vector<ScenarioProblem>& problems) {
  if (problems.size() > 1)
    return InputError(file, "", std::to_string(problems.size()) + " problems", all_in_words(problems));
  const ScenarioProblem& p = problems.front();
  return InputError(file, "line " + std::to_string(p.place.line) + ", column " + std::to_string(p.place.column),
                    p.problem, p.remedy);
}

std::vector<ScenarioProblem> in_order_of_file(std::vector<ScenarioProblem> problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const ScenarioProblem& a, const ScenarioProblem& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  return problems;
}

}  // namespace

ScenarioError::ScenarioError(const std::string& file, std::vector<ScenarioProblem> problems)
    : InputError(as_input_error(file, in_order_of_file(problems))), problems_(in_order_of_file(std::move(problems))) {}

Scenario parse_scenario(std::string_view text, const std::filesystem::path& name) {
  std::vector<ScenarioProblem> problems;
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    problems.push_back({place_of(error.source()), "this is no TOML: " + std::string(error.description()),
                        "correct the line; toml.io explains the notation"});
    throw ScenarioError(name.string(), std::move(problems));
  }
  Scenario scenario = read_tables(root, problems);
  if (!problems.empty()) throw ScenarioError(name.string(), std::move(problems));
  scenario.file = name;
  scenario.text = text;
  scenario.digest = digest_of(text);
  return scenario;
}

Scenario read_scenario(const std::filesystem::path& file) {
  return parse_scenario(read_file(file, kLargestFile), file);
}

}  // namespace insonate
