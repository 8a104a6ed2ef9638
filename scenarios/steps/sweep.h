#pragma once

#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"

namespace insonate {

class TomlTable;

/// kind = "sweep": fan or slide through an organ, optionally with landmarks kept in view all the time.
///
/// Coverage is the share of the organ's volume that was in the slice and reached by sound (visibility.h). It uses the
/// learner's current probe and depth, and only time when the picture is not frozen. The organ is divided into cells of
/// about kCell_mm. Poses are interpolated at MotionMeter::kRate_hz, so that the tracker's rate does not matter.
struct Sweep : StepTask {
  static constexpr double kCell_mm = 4;

  std::vector<std::string> organ;  ///< organ = ["liver", "hepatic_veins"]: labels of the case, treated as one organ
  std::vector<std::string> keep;   ///< keep = ["hepatorenal_recess"]: landmarks to keep in view; optional
  double enough_percent = 100;     ///< coverage_percent = 80: done at this coverage; default 100, or going on
  SourcePlace organ_place{}, keep_place{};

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepWords words() const override { return {"Go on when you have seen all of it.", "Searching"}; }
  std::vector<Metric> metrics() const override;
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<Mistake>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
