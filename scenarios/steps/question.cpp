#include "scenarios/steps/question.h"

#include <algorithm>
#include <cmath>

#include "scenarios/steps/structures.h"
#include "scenarios/words.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

class QuestionRun : public StepRun {
public:
  QuestionRun(const Question& asked, const LabelIndex& labels) : asked_(asked) {
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
  std::string why_no_value() const override { return answer_ ? "the answer is not a number." : "there was no answer."; }

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
std::string choice_of(const TomlTable& table, const char* key, const std::vector<std::string>& choices) {
  const std::string word = table.text(key);
  if (!word.empty() && !choices.empty() && std::find(choices.begin(), choices.end(), word) == choices.end())
    table.report(key, in_quotes(key) + " is " + in_quotes(word) + ", which is not among the choices",
                 suggest(word, choices));
  return word;
}

}  // namespace

std::shared_ptr<const StepTask> Question::read(const TomlTable& table, const Step&) {
  auto task = std::make_shared<Question>();
  task->answer = Answer(table.choice("answer", {"choice", "number", "text"}, std::size_t(Answer::choice)));
  if (task->answer == Answer::number) {
    task->right_number = table.number("right_number", {-1e6, 1e6});
    task->within = table.number("within", {0, 1e6}, 0);
    task->unit = table.text("unit", "");
  } else if (task->answer == Answer::choice) {
    task->choices = table.texts("choices", 1, 10);
    if (task->choices.size() == 1) table.report("choices", "there is only one choice", "offer two or more");
    std::vector<std::string> sorted = task->choices;
    std::sort(sorted.begin(), sorted.end());
    if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
      table.report("choices", "the choice " + in_quotes(*twice) + " is offered twice", "write each choice once");
    if (table.has("finding")) task->findings = table.texts("finding", 1, 20);
    task->finding_place = table.place("finding");
    if (task->findings.empty()) {
      task->right = choice_of(table, "right", task->choices);
    } else {
      task->if_present = choice_of(table, "if_present", task->choices);
      task->if_absent = choice_of(table, "if_absent", task->choices);
      if (!task->if_present.empty() && task->if_present == task->if_absent)
        table.report("if_absent", "the right answer is the same with the finding as without", "give another one");
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
                     std::vector<Mistake>& problems) const {
  check_structures(findings, finding_place, labels.subject(), where, problems);
}

StepBegin Question::prepare(const StepWorld& world) const {
  return [this, &labels = world.labels](double) { return std::make_unique<QuestionRun>(*this, labels); };
}

}  // namespace insonate
