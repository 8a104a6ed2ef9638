#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/streamed_buffer.h"
#include "sim/view/body/patient_textures.h"
#include "sim/view/picture_target.h"

namespace insonate::view {

/// How the CT looks in any slice.
struct CtStyle {
  double window_hu = 400;              ///< width of the grey scale, > 0
  double level_hu = 40;                ///< middle of the grey scale
  std::vector<std::uint8_t> outlined;  ///< label values whose edges are drawn in their organs' colours
  bool operator==(const CtStyle&) const = default;
};

/// An ultrasound picture that is mixed with the CT. It covers the whole slice.
struct MixedUltrasound {
  const gl::Texture* image = nullptr;  ///< alpha is 0 outside the fan
  double share = 0;                    ///< inside the fan: 0 is the CT alone, 1 the ultrasound alone
  glm::vec3 white{1.0f};               ///< the colour of its white, sRGB, 0 to 1
  double outside_fan = 1;              ///< brightness of the CT outside the fan, 0 to 1
};

/// Draws the CT along a plane. All views of slices draw with it. Needs a current OpenGL context.
class SlicePainter {
public:
  /// Throws std::runtime_error if the shader does not compile.
  explicit SlicePainter(const gl::ShaderSources& sources);

  /// Draws a picture of `size` pixels and returns it: RGBA8, alpha 255, row 0 is the top; valid until the next call.
  /// Leaves the framebuffer binding, viewport and switches as they were.
  /// @param patient_from_pixel  maps (x, y, 0, 1) of a pixel's centre, in whole numbers, to patient mm
  const gl::Texture& draw(const PatientTextures& patient, const glm::dmat4& patient_from_pixel, const glm::ivec2& size,
                          const CtStyle& style, const MixedUltrasound& ultrasound = {});

  /// Returns the last picture.
  const gl::Texture& picture() const { return target_.texture; }
  /// Returns how often draw() has drawn.
  long renders() const { return renders_; }

  /// Rebuilds the shader from `sources`. If it fails to compile, the painter keeps its current one and its log is
  /// returned.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  gl::Program program_;
  gl::FullScreenTriangle triangle_;
  gl::StreamedBuffer parameters_;
  PictureTarget target_;
  long renders_ = 0;
};

}  // namespace insonate::view
