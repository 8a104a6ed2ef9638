#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "scenarios/format/table_node.h"
#include "scenarios/format/table_reader.h"
#include "scenarios/format/variants.h"
#include "scenarios/scenario.h"
#include "scenarios/steps/step_kinds.h"
#include "sim/core/digest.h"
#include "sim/core/files.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/core/toml_table.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::size_t kMostSteps = 100;
constexpr std::size_t kMostCriteria = 100;
constexpr std::size_t kMostHints = 10;
constexpr double kLongestExam_s = 36000;
constexpr double kLongestStep_s = 3600;

std::size_t index_of(const std::vector<std::string>& words, const std::string& word) {
  return std::size_t(std::find(words.begin(), words.end(), word) - words.begin());
}

/// The settings that a scenario can lock.
constexpr std::array kSettings{ActionKind::probe, ActionKind::depth, ActionKind::frequency, ActionKind::gain};

std::set<ActionKind> read_locked(TableReader& reader) {
  std::vector<std::string> words;
  for (const ActionKind setting : kSettings) words.emplace_back(word_of(setting));
  std::set<ActionKind> locked;
  for (const std::string& word : reader.texts("locked", words.size(), false)) {
    const std::size_t index = index_of(words, word);
    if (index < words.size())
      locked.insert(kSettings[index]);
    else
      reader.problem(reader.place("locked"), "locks '" + word + "', which is no setting", suggest(word, words));
  }
  if (!locked.contains(ActionKind::probe) &&
      (locked.contains(ActionKind::depth) || locked.contains(ActionKind::frequency)))
    reader.problem(reader.place("locked"), "locks depth or frequency, but not the probe, which brings its own",
                   "add \"probe\"");
  return locked;
}

std::vector<std::string> metric_names(MetricScope least) {
  std::vector<std::string> names;
  for (const MetricInfo& m : metrics())
    if (m.scope >= least) names.emplace_back(m.name);
  return names;
}

Criterion read_criterion(TableReader& reader, bool whole_exam) {
  Criterion criterion;
  criterion.place = reader.place("metric");
  const std::string name = reader.text("metric");
  criterion.full = reader.number("full", {-1e6, 1e6});
  criterion.zero = reader.number("zero", {-1e6, 1e6});
  criterion.weight = reader.number("weight", {0, 1000}, 1);
  criterion.critical = reader.yes_or_no("critical", false);
  if (reader.has("weight") && criterion.weight == 0)
    reader.problem(reader.place("weight"), "has no weight", "give it one above 0, or remove the criterion");

  const auto metric = find_metric(name);
  criterion.sound = metric.has_value();
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
  if (reader.has("full") && reader.has("zero") && !right_way)
    reader.problem(
        reader.place("full"), "gives full points at " + plain(criterion.full) + " and none at " + plain(criterion.zero),
        std::string("for ") + name + " 'full' has to be " + (m.less_is_better ? "below" : "above") + " 'zero'");
  return criterion;
}

std::vector<Criterion> read_criteria(TableReader& parent, const std::string& where, bool whole_exam) {
  std::vector<Criterion> criteria;
  std::set<Metric> seen;
  for (const auto& table : parent.tables("criterion", kMostCriteria, "criterion ", " of " + where)) {
    const std::size_t problems_before = table->problems().size();
    criteria.push_back(read_criterion(*table, whole_exam));
    if (table->problems().size() == problems_before && !seen.insert(criteria.back().metric).second)
      table->problem(criteria.back().place,
                     "marks " + std::string(info(criteria.back().metric).name) + " a second time",
                     "keep one criterion for each metric");
  }
  return criteria;
}

/// Reports criteria that the step's kind does not measure.
void check_criteria(const Step& step, const std::string& where, std::vector<ScenarioProblem>& problems) {
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
    problems.push_back(
        {criterion.place,
         where + " asks for " + std::string(m.name) + ", which a step of the kind " + step.kind + " does not measure",
         "take one of motion" + (known.empty() ? "" : ", or one of " + known)});
  }
}

/// Reports settings that the exam locks and the step asks to change.
void check_locks(const Step& step, const Scenario& exam, TableReader& reader) {
  for (const ActionKind setting : step.task->settings())
    if (exam.locked.contains(setting))
      reader.problem(reader.place("kind"), "asks for the " + std::string(word_of(setting)) + ", which the exam locks",
                     "remove it from the step, or from 'locked'");
  for (const Criterion& criterion : step.criteria)
    if (criterion.sound && criterion.metric == Metric::depth_use_percent && exam.locked.contains(ActionKind::depth))
      reader.problem(criterion.place, "asks for depth_use_percent, but the exam locks the depth",
                     "remove the criterion, or \"depth\" from 'locked'");
}

double read_cost(TableReader& table, Scenario::Difficulty difficulty) {
  if (table.is_list("cost")) return table.one_of_three("cost", std::size_t(difficulty), {0, 1000});
  return table.number("cost", {0, 1000});
}

Step read_step(TableReader& reader, const Scenario& exam) {
  Step step;
  step.kind = reader.text("kind");
  std::vector<std::string> names;
  const StepKind* kind = nullptr;
  for (const StepKind& k : step_kinds()) {
    names.emplace_back(k.name);
    if (step.kind == k.name) kind = &k;
  }
  if (!step.kind.empty() && !kind)
    reader.problem(reader.place("kind"), "is of the kind '" + step.kind + "', which does not exist",
                   suggest(step.kind, names));
  step.title = reader.text("title");
  step.instruction = reader.text("instruction");
  step.name = reader.text("name", false);
  step.time_limit_s = reader.number("time_limit_s", {1, kLongestStep_s}, exam.time_limit_s);
  step.counts = reader.yes_or_no("counts", true);
  for (const auto& hint : reader.tables("hint", kMostHints, "hint ", " of " + reader.where()))
    step.hints.push_back({hint->text("text"), read_cost(*hint, exam.difficulty)});
  if (const auto next = reader.table("next", false, "the next of " + reader.where())) {
    step.if_good = next->text("good", false);
    step.if_poor = next->text("poor", false);
    if (exam.order == Scenario::Order::free)
      reader.problem(reader.place("next"), "goes on to a step of its own, but the order is free",
                     "remove [step.next], or set order = \"fixed\"");
  }
  if (!kind || kind->view != ViewUse::none) {
    step.view = reader.text("view", kind && kind->view == ViewUse::required);
    step.view_place = reader.place("view");
  }
  if (!kind) {
    step.sound = false;
    step.criteria = read_criteria(reader, reader.where(), false);
    reader.ignore_others();
    return step;
  }
  const std::size_t problems_before = reader.problems().size();
  step.task = kind->read(reader, step);
  step.sound = reader.problems().size() == problems_before;
  step.criteria = read_criteria(reader, reader.where(), false);
  if (step.task) check_criteria(step, reader.where(), reader.problems());
  if (step.task) check_locks(step, exam, reader);
  return step;
}

const std::vector<std::string> kOrders{"fixed", "free"};
const std::vector<std::string> kDifficulties{"easy", "medium", "hard"};

/// Checks that names are unique and that steps go on to existing later steps.
void check_names(const std::vector<Step>& steps, const std::vector<SourcePlace>& places,
                 std::vector<ScenarioProblem>& problems) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].name.empty()) continue;
    if (steps[i].name == "end" || std::find(names.begin(), names.end(), steps[i].name) != names.end())
      problems.push_back({places[i],
                          "step " + std::to_string(i + 1) + " has the name '" + steps[i].name + "', which is taken",
                          "give it another"});
    names.push_back(steps[i].name);
  }
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (const std::string& next : {steps[i].if_good, steps[i].if_poor}) {
      if (next.empty() || next == "end") continue;
      std::vector<std::string> later{"end"};
      for (std::size_t k = i + 1; k < steps.size(); ++k)
        if (!steps[k].name.empty()) later.push_back(steps[k].name);
      if (std::find(later.begin(), later.end(), next) == later.end())
        problems.push_back({places[i],
                            "step " + std::to_string(i + 1) + " goes on to '" + next + "', which is no later step",
                            suggest(next, later)});
    }
}

Scenario read_tables(TableReader& reader, const Variant* variant) {
  Scenario scenario;
  const double format = reader.number("format", {1, 1e6});
  if (format != 1 && format != Scenario::kFormat)
    reader.problem(
        reader.place("format"),
        "is written for format " + plain(format) + " and this program reads formats 1 and " +
            std::to_string(Scenario::kFormat),
        "set format = " + std::to_string(Scenario::kFormat) + " and check the file against it, or use a newer program");
  scenario.title = reader.text("title");
  scenario.case_name = reader.text("case", !variant || variant->case_name.empty());
  scenario.case_place = reader.place("case");
  if (variant && !variant->case_name.empty()) {
    scenario.case_name = variant->case_name;
    scenario.case_place = variant->case_place;
  }
  scenario.briefing = unwrapped(reader.text("briefing", false));
  scenario.pass_mark_percent = reader.number("pass_mark_percent", {0, 100}, 80);
  scenario.time_limit_s = reader.number("time_limit_s", {1, kLongestExam_s});
  scenario.locked = read_locked(reader);
  scenario.order = Scenario::Order(index_of(kOrders, reader.choice("order", kOrders, false)));
  scenario.difficulty = reader.has("difficulty")
                            ? Scenario::Difficulty(index_of(kDifficulties, reader.choice("difficulty", kDifficulties)))
                            : Scenario::Difficulty::medium;
  if (const auto options = reader.table("phantom", false, "[phantom]")) {
    scenario.phantom_options = read_options(*options, &scenario.option_places);
    if (!scenario.case_name.empty() && scenario.case_name != "abdomen")
      reader.problem(reader.place("phantom"), "gives phantom options for the case '" + scenario.case_name + "'",
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
      reader.problem(reader.place("variant"), "has phantom options for the case '" + scenario.case_name + "'",
                     "remove them, or set case = \"abdomen\"");
  }
  read_variants(reader);  // the variants were read before; this call registers and checks their keys
  std::vector<SourcePlace> places;
  for (const auto& table : reader.tables("step", kMostSteps, "step ", "")) {
    scenario.steps.push_back(read_step(*table, scenario));
    places.push_back(table->place("name"));
    if (!scenario.steps.back().counts && scenario.steps.size() > 1 && scenario.steps[scenario.steps.size() - 2].counts)
      table->problem(table->place("counts"), "is a warm-up behind a step that counts", "move it to the front");
  }
  check_names(scenario.steps, places, reader.problems());
  if (!reader.has("step")) reader.problem({1, 1}, "has no steps", "add a [[step]]");
  scenario.criteria = read_criteria(reader, "the exam", true);

  const bool marked =
      !scenario.criteria.empty() || std::any_of(scenario.steps.begin(), scenario.steps.end(),
                                                [](const Step& s) { return s.counts && !s.criteria.empty(); });
  if (!marked && !scenario.steps.empty()) reader.problem({1, 1}, "marks nothing", "add a [[step.criterion]] to a step");
  return scenario;
}

std::string in_words(const ScenarioProblem& p) {
  return "line " + std::to_string(p.place.line) + ", column " + std::to_string(p.place.column) + ": " +
         in_one_line(p.problem) + "; " + in_one_line(p.remedy);
}

std::string all_in_words(const std::string& file, const std::vector<ScenarioProblem>& problems) {
  constexpr std::size_t kMostReported = 100;
  std::string text = in_one_line(file) + ": " + std::to_string(problems.size()) + " problems; correct them:";
  for (std::size_t i = 0; i < std::min(problems.size(), kMostReported); ++i) text += "\n  " + in_words(problems[i]);
  return text + (problems.size() > kMostReported ? "\n  and so on." : ".");
}

InputError as_input_error(const std::string& file, const std::vector<ScenarioProblem>& problems) {
  if (problems.size() > 1) return InputError(all_in_words(file, problems));
  const ScenarioProblem& p = problems.front();
  return InputError(file, "line " + std::to_string(p.place.line) + ", column " + std::to_string(p.place.column),
                    p.problem, p.remedy);
}

std::vector<ScenarioProblem> in_order_of_file(std::vector<ScenarioProblem> problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const ScenarioProblem& a, const ScenarioProblem& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  // A problem that several variants share is reported once.
  const auto same = [](const ScenarioProblem& a, const ScenarioProblem& b) {
    return a.place.line == b.place.line && a.place.column == b.place.column && a.problem == b.problem;
  };
  std::vector<ScenarioProblem> once;
  for (ScenarioProblem& p : problems) {
    auto told = once.rbegin();
    while (told != once.rend() && told->place.line == p.place.line && told->problem != p.problem) ++told;
    if (told == once.rend() || !same(*told, p)) once.push_back(std::move(p));
  }
  return once;
}

ReadScenario parse_every_variant(std::string_view text, const std::filesystem::path& name) {
  ReadScenario read;
  if (const int line = line_of_deep_key(text); line > 0) {
    read.problems.push_back(
        {{line, 1}, "a key has more than " + std::to_string(kMostKeyParts) + " parts between dots", "shorten it"});
    return read;
  }
  toml::table root;
  try {
    root = parse_toml_text(text);
  } catch (const toml::parse_error& error) {
    read.problems.push_back({{int(error.source().begin.line), int(error.source().begin.column)},
                             "this is no TOML: " + std::string(error.description()),
                             "correct the line; toml.io explains the notation"});
    return read;
  }
  std::vector<Variant> variants;
  {
    std::vector<ScenarioProblem> told_later;
    TableReader reader({&root}, "the scenario", told_later);
    reader.ignore_others();
    variants = read_variants(reader);
  }
  const auto read_with = [&](const Variant* variant) {
    toml::table spelt = parse_toml_text(text);  // parsed again, because a copy loses the values' source positions
    if (variant) spell_out(spelt, *variant, read.problems);
    TableReader reader({&spelt}, "the scenario", read.problems);
    read.variants.push_back(read_tables(reader, variant));
    read.variants.back().file = name;
    read.variants.back().text = text;
    read.variants.back().digest = digest_of(text);
    read.variants.back().variants = variants.size();
  };
  if (variants.empty()) read_with(nullptr);
  for (const Variant& variant : variants) read_with(&variant);
  const auto format = root["format"].value<double>();
  if (format != 1.0 && format != double(Scenario::kFormat)) read.variants.clear();
  return read;
}

}  // namespace

ScenarioError::ScenarioError(const std::string& file, std::vector<ScenarioProblem> problems)
    : InputError(as_input_error(file, in_order_of_file(problems))), problems_(in_order_of_file(std::move(problems))) {}

Scenario parse_scenario(std::string_view text, const std::filesystem::path& name, std::uint32_t seed) {
  // All variants are read, so that the one that a seed selects has been checked.
  ReadScenario read = parse_every_variant(text, name);
  if (!read.problems.empty()) throw ScenarioError(name.string(), std::move(read.problems));
  Scenario scenario = std::move(read.variants[drawn(seed, read.variants.size())]);
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
