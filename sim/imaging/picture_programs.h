#pragma once

#include <vector>

#include "sim/gl/program.h"
#include "sim/imaging/stage.h"
#include "sim/model/settings.h"

namespace insonate::gl {

/// What the shaders of a picture's stages are compiled for, so that a scene does not pay for what it does not need.
struct PictureVariant {
  const Settings& settings;
  int reflection_radius_px, transmission_radius_px;  ///< of the smoothing windows
  int looks;                                         ///< that are compounded (sim/model/compounding.h)
  int filter_radius_px;                              ///< of the display filter's window; 0 without the filter
  bool keeps_fused;                                  ///< U is written, for a caller that reads the stages
};

/// The shaders of model S that convert the results on the lines (sim/imaging/line_stages.h) to a picture.
struct PicturePrograms {
  /// Throws std::runtime_error if one does not compile.
  explicit PicturePrograms(const ShaderSources& sources);

  /// Builds a stage and those behind it for a variant; does nothing for those that are built for it already. Throws
  /// std::runtime_error if one does not compile.
  void build_from(Stage first, const PictureVariant& variant);

  /// For Program::reload().
  std::vector<Program*> all() { return {&scan_convert, &smooth, &fuse, &maximum, &compress, &enhance_rows, &enhance}; }

  Program scan_convert, smooth, fuse, maximum, compress, enhance_rows, enhance;
};

}  // namespace insonate::gl
