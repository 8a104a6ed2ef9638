#pragma once

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cstdint>

#include "sim/core/grid.h"
#include "sim/gl/objects.h"
#include "sim/view/body/macro_cells.h"
#include "sim/view/body/organ_colours.h"

namespace insonate::view {

/// Holds the textures of a patient that the views draw. It is made once per patient, in some tenths of a second, from
/// the CT, its labels and the simulator's texture. Needs a current OpenGL context.
class PatientTextures {
public:
  /// @param acoustic_volume  gl::Simulator::volume_texture() of the same CT; must outlive this object
  /// @param labels           on the CT's grid, or empty; must outlive this object
  PatientTextures(const gl::Texture& acoustic_volume, const Volume<std::int16_t>& ct,
                  const Volume<std::uint8_t>& labels, const OrganColours& colours);

  const Grid& grid() const { return grid_; }
  const OrganColours& colours() const { return colours_; }
  const Volume<std::uint8_t>& label_volume() const { return *label_volume_; }

  /// (HU, ...) / 32767 at the CT's own resolution; air outside.
  const gl::Texture& acoustic_volume() const { return *acoustic_volume_; }
  /// R8UI, the CT's size; a single 0 if there are no labels.
  const gl::Texture& labels() const { return labels_; }
  /// Maps patient mm to texture coordinates of acoustic_volume() and labels().
  glm::dmat4 texture_from_patient() const;

  /// The ranges of the CT's values, for drawing the CT itself.
  const MacroCells& cells() const { return cells_; }
  /// The cells that lie outside the body are hidden in these.
  const MacroCells& body_cells() const { return body_cells_; }
  /// Returns the smallest side of the CT's voxels, mm.
  double ct_voxel_mm() const { return std::min({grid_.spacing.x, grid_.spacing.y, grid_.spacing.z}); }

  /// The arrays of TissueClasses, for drawing in 3D: RGBA8, RG8 and R8UI.
  const gl::Texture& tissue() const { return tissue_; }
  const gl::Texture& body() const { return body_; }
  const gl::Texture& distance() const { return distance_; }
  /// Smoothed HU / 32767 on the same voxels.
  const gl::Texture& smooth_ct() const { return smooth_ct_; }
  /// Maps patient mm to texture coordinates of tissue() and body().
  glm::dmat4 tissue_from_patient() const;
  /// Returns the smallest side of the voxels of tissue() and body(), mm.
  double tissue_voxel_mm() const;

private:
  Grid grid_;
  OrganColours colours_;
  glm::ivec3 step_{1};  // CT voxels per voxel of tissue(), along each axis
  const gl::Texture* acoustic_volume_ = nullptr;
  const Volume<std::uint8_t>* label_volume_ = nullptr;
  MacroCells cells_, body_cells_;
  gl::Texture smooth_ct_, labels_, tissue_, body_, distance_;
};

}  // namespace insonate::view
