#pragma once

#include <span>
#include <vector>

#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/streamed_buffer.h"
#include "sim/gl/work_division.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/shaders/shared/scatter_parameters.h"

namespace insonate::gl {

/// What scatter.comp visits for one plane of lines: which columns of cells the slice cuts, in groups of kGroup, and how
/// the cells lie in the probe's frame.
struct ScattererColumns {
  static constexpr int kGroup = 32;  ///< columns that one work group visits, neighbours along a row

  ScatterParameters parameters{};
  glm::ivec3 corner{};             ///< parameters.probe_from_corner's cell
  std::vector<glm::ivec2> groups;  ///< first column of each, counted from `corner` along `across` and `up`
};

/// Returns them for a pose. Every scatterer that reaches a sample lies in a column of the list.
ScattererColumns scatterer_columns(const Pose& patient_from_probe, const ScanLines& lines, const Settings& settings);

/// Places the scatterers of sim/model/waves.h among the lines of one plane or of several, for the traversal.
class ScattererStage {
public:
  ScattererStage(const ShaderSources& sources, const WorkDivision& division);

  /// Allocates the buffer. Throws DeviceRefused.
  void lay_out(const ScanLines& of_plane, int most_planes);
  /// Takes other lines of the same number and samples, such as steered ones.
  void turn(const ScanLines& of_plane) {
    lines_ = of_plane;
    scale_ = TexelBuffer();
  }
  /// Runs the stage. The caller has bound the block of parameters (sim/shaders/shared/simulation_parameters.h).
  /// @param patient_from_plane  1 to most_planes poses
  void place(std::span<const Pose> patient_from_plane, const Settings& settings);

  /// n / c in fixed point, as scatter.comp stores it: one row per line, in the order of the placed lines.
  const TexelBuffer& scattered() const { return scattered_; }
  /// c by sample, for these fixed-point numbers.
  const TexelBuffer& scale() const { return scale_; }
  Program& program() { return program_; }

private:
  WorkDivision division_;
  Program program_;
  ScanLines lines_;
  TexelBuffer scattered_, scale_;
  Settings scale_of_;  // the settings for which scale_ holds
  StreamedBuffer parameters_, columns_;
};

}  // namespace insonate::gl
