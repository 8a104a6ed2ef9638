#pragma once

#include <optional>
#include <string>

#include "sim/gl/program.h"
#include "sim/gl/scheme.h"
#include "sim/gl/stage.h"
#include "sim/model/settings.h"

namespace insonate::gl {

/// Whether anything repeats (sim/model/reverberation.h), and whether anything adds noise (sim/model/noise.h).
bool reverberates(const Settings& settings);
/// Reverberation is of the slice's middle plane, which the traversal then keeps beside the sum of all.
bool keeps_middle_plane(const Settings& settings);
bool is_noisy(const Settings& settings);

/// What the shaders of model S are compiled for, so that what a scene does not need costs it nothing.
struct StageVariant {
  const Settings& settings;
  double dr_mm;
  int reflection_radius_px, transmission_radius_px;  ///< of the smoothing windows
  bool keeps_fused;                                  ///< U is written, for whoever reads the stages
};

/// The shaders of model S.
struct StagePrograms {
  /// Throws std::runtime_error when one does not build.
  StagePrograms(const ShaderSources& sources, const Scheme& scheme);

  /// Builds a stage and those behind it for a variant; does nothing for those that are built so. Throws
  /// std::runtime_error.
  void build_from(Stage first, const StageVariant& variant);

  /// Builds all again; what does not build goes on as it was and is told of.
  std::optional<std::string> reload(const ShaderSources& sources);

  Program traverse, reverberation, beam, clutter, clutter_tail, scan_convert, smooth, fuse, maximum, compress;

private:
  ShaderSources sources_;
  Scheme scheme_;
};

}  // namespace insonate::gl
