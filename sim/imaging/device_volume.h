#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <utility>

#include "sim/gl/objects.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/tissue.h"

namespace insonate::gl {

/// Voxels of air around a volume on the card, so that sampling beyond it needs no look at where it ends.
inline constexpr int kAirMargin = 1;

/// A patient on the graphics card: the volume as sound meets it, and what its Hounsfield units mean.
class DeviceVolume {
public:
  DeviceVolume() = default;
  /// Throws TextureRefused when the device cannot hold it.
  DeviceVolume(const AcousticVolume& volume, const TissueTable& table);

  /// (HU, echogenicity in hundredths of a dB) / 32767, with the margin of air.
  const Texture& texture() const { return texture_; }
  /// Impedance and absorption at each whole HU, as acoustic_volume.glsl reads it.
  const TexelBuffer& tissue_lookup() const { return tissue_lookup_; }
  /// Patient mm -> the texture's coordinates.
  const glm::dmat4& texture_from_patient() const { return texture_from_patient_; }

  /// The part of a ray where it may meet anything but the air that is around the body, or may have it within `margin`
  /// along the axes: from start + first * step to start + last * step (texture coordinates), with last < first where it
  /// meets nothing else.
  std::pair<double, double> meets_body(const glm::dvec3& start, const glm::dvec3& step, const glm::dvec3& margin) const;

  explicit operator bool() const { return bool(texture_); }

private:
  Texture texture_;
  TexelBuffer tissue_lookup_;
  glm::dmat4 texture_from_patient_{1.0};
  glm::dvec3 body_low_{0.0}, body_high_{0.0};  ///< texture coordinates
};

}  // namespace insonate::gl
