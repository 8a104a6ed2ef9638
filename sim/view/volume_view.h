#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/view/orbit_camera.h"
#include "sim/view/patient_textures.h"
#include "sim/view/ultrasound_plane.h"

namespace insonate::view {

struct VolumeStyle {
  bool cut = true;         ///< takes away what lies between the camera and the ultrasound's plane
  double cut_face = 0.85;  ///< opacity of the CT shown on the cut outside the fan, 0 to 1
  double skin = 0.14;      ///< opacity of the skin seen face on, 0 to 1
  bool organs = true;      ///< labelled organs and bone
  bool plane = true;       ///< the ultrasound picture in its place
  bool probe = true;
  bool operator==(const VolumeStyle&) const = default;
};

/// The patient as a body in space, with the ultrasound picture where it was taken: direct volume rendering by ray
/// casting, the picture and the probe composited at their true depth.
class VolumeView {
public:
  explicit VolumeView(const gl::ShaderSources& sources = {});
  ~VolumeView();
  VolumeView(VolumeView&&) noexcept;
  VolumeView& operator=(VolumeView&&) noexcept;

  /// RGBA8, alpha 255, row 0 is the top; valid until the next call. The texture is `width` by `height` or, while things
  /// move and a full picture would take longer than the budget, a half, third or quarter of that: draw it stretched.
  /// Once nothing changes, each call draws as much of the full picture as the budget allows and returns it when it is
  /// whole; after that nothing is drawn. Leaves the framebuffer binding and viewport as they were.
  /// @param patient    compared by address: call forget() after changing what lies there
  /// @param budget_ms  device time for one call; infinity always draws the full picture at once
  const gl::Texture& render(int width, int height, const PatientTextures& patient, const OrbitCamera& camera,
                            const UltrasoundPlane& plane, const VolumeStyle& style = {},
                            double budget_ms = std::numeric_limits<double>::infinity());

  /// The next render() draws.
  void forget();

  /// How often it has drawn a picture or a part of one.
  long renders() const;
  /// Of the picture last returned: 1 whole, 2 half, 3 a third, 4 a quarter of the size asked for.
  int scale() const;
  /// Device time that a picture of full size takes, as measured last; 0 before that.
  double full_picture_ms() const;

  /// Builds the shader from other sources; when it does not build it goes on as it was, and that is told of.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::view
