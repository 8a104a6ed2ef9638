#pragma once

#include <glm/mat4x4.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "sim/probe/probe.h"
#include "sim/reconstruction/reconstruction.h"
#include "sim/reconstruction/sweep_quality.h"

namespace insonate {

/// What to make of the images of a recorded sweep.
struct SweepLogSettings {
  std::string transform;                       ///< RecordingOptions::transform
  std::optional<glm::dmat4> probe_from_pixel;  ///< in place of the recording's own ImageToProbe
  std::optional<std::array<int, 4>> clip;      ///< x, y, width, height of the part that is used, pixels
  std::optional<Probe> probe;                  ///< only the fan of this probe is used
  double depth_mm = 0;                         ///< of that fan
  double voxel_mm = 1;
  double beam_mm = 3;  ///< width of the beam along the elevation: SweepLimits::spacing_mm unless voxels are larger
  ReconstructionSettings reconstruction;
};

/// A volume made of the images of a recording.
struct ReconstructedLog {
  ReconstructedVolume volume;
  SweepQuality quality;
  std::string remark;        ///< GridChoice::remark
  std::size_t left_out = 0;  ///< frames without a usable pose
  bool has_times = true;     ///< false: the frames have no times, and the quality's are meaningless
};

/// Reconstructs the volume that a recording's images show. Reads one image at a time. Throws InputError if the
/// recording has no images that can be read, or fewer than two with a pose, or if none of a picture is used.
ReconstructedLog reconstruct_log(const std::string& file, const SweepLogSettings& settings);

}  // namespace insonate
