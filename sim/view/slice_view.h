#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/view/body/patient_textures.h"
#include "sim/view/slice_painter.h"
#include "sim/view/ultrasound_plane.h"

namespace insonate::view {

/// How the slice view is drawn.
struct SliceStyle : CtStyle {
  double ultrasound = 0;             ///< inside the fan: 0 is the CT alone, 1 the ultrasound alone, between: their mix
  glm::vec3 ultrasound_white{1.0f};  ///< the colour of the ultrasound's white, sRGB, 0 to 1
  double outside_fan = 0.4;          ///< brightness of the CT outside the fan, 0 to 1
  double scale = 1;                  ///< pixels along a side for each pixel of the ultrasound, above 0 to 1
  bool operator==(const SliceStyle&) const = default;
};

/// Draws the CT in the plane of the ultrasound picture, as far as that reaches, alone or mixed with it.
class SliceView {
public:
  /// Throws std::runtime_error if the shader does not compile. Needs a current OpenGL context.
  explicit SliceView(const gl::ShaderSources& sources = {});
  ~SliceView();
  SliceView(SliceView&&) noexcept;
  SliceView& operator=(SliceView&&) noexcept;

  /// Returns the picture: RGBA8, alpha 255, row 0 is the top, the size of plane.geometry times the style's scale. It is
  /// redrawn only if something changed, and valid until the next call. Leaves the framebuffer binding, viewport and
  /// switches as they were.
  /// @param patient  compared by address: call forget() after changing the object there
  /// @param plane    must have an image
  const gl::Texture& render(const PatientTextures& patient, const UltrasoundPlane& plane,
                            const SliceStyle& style = SliceStyle());

  /// Makes the next render() redraw.
  void forget();

  /// Returns how often it has drawn.
  long renders() const;

  /// Rebuilds the shader from `sources`. If it fails to compile, the view keeps its current one and its log is
  /// returned.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::view
