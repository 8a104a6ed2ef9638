#pragma once

#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"

namespace insonate {

class TomlTable;

/// `[[step.target]]`: what to measure, and where the true value comes from.
struct MeasureTarget {
  enum class Along { depth, lateral, longest };

  std::vector<std::string> structures;  ///< structures = ["aorta", "aorta_wall"]: sets the wall convention
  std::string
      view;  ///< view = "aorta_transverse": the view whose picture defines the truth; default: the step's own view
  std::string through;  ///< through = "aorta_infrarenal": the part of the structures nearest to this landmark counts;
                        ///< default: nearest to the middle of all of them in the picture
  Along along = Along::longest;  ///< along = "depth", "lateral" or "longest" (default): direction of the extent
  SourcePlace place{};
};

/// kind = "measure": freeze the picture and measure in it with calipers or an ellipse. Items placed on a running
/// picture do not count. The last item of each slot counts. The label map gives the truth:
///
///   tool = "distance"  caliper 1 against the target's extent in its view's picture, mm
///   tool = "ellipse"   the area of ellipse 1 against the area of the target there, mm2
///   tool = "ratio"     caliper 1 over caliper 2 against the same of two targets
///   tool = "volume"    calipers 1 to 3 as the axes of an ellipsoid against the volume of the structures, ml
///
/// The extent is that of one connected part in the reference view's plane, sampled at kPitch_mm. It is accurate to half
/// a voxel at either end.
struct Measure : StepTask {
  enum class Tool { distance, ellipse, ratio, volume };
  static constexpr double kPitch_mm = 0.25;

  Tool tool = Tool::distance;
  std::string walls;                   ///< walls = "outer to outer": the wall convention in words, shown to the learner
  std::vector<MeasureTarget> targets;  ///< two for a ratio, else one

  /// The kind of items to place, and how many.
  ActionKind places() const { return tool == Tool::ellipse ? ActionKind::ellipse : ActionKind::caliper; }
  int slots() const;
  /// Returns the measured value from the placed items in the order of their slots: mm, mm2, a ratio or ml, by tool.
  double value(const std::vector<Action>& placed) const;
  /// "23.4 mm", "4.56 cm²", "1.25", "123 ml"
  std::string value_text(double value) const;

  static std::shared_ptr<const StepTask> read(const TomlTable& table, const Step& step);

  StepInput input() const override;
  std::vector<Metric> metrics() const override;
  bool judges_picture() const override { return true; }  ///< the frozen one
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<Mistake>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
