#include "sim/view/slice_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/shaders/shared/slice_parameters.h"
#include "sim/view/picture_target.h"
#include "sim/view/plane_state.h"

namespace insonate::view {
namespace {

// The outline of a label whose organ has no colour: amber, which no tissue has.
constexpr glm::vec3 kPlainOutline(0.95f, 0.70f, 0.20f);
// Brightens the muted organ colours, because a thin line on grey needs more brightness.
constexpr float kOutlineBrightness = 1.35f;

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

SliceParameters parameters_for(const PatientTextures& patient, const UltrasoundPlane& plane, const SliceStyle& style,
                               const glm::ivec2& size) {
  SliceParameters p{};
  p.texture_from_pixel = glm::mat4(patient.texture_from_patient() * plane.patient_from_probe.matrix() *
                                   plane_from_pixel(plane.geometry, size));
  p.picture_size = glm::vec4(size, 0, 0);
  p.window_hu = float(style.window_hu);
  p.level_hu = float(style.level_hu);
  p.ultrasound = float(style.ultrasound);
  p.outside_fan = float(style.outside_fan);
  for (const std::uint8_t label : style.outlined) {
    const OrganColour& look = patient.colours()[label];
    const glm::vec3 colour = look.opacity > 0 ? kOutlineBrightness * look.colour : kPlainOutline;
    p.outline[label] = glm::vec4(glm::min(colour, 1.0f), 1);
  }
  return p;
}

struct Inputs {
  const PatientTextures* patient;
  PlaneState plane;
  SliceStyle style;
  bool operator==(const Inputs&) const = default;
};

}  // namespace

struct SliceView::State {
  explicit State(const gl::ShaderSources& sources) : program(sources, {"view/full_screen.vert", "view/slice.frag"}) {}

  gl::Program program;
  gl::FullScreenTriangle triangle;
  gl::Buffer parameters{sizeof(SliceParameters), nullptr};
  PictureTarget target;
  std::optional<Inputs> drawn;
  long renders = 0;
};

SliceView::SliceView(const gl::ShaderSources& sources) : state_(std::make_unique<State>(sources)) {}
SliceView::~SliceView() = default;
SliceView::SliceView(SliceView&&) noexcept = default;
SliceView& SliceView::operator=(SliceView&&) noexcept = default;

const gl::Texture& SliceView::render(const PatientTextures& patient, const UltrasoundPlane& plane,
                                     const SliceStyle& style) {
  State& s = *state_;
  Inputs inputs{&patient, PlaneState(plane), style};
  if (s.drawn == inputs) return s.target.texture;

  const glm::ivec2 size = size_of(plane.geometry, style.scale);
  s.target.resize(size.x, size.y);
  const SliceParameters parameters = parameters_for(patient, plane, style, size);
  s.parameters.write(&parameters, sizeof parameters);
  s.parameters.bind_uniform(0);
  patient.acoustic_volume().bind(0);
  plane.image->bind(1);
  patient.labels().bind(2);
  {
    const ScopedDrawTarget drawing(s.target.framebuffer, 0, size.y);
    s.program.use();
    s.triangle.draw();
  }
  ++s.renders;
  s.drawn = std::move(inputs);
  return s.target.texture;
}

void SliceView::forget() {
  state_->drawn.reset();
}

long SliceView::renders() const {
  return state_->renders;
}

std::optional<std::string> SliceView::reload(const gl::ShaderSources& sources) {
  const std::optional<std::string> problem = gl::Program::reload(std::array{&state_->program}, sources);
  if (!problem) forget();
  return problem;
}

}  // namespace insonate::view
