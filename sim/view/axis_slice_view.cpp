#include "sim/view/axis_slice_view.h"

#include <utility>

namespace insonate::view {
namespace {

glm::dmat4 patient_from_pixel(const AxisSlice& slice) {
  const Pose pose = slice.patient_from_picture();
  glm::dmat4 m = pose.matrix();
  m[0] *= slice.mm_per_pixel;
  m[1] *= slice.mm_per_pixel;
  m[3] = glm::dvec4(slice.patient_mm(glm::dvec2(0.5)), 1);  // the centre of pixel (0, 0)
  return m;
}

}  // namespace

const gl::Texture& AxisSliceView::render(const PatientTextures& patient, const AxisSlice& slice, const CtStyle& style) {
  Inputs inputs{&patient, slice, style};
  if (drawn_ == inputs) return painter_.picture();
  painter_.draw(patient, patient_from_pixel(slice), {slice.width, slice.height}, style);
  drawn_ = std::move(inputs);
  return painter_.picture();
}

std::optional<std::string> AxisSliceView::reload(const gl::ShaderSources& sources) {
  const std::optional<std::string> problem = painter_.reload(sources);
  if (!problem) forget();
  return problem;
}

}  // namespace insonate::view
