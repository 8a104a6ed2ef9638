#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/model/quality.h"
#include "tools/cli/program.h"
#include "tools/render/sweep_log.h"

namespace insonate {

inline constexpr double kMinDepth_mm = 10, kMaxDepth_mm = 400;  ///< of --depth

/// What the command line asks for. The pointers are options whose presence counts.
struct RenderOptions {
  std::string subject, view, pose_file, probe = "curvilinear", model = "S", settings_file, stages_folder, out;
  std::string quality = name_of(Quality::balanced), speckle_file, moved_file, freehand_file;
  std::optional<double> gain_db, pivot_mm;
  std::optional<int> width, height;
  double depth_mm = 0, sweep_deg = 0, voxel_mm = 1;
  int planes = 64;
  bool by_reference = false;

  std::string log_file, image_matrix_file, known_file, insertion = "trilinear", compounding = "mean";
  std::vector<int> clip;
  SweepLogSettings log;

  CLI::Option *with_speckle = nullptr, *moved = nullptr, *with_quality = nullptr, *with_gain = nullptr;
  CLI::Option *with_stages = nullptr, *reference = nullptr, *sweep = nullptr, *freehand = nullptr, *sweep_log = nullptr;

  /// Returns whether a volume is written, and not a picture.
  bool to_volume() const { return *sweep || *freehand || *sweep_log; }
};

/// Adds the options and the positional argument of insonate-render. Both have to outlive the parsing.
void add_options(CLI::App& arguments, RenderOptions& given);

}  // namespace insonate
