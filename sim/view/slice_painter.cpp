#include "sim/view/slice_painter.h"

#include <array>

#include "sim/shaders/view/slice_parameters.h"

namespace insonate::view {
namespace {

// The outline of a label whose organ has no colour: amber, which no tissue has.
constexpr glm::vec3 kPlainOutline(0.95f, 0.70f, 0.20f);
// Brightens the muted organ colours, because a thin line on grey needs more brightness.
constexpr float kOutlineBrightness = 1.35f;

SliceParameters parameters_for(const PatientTextures& patient, const glm::dmat4& patient_from_pixel,
                               const glm::ivec2& size, const CtStyle& style, const MixedUltrasound& ultrasound) {
  SliceParameters p{};
  p.texture_from_pixel = glm::mat4(patient.texture_from_patient() * patient_from_pixel);
  p.picture_size = glm::vec4(size, 0, 0);
  p.ultrasound_white = glm::vec4(ultrasound.white, 0);
  p.window_hu = float(style.window_hu);
  p.level_hu = float(style.level_hu);
  p.ultrasound = ultrasound.image ? float(ultrasound.share) : 0;
  p.outside_fan = ultrasound.image ? float(ultrasound.outside_fan) : 1;
  for (const std::uint8_t label : style.outlined) {
    const OrganColour& look = patient.colours()[label];
    const glm::vec3 colour = look.opacity > 0 ? kOutlineBrightness * look.colour : kPlainOutline;
    p.outline[label] = glm::vec4(glm::min(colour, 1.0f), 1);
  }
  return p;
}

}  // namespace

SlicePainter::SlicePainter(const gl::ShaderSources& sources)
    : program_(sources, {"view/full_screen.vert", "view/slice.frag"}) {}

const gl::Texture& SlicePainter::draw(const PatientTextures& patient, const glm::dmat4& patient_from_pixel,
                                      const glm::ivec2& size, const CtStyle& style, const MixedUltrasound& ultrasound) {
  target_.resize(size.x, size.y);
  const SliceParameters parameters = parameters_for(patient, patient_from_pixel, size, style, ultrasound);
  parameters_.write(&parameters, sizeof parameters);
  parameters_.bind_uniform(0);
  patient.acoustic_volume().bind(0);
  if (ultrasound.image)
    ultrasound.image->bind(1);
  else
    glBindTextureUnit(1, 0);  // reads as black; its share is 0
  patient.labels().bind(2);
  {
    const ScopedDrawTarget drawing(target_.framebuffer, 0, size.y);
    program_.use();
    triangle_.draw();
  }
  ++renders_;
  return target_.texture;
}

std::optional<std::string> SlicePainter::reload(const gl::ShaderSources& sources) {
  return gl::Program::reload(std::array{&program_}, sources);
}

}  // namespace insonate::view
