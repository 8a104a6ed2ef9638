#pragma once

#include "scenarios/scenario.h"
#include "scenarios/steps/step_task.h"

namespace insonate {

class TableReader;

/// `[[step.target]]`: what is to be measured, and what is taken for the truth.
struct MeasureTarget {
  enum class Along { depth, lateral, longest };

  std::vector<std::string> structures;  ///< structures = ["aorta", "aorta_wall"]: taken together; which ones is the
                                        ///< wall convention
  std::string view;     ///< view = "aorta_transverse": in whose picture the truth lies; default the step's own
  std::string through;  ///< through = "aorta_infrarenal": the landmark that the part of the structures is nearest to
                        ///< which counts; default the middle of all of them in the picture
  Along along = Along::longest;  ///< along = "depth", "lateral" or "longest" (default): the extent that is meant
  SourcePlace place{};
};

/// kind = "measure": freeze the picture and measure in it, by calipers or an ellipse. What is placed on a running
/// picture does not count; of each slot the last counts. The truth comes out of the label map:
///
///   tool = "distance"  caliper 1 against the target's extent in its view's picture, mm
///   tool = "ellipse"   the area of ellipse 1 against the area of the target there, mm2
///   tool = "ratio"     caliper 1 over caliper 2 against the same of two targets
///   tool = "volume"    calipers 1 to 3 as the axes of an ellipsoid against the volume of the structures, ml
///
/// An extent is that of the part which hangs together in the reference view's plane, sampled at kPitch_mm: it is right
/// to half a voxel at either end.
struct Measure : StepTask {
  enum class Tool { distance, ellipse, ratio, volume };
  static constexpr double kPitch_mm = 0.25;

  Tool tool = Tool::distance;
  std::string walls;                   ///< walls = "outer to outer": the convention, in words; it is shown
  std::vector<MeasureTarget> targets;  ///< two of a ratio, else one

  /// What is placed, and how many of it.
  ActionKind places() const { return tool == Tool::ellipse ? ActionKind::ellipse : ActionKind::caliper; }
  int slots() const;
  /// What all of them come to, in the order of their slots: mm, mm2, none or ml by tool.
  double value(const std::vector<Action>& placed) const;
  /// "23.4 mm", "4.56 cm²", "1.25", "123 ml"
  std::string value_text(double value) const;

  static std::shared_ptr<const StepTask> read(TableReader& table, const Step& step);

  StepInput input() const override;
  std::vector<Metric> metrics() const override;
  bool judges_picture() const override { return true; }  ///< the frozen one
  const char* why_no_value() const override { return "nothing was measured in a frozen picture."; }
  void check(const Step& step, const LabelIndex& labels, const std::string& where,
             std::vector<ScenarioProblem>& problems) const override;
  StepBegin prepare(const StepWorld& world) const override;
};

}  // namespace insonate
