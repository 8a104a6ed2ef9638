#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <utility>

#include "sim/gl/objects.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate::gl {

/// Voxels of air around a volume on the card, so that samples beyond the volume need no test of where it ends.
inline constexpr int kAirMargin = 1;

/// Holds a patient on the graphics card: the volume that sound meets, and the tissue table for its Hounsfield units.
class DeviceVolume {
public:
  DeviceVolume() = default;
  /// Uploads both. Throws TextureRefused if the device cannot hold the volume.
  DeviceVolume(const AcousticVolume& volume, const TissueTable& table);

  /// (HU, echogenicity in hundredths of a dB) / 32767, with the margin of air.
  const Texture& texture() const { return texture_; }
  /// Impedance and absorption at each whole HU, as shared/acoustic_volume.glsl reads them.
  const TexelBuffer& tissue_lookup() const { return tissue_lookup_; }
  /// Maps patient mm to the texture's coordinates.
  const glm::dmat4& texture_from_patient() const { return texture_from_patient_; }

  /// Returns the part of a ray that may meet anything but the air around the body, or pass within `margin` of it along
  /// the axes. It runs from start + first * step to start + last * step (texture coordinates); last < first if there is
  /// no such part.
  std::pair<double, double> meets_body(const glm::dvec3& start, const glm::dvec3& step, const glm::dvec3& margin) const;

  explicit operator bool() const { return bool(texture_); }

private:
  Texture texture_;
  TexelBuffer tissue_lookup_;
  glm::dmat4 texture_from_patient_{1.0};
  glm::dvec3 body_low_{0.0}, body_high_{0.0};  ///< texture coordinates
};

}  // namespace insonate::gl
