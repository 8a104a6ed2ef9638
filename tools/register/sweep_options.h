#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "tools/register/read_sweep.h"
#include "tools/register/start_transform.h"

namespace insonate {

/// What the command line says about ultrasound images, about where they lie, and about where a registration begins. An
/// empty text means that the option was not given.
struct SweepOptions {
  std::string probe_name, probe_file;
  std::optional<double> depth_mm;
  std::string image_matrix_file;
  std::vector<double> face_pixel;  ///< 2 numbers or none
  std::vector<int> clip;           ///< 4 numbers or none
  std::string mask_file;
  std::string start_file, landmarks_file;

  /// Returns the input that the options describe, without a file. Throws InputError.
  SweepInput input() const;
  /// Returns where the search begins: the identity if no option gives it. Throws InputError.
  StartTransform start() const;
};

/// Declares --probe, --probe-file, --depth, --image-to-probe, --face-pixel, --clip, --mask, --start and --landmarks.
/// @return the last two
std::vector<CLI::Option*> declare_sweep_options(CLI::App& arguments, SweepOptions& options);

}  // namespace insonate
