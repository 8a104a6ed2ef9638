#pragma once

#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"

namespace insonate {

class TableReader;

/// kind = "sweep": fan or slide through an organ, perhaps with landmarks kept in view all the time.
///
/// Coverage is the share of the organ's volume that was in the slice with the sound reaching it (insonation.h), with
/// the probe and the depth that the learner has set and while the picture is not frozen. The organ is looked at in
/// cells of about kCell_mm and from poses interpolated at MotionMeter::kRate_hz, so that the tracker's rate does not
/// matter.
struct Sweep : StepTask {
  static constexpr double kCell_mm = 4;

  std::vector<std::string> organ;  ///< organ = ["liver", "hepatic_veins"]: labels of the case, taken together
  std::vector<std::string> keep;   ///< keep = ["hepatorenal_recess"]: landmarks to keep in view; may be left out
  double enough_percent = 100;     ///< coverage_percent = 80: the step is done there; default 100, or by going on
  SourcePlace organ_place{}, keep_place{};

  static std::shared_ptr<const StepTask> read(TableReader& table, const Step& step);

  StepWords words() const override { return {"Go on when you have seen all of it.", "Searching"}; }
  std::vector<Metric> metrics() const override;
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<ScenarioProblem>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
