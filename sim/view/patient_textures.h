#pragma once

#include <glm/mat4x4.hpp>

#include <cstdint>

#include "sim/core/grid.h"
#include "sim/gl/objects.h"
#include "sim/view/organ_colours.h"

namespace insonate::view {

/// A patient as the views see it: made once per patient, in some tenths of a second, from the CT, its labels and the
/// texture of the simulator.
class PatientTextures {
public:
  /// @param acoustic_volume  gl::Simulator::volume_texture(), which outlives this
  /// @param labels           on the CT's grid, or empty
  PatientTextures(const gl::Texture& acoustic_volume, const Volume<std::int16_t>& ct,
                  const Volume<std::uint8_t>& labels, const OrganColours& colours);

  const Grid& grid() const { return grid_; }
  const glm::dmat4& texture_from_patient() const { return texture_from_patient_; }
  const OrganColours& colours() const { return colours_; }

  /// (HU, ...) / 32767 at the CT's own resolution.
  const gl::Texture& acoustic_volume() const { return *acoustic_volume_; }
  /// R8UI, the CT's size; 1 x 1 x 1 of 0 when there are no labels.
  const gl::Texture& labels() const { return labels_; }
  /// What is drawn, at about 2 mm: RGBA8, colour times coverage, and the coverage of organs and bone.
  const gl::Texture& tissue() const { return tissue_; }
  /// The same size, RG8: the opacity of 1 mm, and how much of the voxel is the patient's body.
  const gl::Texture& body() const { return body_; }
  /// Per block of kBlock^3 of those voxels, R8UI: how many blocks away (Chebyshev) the next one is that is not empty.
  const gl::Texture& distance() const { return distance_; }

  static constexpr int kBlock = 4;

private:
  Grid grid_;
  glm::dmat4 texture_from_patient_{1.0};
  OrganColours colours_;
  const gl::Texture* acoustic_volume_ = nullptr;
  gl::Texture labels_, tissue_, body_, distance_;
};

}  // namespace insonate::view
