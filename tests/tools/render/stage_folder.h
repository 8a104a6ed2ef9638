#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/tools/render/short_volume.h"

namespace outsider {

/// Values of a two-dimensional NRRD file, first axis fastest.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;

  double& at(int x, int y) { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
  double at(int x, int y) const { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};

/// The output of `insonate-render --stages`.
struct StageFolder {
  nlohmann::json description;
  std::map<std::string, Plane> planes;  ///< by the file's name in the folder, without .nrrd
  ShortVolume hounsfield;               ///< the insonated volume
  std::vector<std::uint8_t> labels;     ///< of the volume's voxels; empty if there are none
  ShortVolume echogenicity;             ///< of the same voxels, hundredths of a dB; model S only
};

/// Throws std::runtime_error if the folder is not such output.
StageFolder read_stage_folder(const std::filesystem::path& folder);

/// Allowed differences between the computed stages and a recomputation from these files in double precision.
struct Tolerances {
  double intensity;   ///< of I, relative, down to I = 1e-6
  double reflection;  ///< of R, relative to the frame's brightest
  double speckle;     ///< of S, whose mean is about 1
  double fused;       ///< of U, relative to the brightest of the surrounding pixels
};

/// Recomputes each stage from the files of the stages before it, and the first ones from the volume. Returns the worst
/// disagreement by stage, as a multiple of the tolerance.
std::map<std::string, double> misfits(const StageFolder& stages, const Tolerances& tolerances);

/// Does the same for model W.
/// @param single  whether it was computed in single precision, with gradients rounded to 1/16 HU
std::map<std::string, double> wein_misfits(const StageFolder& stages, bool single);

/// Does the same for the volume's echogenicity, from its Hounsfield units and labels.
std::map<std::string, double> volume_misfits(const StageFolder& stages);

}  // namespace outsider
