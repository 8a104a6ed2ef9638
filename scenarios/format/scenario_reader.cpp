#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "scenarios/format/variants.h"
#include "scenarios/scenario.h"
#include "scenarios/steps/step_kinds.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::size_t kMaxSteps = 100;
constexpr std::size_t kMaxCriteria = 100;
constexpr std::size_t kMaxHints = 10;
constexpr double kLongestExam_s = 36000;
constexpr double kLongestStep_s = 3600;

/// The settings that a scenario can lock.
constexpr std::array kSettings{ActionKind::probe, ActionKind::depth, ActionKind::frequency, ActionKind::gain};

std::set<ActionKind> read_locked(const TomlTable& table) {
  std::vector<std::string> words;
  for (const ActionKind setting : kSettings) words.emplace_back(word_of(setting));
  std::set<ActionKind> locked;
  if (!table.has("locked")) return locked;
  for (const std::string& word : table.texts("locked", 1, words.size())) {
    const std::size_t index = std::size_t(std::find(words.begin(), words.end(), word) - words.begin());
    if (index < words.size())
      locked.insert(kSettings[index]);
    else
      table.report("locked", in_quotes(word) + " is not a setting", suggest(word, words));
  }
  if (!locked.contains(ActionKind::probe) &&
      (locked.contains(ActionKind::depth) || locked.contains(ActionKind::frequency)))
    table.report("locked", "depth or frequency is locked, but not the probe, which brings its own", "add \"probe\"");
  return locked;
}

std::vector<std::string> metric_names(MetricScope least) {
  std::vector<std::string> names;
  for (const MetricInfo& m : metrics())
    if (m.scope >= least) names.emplace_back(m.name);
  return names;
}

Criterion read_criterion(const TomlTable& table, bool whole_exam) {
  Criterion criterion;
  criterion.place = table.place("metric");
  const std::string name = table.text("metric");
  const std::size_t mistakes_before = table.mistake_count();
  criterion.full = table.number("full", {-1e6, 1e6});
  criterion.zero = table.number("zero", {-1e6, 1e6});
  const bool has_limits = table.mistake_count() == mistakes_before;
  criterion.weight = table.number("weight", {0, 1000}, 1);
  criterion.critical = table.boolean("critical", false);
  if (table.has("weight") && criterion.weight == 0)
    table.report("weight", "'weight' is 0", "give a number above 0, or remove the criterion");

  const auto metric = find_metric(name);
  criterion.sound = metric.has_value();
  if (!metric) {
    if (!name.empty())
      table.report("metric", "there is no metric " + in_quotes(name),
                   suggest(name, metric_names(whole_exam ? MetricScope::motion : MetricScope::picture)));
    return criterion;
  }
  criterion.metric = *metric;
  const MetricInfo& m = info(*metric);
  if (whole_exam && m.scope != MetricScope::motion)
    table.report("metric", "only a step has the metric " + name, "move it to a [[step.criterion]]");
  const bool right_way = m.less_is_better ? criterion.full < criterion.zero : criterion.full > criterion.zero;
  if (has_limits && !right_way)
    table.report("full", "'full' is " + exact_text(criterion.full) + " and 'zero' is " + exact_text(criterion.zero),
                 std::string("for ") + name + ", give a 'full' " + (m.less_is_better ? "below" : "above") + " 'zero'");
  return criterion;
}

std::vector<Criterion> read_criteria(const TomlTable& parent, bool whole_exam) {
  std::vector<Criterion> criteria;
  std::set<Metric> seen;
  for (const TomlTable& table : parent.tables("criterion", kMaxCriteria)) {
    const std::size_t mistakes_before = table.mistake_count();
    criteria.push_back(read_criterion(table, whole_exam));
    if (table.mistake_count() == mistakes_before && !seen.insert(criteria.back().metric).second)
      table.report("metric", "another criterion marks " + std::string(info(criteria.back().metric).name) + " already",
                   "keep one criterion for each metric");
  }
  return criteria;
}

/// Reports criteria that the step's kind does not measure.
void check_criteria(const Step& step, const TomlTable& table) {
  const std::vector<Metric> own = step.task->metrics();
  const auto measures = [&](const MetricInfo& m) {
    return m.scope == MetricScope::motion || (m.scope == MetricScope::picture && step.task->judges_picture()) ||
           std::find(own.begin(), own.end(), m.metric) != own.end();
  };
  for (const Criterion& criterion : step.criteria) {
    const MetricInfo& m = info(criterion.metric);
    if (!criterion.sound || measures(m)) continue;
    std::string known;
    for (const MetricInfo& other : metrics())
      if (other.scope != MetricScope::motion && measures(other))
        known += (known.empty() ? "" : ", ") + std::string(other.name);
    table.report_at(criterion.place, "a step of the kind " + step.kind + " does not measure " + std::string(m.name),
                    "use a metric of motion" + (known.empty() ? "" : ", or one of " + known));
  }
}

/// Reports settings that the exam locks and the step asks to change.
void check_locks(const Step& step, const Scenario& exam, const TomlTable& table) {
  for (const ActionKind setting : step.task->settings())
    if (exam.locked.contains(setting))
      table.report("kind", "the step asks for the " + std::string(word_of(setting)) + ", which the exam locks",
                   "remove it from the step, or from 'locked'");
  for (const Criterion& criterion : step.criteria)
    if (criterion.sound && criterion.metric == Metric::depth_use_percent && exam.locked.contains(ActionKind::depth))
      table.report_at(criterion.place, "the step asks for depth_use_percent, but the exam locks the depth",
                      "remove the criterion, or \"depth\" from 'locked'");
}

double read_cost(const TomlTable& table, Scenario::Difficulty difficulty) {
  if (table.kind("cost") == TomlKind::list) return table.numbers("cost", 3, {0, 1000})[std::size_t(difficulty)];
  return table.number("cost", {0, 1000});
}

/// Marks the keys that some kind of step asks for, and reports nothing. Any other key is wrong, whatever the kind is.
void ask_as_every_kind(const TomlTable& table, const Step& step) {
  const std::size_t before = table.mistake_count();
  for (const StepKind& kind : step_kinds()) kind.read(table, step);
  table.forget_mistakes_after(before);
}

const StepKind* kind_called(std::string_view name) {
  for (const StepKind& kind : step_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

/// Returns the kind that a step has. For a misspelt one, which is reported, it returns the one that is probably
/// meant, so that the step's other mistakes are reported too.
const StepKind* read_kind(const TomlTable& table) {
  const std::string word = table.text("kind");
  const StepKind* kind = kind_called(word);
  if (word.empty() || kind) return kind;
  std::vector<std::string> names;
  for (const StepKind& known : step_kinds()) names.emplace_back(known.name);
  table.report("kind", "there is no kind of step " + in_quotes(word), suggest(word, names));
  const std::optional<std::string> meant = similar_name(word, names);
  return meant ? kind_called(*meant) : nullptr;
}

Step read_step(const TomlTable& table, const Scenario& exam) {
  const std::size_t mistakes_before = table.mistake_count();
  const StepKind* kind = read_kind(table);
  const bool misspelt = table.mistake_count() > mistakes_before;
  Step step;
  if (kind) step.kind = kind->name;
  step.title = table.text("title");
  step.instruction = table.text("instruction");
  step.name = table.text("name", "");
  step.time_limit_s = table.number("time_limit_s", {1, kLongestStep_s}, exam.time_limit_s);
  step.counts = table.boolean("counts", true);
  for (const TomlTable& hint : table.tables("hint", kMaxHints))
    step.hints.push_back({hint.text("text"), read_cost(hint, exam.difficulty)});
  if (table.has("next")) {
    const TomlTable next = table.table("next");
    step.if_good = next.text("good", "");
    step.if_poor = next.text("poor", "");
    if (exam.order == Scenario::Order::free)
      table.report("next", "the step names its next one, but the order is free",
                   "remove [step.next], or set order = \"fixed\"");
  }
  if (!kind || kind->view != ViewUse::none) {
    step.view = kind && kind->view == ViewUse::required ? table.text("view") : table.text("view", "");
    step.view_place = table.place("view");
  }
  if (!kind) {
    step.sound = false;
    step.criteria = read_criteria(table, false);
    ask_as_every_kind(table, step);
    return step;
  }
  const std::size_t mistakes_before_task = table.mistake_count();
  step.task = kind->read(table, step);
  step.sound = !misspelt && table.mistake_count() == mistakes_before_task;
  step.criteria = read_criteria(table, false);
  if (step.task) check_criteria(step, table);
  if (step.task) check_locks(step, exam, table);
  return step;
}

/// Checks that names are unique and that steps go on to existing later steps.
void check_names(const std::vector<Step>& steps, const std::vector<TomlTable>& tables) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].name.empty()) continue;
    if (steps[i].name == "end" || std::find(names.begin(), names.end(), steps[i].name) != names.end())
      tables[i].report("name", "the name " + in_quotes(steps[i].name) + " is taken", "give it another");
    names.push_back(steps[i].name);
  }
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (const std::string& next : {steps[i].if_good, steps[i].if_poor}) {
      if (next.empty() || next == "end") continue;
      std::vector<std::string> later{"end"};
      for (std::size_t k = i + 1; k < steps.size(); ++k)
        if (!steps[k].name.empty()) later.push_back(steps[k].name);
      if (std::find(later.begin(), later.end(), next) == later.end())
        tables[i].report("name", "the next step " + in_quotes(next) + " is not a later step", suggest(next, later));
    }
}

Scenario read_tables(const TomlTable& table, const Variant* variant) {
  Scenario scenario;
  const double format = table.number("format", {1, 1e6});
  if (format != 1 && format != Scenario::kFormat)
    table.report(
        "format",
        "the scenario is written for format " + exact_text(format) + " and this program reads formats 1 and " +
            std::to_string(Scenario::kFormat),
        "set format = " + std::to_string(Scenario::kFormat) + " and check the file against it, or use a newer program");
  scenario.title = table.text("title");
  const bool case_is_replaced = variant && !variant->case_name.empty();
  scenario.case_name = case_is_replaced ? table.text("case", "") : table.text("case");
  scenario.case_place = table.place("case");
  if (case_is_replaced) {
    scenario.case_name = variant->case_name;
    scenario.case_place = variant->case_place;
  }
  scenario.briefing = unwrapped(table.text("briefing", ""));
  scenario.pass_mark_percent = table.number("pass_mark_percent", {0, 100}, 80);
  scenario.time_limit_s = table.number("time_limit_s", {1, kLongestExam_s});
  scenario.locked = read_locked(table);
  scenario.order = Scenario::Order(table.choice("order", {"fixed", "free"}, std::size_t(Scenario::Order::fixed)));
  scenario.difficulty = Scenario::Difficulty(
      table.choice("difficulty", {"easy", "medium", "hard"}, std::size_t(Scenario::Difficulty::medium)));
  if (table.has("phantom")) {
    scenario.phantom_options = read_options(table.table("phantom"), &scenario.option_places);
    if (!scenario.case_name.empty() && scenario.case_name != "abdomen")
      table.report("phantom", "there are phantom options for the case " + in_quotes(scenario.case_name),
                   "remove [phantom], or set case = \"abdomen\"");
  }
  if (variant) {
    for (const auto& option : variant->phantom_options) {
      std::erase_if(scenario.phantom_options, [&](const auto& one) { return one.first == option.first; });
      scenario.phantom_options.push_back(option);
      scenario.option_places[option.first] = variant->option_places.at(option.first);
    }
    std::sort(scenario.phantom_options.begin(), scenario.phantom_options.end());
    scenario.variant = variant->name;
    if (!variant->phantom_options.empty() && scenario.case_name != "abdomen")
      table.report("variant", "there are phantom options for the case " + in_quotes(scenario.case_name),
                   "remove them, or set case = \"abdomen\"");
  }
  read_variants(table);  // the variants were read before; this call registers and checks their keys
  const std::vector<TomlTable> steps = table.tables("step", kMaxSteps);
  for (const TomlTable& step : steps) {
    scenario.steps.push_back(read_step(step, scenario));
    if (!scenario.steps.back().counts && scenario.steps.size() > 1 && scenario.steps[scenario.steps.size() - 2].counts)
      step.report("counts", "this warm-up is behind a step that counts", "move it to the front");
  }
  check_names(scenario.steps, steps);
  if (!table.has("step")) table.report_at({1, 1}, "there are no steps", "add a [[step]]");
  scenario.criteria = read_criteria(table, true);

  const bool marked =
      !scenario.criteria.empty() || std::any_of(scenario.steps.begin(), scenario.steps.end(),
                                                [](const Step& s) { return s.counts && !s.criteria.empty(); });
  if (!marked && !scenario.steps.empty())
    table.report_at({1, 1}, "the scenario marks nothing", "add a [[step.criterion]] to a step");
  table.refuse_unknown_keys();
  return scenario;
}

ReadScenario parse_every_variant(std::string_view text, const std::filesystem::path& name) {
  ReadScenario read;
  const TomlDocument document(name.string(), text, OnMistake::collect);
  if (!document.mistakes().empty()) {
    read.problems = document.mistakes();
    return read;
  }
  const std::vector<Variant> variants = read_variants(document.root());  // read_tables() reports their mistakes
  const auto read_with = [&](const Variant* variant) {
    TomlDocument spelt(name.string(), text, OnMistake::collect);
    if (variant) spell_out(spelt, *variant);
    read.variants.push_back(read_tables(spelt.root(), variant));
    read.problems.insert(read.problems.end(), spelt.mistakes().begin(), spelt.mistakes().end());
    read.variants.back().file = name;
    read.variants.back().text = text;
    read.variants.back().digest = digest_of(text);
    read.variants.back().variants = variants.size();
  };
  if (variants.empty()) read_with(nullptr);
  for (const Variant& variant : variants) read_with(&variant);
  const double format = document.root().number("format", {1, Scenario::kFormat}, 0);
  if (format != 1 && format != Scenario::kFormat) read.variants.clear();
  return read;
}

}  // namespace

Scenario parse_scenario(std::string_view text, const std::filesystem::path& name, std::uint32_t seed) {
  // All variants are read, so that the one that a seed selects has been checked.
  ReadScenario read = parse_every_variant(text, name);
  if (!read.problems.empty()) throw ScenarioError(name.string(), read.problems);
  Scenario scenario = std::move(read.variants[selected_variant(seed, read.variants.size())]);
  scenario.seed = seed;
  return scenario;
}

ReadScenario read_every_variant(const std::filesystem::path& file) {
  return parse_every_variant(read_file(file, kLargestFile), file);
}

Scenario read_scenario(const std::filesystem::path& file, std::uint32_t seed) {
  return parse_scenario(read_file(file, kLargestFile), file, seed);
}

}  // namespace insonate
