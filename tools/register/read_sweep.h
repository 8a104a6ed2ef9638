#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "sim/alignment/tracked_sweep.h"
#include "sim/probe/probe.h"

namespace insonate {

/// How a recording of tracked ultrasound is read.
struct SweepInput {
  std::string file;
  std::string transform;                       ///< RecordingOptions::transform
  std::optional<glm::dmat4> probe_from_pixel;  ///< in place of the recording's own ImageToProbe
  std::optional<glm::dvec2> face_pixel;        ///< where the middle of the probe's face lies in the images
  std::optional<std::array<int, 4>> clip;      ///< x, y, width, height of the part that is used, pixels
  Probe probe = Probe();                       ///< whose fan the images show
  double depth_mm = 160;
  int slices = 20;  ///< images that are used, evenly spread over the recording
  int width = 128, height = 96;
};

/// A recording, as it is registered.
struct ReadSweep {
  TrackedSweep sweep;
  std::size_t frames = 0;    ///< of the recording
  std::size_t left_out = 0;  ///< frames without a usable pose
};

/// Reads images and poses. The frame of each pose is that of the fan: its origin is the middle of the probe's face, x
/// runs along the rows of the images, and y along their columns. Without `face_pixel` it is where the probe's frame has
/// its origin, as in recordings of Insonate. Throws InputError if the recording has no images or fewer than two with a
/// pose, if its images are not placed, if the fan is not in them, or if they are of one grey level.
ReadSweep read_sweep(const SweepInput& input);

/// Reads a probe from a TOML file: kind ("curvilinear", "linear" or "phased"), radius_mm and field_of_view_deg or
/// width_mm as in Probe, and depth_mm. Throws InputError.
Probe read_probe(const std::string& file);

}  // namespace insonate
