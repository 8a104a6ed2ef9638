#include "sim/view/body/classified_ct.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sim/view/body/distance_map.h"
#include "sim/view/body/structure_surfaces.h"

namespace insonate::view {
namespace {

gl::Defines along(int axis) {
  return {{"AXIS", std::to_string(axis)}, {"MOST_DISTANCE", std::to_string(kMaxDistance)}};
}

gl::Texture cell_texture(const glm::ivec3& cells) {
  return gl::Texture::make_3d(GL_R8UI, cells.x, cells.y, cells.z, gl::Filter::nearest, gl::Wrap::edge);
}

}  // namespace

ClassifiedCt::ClassifiedCt(const gl::ShaderSources& sources, RayShader shader) {
  if (shader == RayShader::compute)
    passes_.emplace(sources, std::vector<std::string>{"view/cell_distance.comp"}, along(0));
}

void ClassifiedCt::measure_distances(const glm::ivec3& cells, const std::vector<std::uint8_t>& occupied) {
  if (glm::ivec3(distances_.width(), distances_.height(), distances_.depth()) != cells) {
    if (passes_) between_passes_ = cell_texture(cells);  // first, because the size of the other is what counts
    distances_ = cell_texture(cells);
  }
  distances_.write(GL_RED_INTEGER, GL_UNSIGNED_BYTE, (passes_ ? occupied : distance_map(cells, occupied)).data());
  for (int axis = 0; passes_ && axis < 3; ++axis) {
    passes_->define(along(axis));
    distances_.bind(0);
    between_passes_.bind_image(0, GL_WRITE_ONLY);
    passes_->dispatch(cells.x, cells.y, cells.z);
    std::swap(distances_, between_passes_);
  }
}

void ClassifiedCt::update(const PatientTextures& patient, const CtVolumeStyle& style) {
  if (patient_ == &patient && function_ == style.function && body_only_ == style.body_only &&
      structures_ == style.structures)
    return;
  const MacroCells& cells = style.body_only ? patient.body_cells() : patient.cells();
  if (patient_ != &patient || structures_ != style.structures) {
    with_structures_.clear();
    if (!style.structures.empty() && !patient.label_volume().empty()) {
      const StructureSurfaces made = structure_surfaces(patient.label_volume(), patient.colours(), style.structures);
      with_structures_ = cells_with_structures(made, cells.size(), MacroCells::kSide);
      surfaces_ =
          gl::Texture::make_3d(GL_RGBA8, made.size.x, made.size.y, made.size.z, gl::Filter::linear, gl::Wrap::edge);
      surfaces_.write(GL_RGBA, GL_UNSIGNED_BYTE, made.voxels.data());
    }
  }
  const TransferTable table(style.function);
  std::vector<std::uint8_t> occupied = cells.occupied(VisibleRanges(table));
  for (std::size_t cell = 0; cell < with_structures_.size(); ++cell) occupied[cell] |= with_structures_[cell];
  measure_distances(cells.size(), occupied);
  std::vector<glm::vec4> texels;
  texels.reserve(2 * table.values.size());
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    texels.push_back(table.values[i]);
    texels.push_back(table.integrals[i]);
  }
  table_ = gl::TexelBuffer(GL_RGBA32F, texels.size(), texels.data());
  patient_ = &patient;
  function_ = style.function;
  body_only_ = style.body_only;
  structures_ = style.structures;
}

void ClassifiedCt::bind() const {
  table_.bind(8);
  distances_.bind(9);
  if (shows_structures()) surfaces_.bind(11);
}

std::vector<gl::Program*> ClassifiedCt::programs() {
  return passes_ ? std::vector<gl::Program*>{&*passes_} : std::vector<gl::Program*>();
}

}  // namespace insonate::view
