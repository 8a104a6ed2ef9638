#include "sim/view/slice_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/view/plane_state.h"

namespace insonate::view {
namespace {

glm::ivec2 size_of(const ImageGeometry& ultrasound, double scale) {
  return {std::max(1, int(std::lround(ultrasound.width * scale))),
          std::max(1, int(std::lround(ultrasound.height * scale)))};
}

/// Returns the matrix from the pixels of a picture of `size` to the plane, for a picture that shows the same part of
/// it as the ultrasound.
glm::dmat4 plane_from_pixel(const ImageGeometry& ultrasound, const glm::ivec2& size) {
  const glm::dvec2 step = glm::dvec2(ultrasound.width, ultrasound.height) / glm::dvec2(size);
  glm::dmat4 m(1.0);
  m[0][0] = ultrasound.mm_per_pixel * step.x;
  m[1][1] = ultrasound.mm_per_pixel * step.y;
  const glm::dvec2 first = step / 2.0 - 0.5;  // the centre of pixel (0, 0), in pixels of the ultrasound
  m[3] = glm::dvec4(ultrasound.plane_mm(first.x, first.y), 0, 1);
  return m;
}

struct SliceInputs {
  const PatientTextures* patient;
  PlaneState plane;
  SliceStyle style;
  bool operator==(const SliceInputs&) const = default;
};

}  // namespace

struct SliceView::State {
  explicit State(const gl::ShaderSources& sources) : painter(sources) {}

  SlicePainter painter;
  std::optional<SliceInputs> drawn;
};

SliceView::SliceView(const gl::ShaderSources& sources) : state_(std::make_unique<State>(sources)) {}
SliceView::~SliceView() = default;
SliceView::SliceView(SliceView&&) noexcept = default;
SliceView& SliceView::operator=(SliceView&&) noexcept = default;

const gl::Texture& SliceView::render(const PatientTextures& patient, const UltrasoundPlane& plane,
                                     const SliceStyle& style) {
  State& s = *state_;
  SliceInputs inputs{&patient, PlaneState(plane), style};
  if (s.drawn == inputs) return s.painter.picture();
  const glm::ivec2 size = size_of(plane.geometry, style.scale);
  s.painter.draw(patient, plane.patient_from_probe.matrix() * plane_from_pixel(plane.geometry, size), size, style,
                 {plane.image, style.ultrasound, style.ultrasound_white, style.outside_fan});
  s.drawn = std::move(inputs);
  return s.painter.picture();
}

void SliceView::forget() {
  state_->drawn.reset();
}

long SliceView::renders() const {
  return state_->painter.renders();
}

std::optional<std::string> SliceView::reload(const gl::ShaderSources& sources) {
  const std::optional<std::string> problem = state_->painter.reload(sources);
  if (!problem) forget();
  return problem;
}

}  // namespace insonate::view
