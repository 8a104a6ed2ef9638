#include "sim/view/body/classified_ct.h"

#include <cstdint>
#include <vector>

#include "sim/view/body/distance_map.h"

namespace insonate::view {

void ClassifiedCt::update(const PatientTextures& patient, const TransferFunction& function, bool body_only) {
  if (patient_ == &patient && function_ == function && body_only_ == body_only) return;
  const MacroCells& cells = body_only ? patient.body_cells() : patient.cells();
  if (distance_.width() != cells.size().x || distance_.height() != cells.size().y ||
      distance_.depth() != cells.size().z)
    distance_ = gl::Texture::make_3d(GL_R8UI, cells.size().x, cells.size().y, cells.size().z, gl::Filter::nearest,
                                     gl::Wrap::edge);
  const TransferTable table(function);
  const std::vector<std::uint8_t> distances = distance_map(cells.size(), cells.occupied(VisibleRanges(table)));
  distance_.write(GL_RED_INTEGER, GL_UNSIGNED_BYTE, distances.data());
  std::vector<glm::vec4> texels;
  texels.reserve(2 * table.values.size());
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    texels.push_back(table.values[i]);
    texels.push_back(table.integrals[i]);
  }
  table_ = gl::TexelBuffer(GL_RGBA32F, texels.size(), texels.data());
  patient_ = &patient;
  function_ = function;
  body_only_ = body_only;
}

void ClassifiedCt::bind() const {
  table_.bind(8);
  distance_.bind(9);
  patient_->smooth_ct().bind(10);
}

}  // namespace insonate::view
