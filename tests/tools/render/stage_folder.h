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

/// What `insonate-render --stages` has written.
struct StageFolder {
  nlohmann::json description;
  std::map<std::string, Plane> planes;  ///< by the file's name in the folder, without .nrrd
  ShortVolume hounsfield;               ///< that the sound went through
  std::vector<std::uint8_t> labels;     ///< of the volume's voxels; empty if there are none
  ShortVolume echogenicity;             ///< the same, hundredths of a dB; of model S
};

/// Throws std::runtime_error for what is no such folder.
StageFolder read_stage_folder(const std::filesystem::path& folder);

/// How far what computed the stages may be from what these files give in double precision.
struct Tolerances {
  double intensity;   ///< of I, relative, down to I = 1e-6
  double reflection;  ///< of R, relative to the frame's brightest
  double speckle;     ///< of S, whose mean is about 1
  double fused;       ///< of U, relative to the brightest of the pixels around
};

/// Recomputes each stage from the files of the stages before it, and the first ones from the volume. By stage, the
/// worst disagreement as a multiple of what is tolerated.
std::map<std::string, double> misfits(const StageFolder& stages, const Tolerances& tolerances);

/// The same of model W.
/// @param single  whether it was computed in single precision, with gradients kept to 1/16 HU
std::map<std::string, double> wein_misfits(const StageFolder& stages, bool single);

/// The same of the volume's echogenicity, from its Hounsfield units and labels.
std::map<std::string, double> volume_misfits(const StageFolder& stages);

}  // namespace outsider
