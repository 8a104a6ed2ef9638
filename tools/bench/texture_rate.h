#pragma once

#include <cstddef>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/tissue/acoustic_volume.h"

namespace insonate::gl {

/// Fetches as many samples from a volume as a simulation and computes nothing. It measures the speed of the device's
/// texture units, as a reference for the simulators' times.
class TextureRate {
public:
  /// Fetches from the texture that model W reads. Throws TextureRefused if the device cannot hold it, and
  /// std::runtime_error if its shader does not compile.
  TextureRate(const AcousticVolume& volume, double reflection_length_mm, std::size_t fetches,
              const WorkDivision& division = WorkDivision::of_device());

  /// Runs the requested number of fetches or slightly more. The device may still be working when it returns.
  void run() const;

private:
  Texture density_;
  Program program_;
  Buffer sums_;
  glm::ivec2 groups_;
};

}  // namespace insonate::gl
