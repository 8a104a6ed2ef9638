#pragma once

#include <cstddef>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/model/acoustic_volume.h"

namespace insonate::gl {

/// Fetches as many samples from a volume as a simulation does and computes nothing: how fast the device's texture units
/// are, beside which a simulator's times can be held.
class TextureRate {
public:
  /// Of the texture that model W reads. Throws TextureRefused, and std::runtime_error when its shader does not build.
  TextureRate(const AcousticVolume& volume, double reflection_length_mm, std::size_t fetches,
              const WorkDivision& division = WorkDivision::of_device());

  /// So many fetches or a few more. The device may still be at work.
  void run() const;

private:
  Texture density_;
  Program program_;
  Buffer sums_;
  glm::ivec2 groups_;
};

}  // namespace insonate::gl
