#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"

namespace insonate {

class TomlTable;

/// kind = "question": answer the question, which is the step's instruction. The first answer counts and ends the step.
///
/// The right choice is given by name, or follows from the label map. With `finding`, `if_present` is right if one of
/// those structures has a voxel, and `if_absent` if none has. So one file serves patients with and without the finding.
struct Question : StepTask {
  using Answer = AnswerInput::Form;

  Answer answer = Answer::choice;     ///< answer = "choice" (default), "number", or "text" for the examiner
  std::vector<std::string> choices;   ///< choices = ["yes", "no"]: 2 to 10, for a choice
  std::string right;                  ///< right = "yes": for a choice, unless `finding` decides
  std::vector<std::string> findings;  ///< finding = ["gallstone"]: labels of the case
  std::string if_present, if_absent;  ///< if_present = "yes", if_absent = "no": two of the choices
  double right_number = 0;            ///< right_number = 30: for a number
  double within = 0;                  ///< within = 2: permitted deviation of a number; default 0
  std::string unit;                   ///< unit = "mm": shown beside a number; optional
  SourcePlace finding_place{};

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepInput input() const override { return AnswerInput{answer, choices, unit}; }
  std::vector<Metric> metrics() const override;
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<Mistake>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
