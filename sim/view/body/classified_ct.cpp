#include "sim/view/body/classified_ct.h"

#include <cstdint>
#include <vector>

#include "sim/view/body/distance_map.h"
#include "sim/view/body/structure_surfaces.h"

namespace insonate::view {

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
  if (distance_.width() != cells.size().x || distance_.height() != cells.size().y ||
      distance_.depth() != cells.size().z)
    distance_ = gl::Texture::make_3d(GL_R8UI, cells.size().x, cells.size().y, cells.size().z, gl::Filter::nearest,
                                     gl::Wrap::edge);
  const TransferTable table(style.function);
  std::vector<std::uint8_t> occupied = cells.occupied(VisibleRanges(table));
  for (std::size_t cell = 0; cell < with_structures_.size(); ++cell) occupied[cell] |= with_structures_[cell];
  const std::vector<std::uint8_t> distances = distance_map(cells.size(), occupied);
  distance_.write(GL_RED_INTEGER, GL_UNSIGNED_BYTE, distances.data());
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
  distance_.bind(9);
  if (shows_structures()) surfaces_.bind(11);
}

}  // namespace insonate::view
