#include "sim/view/body/patient_textures.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

#include "sim/view/body/tissue_classes.h"

namespace insonate::view {
namespace {

gl::Texture upload(GLenum format, const glm::ivec3& size, gl::Filter filter, GLenum layout, const void* voxels,
                   GLenum type = GL_UNSIGNED_BYTE) {
  gl::Texture texture = gl::Texture::make_3d(format, size.x, size.y, size.z, filter, gl::Wrap::edge);
  texture.write(layout, type, voxels);
  return texture;
}

// Maps patient mm to [0, 1] over a box of `voxels` voxels of the grid, which begins at the grid's first voxel. Voxel
// centres lie at (i + 1/2) / voxels.
glm::dmat4 box_from_patient(const Grid& grid, const glm::dvec3& voxels) {
  const glm::dmat4 box_from_index = glm::translate(glm::scale(glm::dmat4(1.0), 1.0 / voxels), glm::dvec3(0.5));
  return box_from_index * glm::inverse(grid.matrix());
}

}  // namespace

PatientTextures::PatientTextures(const gl::Texture& acoustic_volume, const Volume<std::int16_t>& ct,
                                 const Volume<std::uint8_t>& labels, const OrganColours& colours)
    : grid_(ct.grid), colours_(colours), acoustic_volume_(&acoustic_volume), label_volume_(&labels), cells_(ct) {
  const std::uint8_t none = 0;
  labels_ = upload(GL_R8UI, labels.empty() ? glm::ivec3(1) : labels.grid.size, gl::Filter::nearest, GL_RED_INTEGER,
                   labels.empty() ? &none : labels.voxels.data());
  const TissueClasses classes = classify_tissue(ct, labels, colours);
  step_ = classes.step;
  body_cells_ = cells_;
  body_cells_.hide(cells_outside_body(classes, cells_.size(), MacroCells::kSide));
  tissue_ = upload(GL_RGBA8, classes.size, gl::Filter::linear, GL_RGBA, classes.tissue.data());
  body_ = upload(GL_RG8, classes.size, gl::Filter::linear, GL_RG, classes.body.data());
  smooth_ct_ = upload(GL_R16_SNORM, classes.size, gl::Filter::linear, GL_RED, classes.hu.data(), GL_SHORT);
  distance_ = upload(GL_R8UI, classes.blocks, gl::Filter::nearest, GL_RED_INTEGER, classes.distance.data());
}

glm::dmat4 PatientTextures::texture_from_patient() const {
  return box_from_patient(grid_, glm::dvec3(grid_.size));
}

glm::dmat4 PatientTextures::tissue_from_patient() const {
  return box_from_patient(grid_, glm::dvec3(tissue_.width(), tissue_.height(), tissue_.depth()) * glm::dvec3(step_));
}

double PatientTextures::tissue_voxel_mm() const {
  const glm::dvec3 side = grid_.spacing * glm::dvec3(step_);
  return std::min({side.x, side.y, side.z});
}

}  // namespace insonate::view
