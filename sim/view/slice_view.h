#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/view/patient_textures.h"
#include "sim/view/ultrasound_plane.h"

namespace insonate::view {

struct SliceStyle {
  double window_hu = 400;              ///< width of the grey scale, > 0
  double level_hu = 40;                ///< its middle
  double ultrasound = 0;               ///< 0 the CT alone, 1 the ultrasound alone inside the fan, between: their mix
  double outside_fan = 0.4;            ///< brightness of the CT outside the fan, 0 to 1
  std::vector<std::uint8_t> outlined;  ///< label values whose edges are drawn in their organs' colours
  bool operator==(const SliceStyle&) const = default;
};

/// The CT in the plane of the ultrasound picture, on exactly that picture's pixels, alone or mixed with it.
class SliceView {
public:
  explicit SliceView(const gl::ShaderSources& sources = {});
  ~SliceView();
  SliceView(SliceView&&) noexcept;
  SliceView& operator=(SliceView&&) noexcept;

  /// RGBA8, alpha 255, row 0 is the top, the size of plane.geometry. Drawn anew only when something changed; valid
  /// until the next call. Leaves the framebuffer binding, viewport and switches as they were.
  /// @param patient  compared by address: call forget() after changing what lies there
  /// @param plane    with an image
  const gl::Texture& render(const PatientTextures& patient, const UltrasoundPlane& plane, const SliceStyle& style = {});

  /// The next render() draws.
  void forget();

  /// How often it has drawn.
  long renders() const;

  /// Builds the shader from other sources; when it does not build it goes on as it was, and that is told of.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::view
