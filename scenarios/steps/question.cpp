#include "scenarios/steps/question.h"

#include <algorithm>
#include <cmath>

#include "scenarios/format/table_reader.h"
#include "scenarios/steps/structures.h"
#include "scenarios/words.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

class Run : public StepRun {
public:
  Run(const Question& asked, const LabelIndex& labels) : asked_(asked) {
    right_ = asked.right;
    if (!asked.findings.empty())
      right_ = StructureSet(labels, asked.findings).any_voxel() ? asked.if_present : asked.if_absent;
    if (asked.answer == Question::Answer::number) right_ = short_number(asked.right_number);
  }

  void act(const Action& action, const Moment&) override {
    if (action.kind == ActionKind::answer && !answer_) answer_ = action.text;
  }
  bool done() const override { return answer_.has_value(); }
  double share_done() const override { return done() ? 1 : 0; }

  void finish(StepOutcome, double, StepResult& result) const override {
    if (!answer_) return;
    result.facts.emplace_back("answer", *answer_);
    if (asked_.answer == Question::Answer::text) return;
    result.facts.emplace_back("right answer", right_);
    bool right = *answer_ == right_;
    if (asked_.answer == Question::Answer::number) {
      const auto number = AnswerInput::number_in(*answer_);
      if (number) result.values.emplace_back(Metric::answer_error, std::abs(*number - asked_.right_number));
      right = number && std::abs(*number - asked_.right_number) <= asked_.within;
    }
    result.values.emplace_back(Metric::answer_right_percent, right ? 100 : 0);
  }

private:
  const Question& asked_;
  std::string right_;
  std::optional<std::string> answer_;
};

/// Reads a text that must be one of the choices.
std::string choice_of(TableReader& table, const char* key, const std::vector<std::string>& choices) {
  const std::string word = table.text(key);
  if (!word.empty() && !choices.empty() && std::find(choices.begin(), choices.end(), word) == choices.end())
    table.problem(table.place(key), "has " + std::string(key) + " = '" + word + "', which is none of its choices",
                  suggest(word, choices));
  return word;
}

}  // namespace

std::shared_ptr<const StepTask> Question::read(TableReader& table, const Step&) {
  auto task = std::make_shared<Question>();
  const std::string answer = table.choice("answer", {"choice", "number", "text"}, false);
  if (answer == "text") {
    task->answer = Answer::text;
  } else if (answer == "number") {
    task->answer = Answer::number;
    task->right_number = table.number("right_number", {-1e6, 1e6});
    task->within = table.number("within", {0, 1e6}, 0.0);
    task->unit = table.text("unit", false);
  } else {
    task->choices = table.texts("choices", 10);
    if (task->choices.size() == 1) table.problem(table.place("choices"), "has one choice", "offer two or more");
    std::vector<std::string> sorted = task->choices;
    std::sort(sorted.begin(), sorted.end());
    if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
      table.problem(table.place("choices"), "offers '" + *twice + "' twice", "write each choice once");
    task->findings = table.texts("finding", 20, false);
    task->finding_place = table.place("finding");
    if (task->findings.empty()) {
      task->right = choice_of(table, "right", task->choices);
    } else {
      task->if_present = choice_of(table, "if_present", task->choices);
      task->if_absent = choice_of(table, "if_absent", task->choices);
      if (!task->if_present.empty() && task->if_present == task->if_absent)
        table.problem(table.place("if_absent"), "has the same right answer with the finding as without",
                      "give another one");
    }
  }
  return task;
}

std::vector<Metric> Question::metrics() const {
  if (answer == Answer::text) return {};
  if (answer == Answer::number) return {Metric::answer_right_percent, Metric::answer_error};
  return {Metric::answer_right_percent};
}

void Question::check(const Step&, const LabelIndex& labels, const std::string& where,
                     std::vector<ScenarioProblem>& problems) const {
  check_structures(findings, finding_place, labels.subject(), where, problems);
}

StepBegin Question::prepare(const StepWorld& world) const {
  return [this, &labels = world.labels](double) { return std::make_unique<Run>(*this, labels); };
}

}  // namespace insonate
