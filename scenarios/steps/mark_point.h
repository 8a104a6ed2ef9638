#pragma once

#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"

namespace insonate {

class TomlTable;

/// kind = "mark_point": point at a landmark or a structure in the picture, which may be frozen. The last point before
/// going on counts. Its error is the distance in space to the landmark, or to the structure's nearest voxel (0 inside).
struct MarkPoint : StepTask {
  std::string landmark;                 ///< landmark = "hepatorenal_recess"; either this
  std::vector<std::string> structures;  ///< structures = ["gallbladder"]; or this
  SourcePlace place{};

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepInput input() const override { return PointInput{}; }
  std::vector<Metric> metrics() const override { return {Metric::point_error_mm}; }
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<Mistake>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

/// kind = "label_structures": put names on structures in the picture. For each name, the last place before going on
/// counts. It is right if a voxel of the structure lies within tolerance_mm.
struct LabelStructures : StepTask {
  std::vector<std::string> structures;  ///< structures = ["liver", "right_kidney_cortex"]: labels of the case, up to 20
  double tolerance_mm = 2;              ///< tolerance_mm = 2: 0 to 20; default 2
  SourcePlace place{};

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepInput input() const override { return LabelInput{structures}; }
  std::vector<Metric> metrics() const override { return {Metric::labels_right_percent}; }
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<Mistake>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
