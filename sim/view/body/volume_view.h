#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/view/body/ct_volume_style.h"
#include "sim/view/body/orbit_camera.h"
#include "sim/view/body/patient_textures.h"
#include "sim/view/body/ray_shader.h"
#include "sim/view/ultrasound_plane.h"

namespace insonate::view {

/// How the volume view is drawn.
struct VolumeStyle {
  bool cut = true;                  ///< removes what lies between the camera and the ultrasound's plane
  double cut_face = 0.85;           ///< opacity of the CT shown on the cut outside the fan, 0 to 1
  double skin = 0.14;               ///< opacity of the skin where it faces the camera, 0 to 1
  bool organs = true;               ///< shows labelled organs and bone
  bool plane = true;                ///< shows the ultrasound picture in its place
  bool probe = true;                ///< shows the probe
  std::optional<CtVolumeStyle> ct;  ///< draws the CT itself in place of skin, organs and bone
  bool operator==(const VolumeStyle&) const = default;
};

/// Device time that one call may take while things move, ms; infinity always draws the full picture at once. A part of
/// the full picture may take the sum.
struct VolumeBudget {
  double volume_ms = std::numeric_limits<double>::infinity();  ///< of skin, organs and bone
  double plane_ms = std::numeric_limits<double>::infinity();   ///< of the plane, the cut and the probe
};

/// Draws the patient in 3D, with the ultrasound picture where it was taken. It uses direct volume rendering by ray
/// casting; the picture and the probe are composited at their true depth.
class VolumeView {
public:
  /// Throws std::runtime_error if the shader does not compile. Needs a current OpenGL context.
  explicit VolumeView(const gl::ShaderSources& sources = {}, RayShader shader = ray_shader_of_device());
  ~VolumeView();
  VolumeView(VolumeView&&) noexcept;
  VolumeView& operator=(VolumeView&&) noexcept;

  /// Returns the picture: RGBA8, alpha 255, row 0 is the top; valid until the next call. The texture is `width` by
  /// `height`. While the inputs change and a full picture would exceed the budget, skin, organs and bone are drawn with
  /// a half to a fifth of the pixels along each side. The plane, the face of the cut, the probe and the patient's
  /// silhouette are sharp as far as the plane's budget allows, with a half of the pixels at least: the texture is as
  /// large as that, and to be drawn stretched. The silhouette's time is in neither budget: it follows from its length
  /// alone. Once nothing changes, each call draws as much of the full picture as the budget allows, and returns it when
  /// it is complete. After that nothing is drawn. Leaves the framebuffer binding and viewport as they were.
  /// @param patient  compared by address: call forget() after changing the object there
  const gl::Texture& render(int width, int height, const PatientTextures& patient, const OrbitCamera& camera,
                            const UltrasoundPlane& plane, const VolumeStyle& style = VolumeStyle(),
                            const VolumeBudget& budget = {});

  /// Makes the next render() redraw.
  void forget();

  /// Returns how often it has drawn a picture or a part of one.
  long renders() const;
  /// Returns the scale of skin, organs and bone in the last picture: 1 is the full size, 2 a half, and so on to 5.
  int scale() const;
  /// Returns the last measured device time of a picture of full size, ms; 0 before the first measurement.
  double full_picture_ms() const;

  /// Rebuilds the shader from `sources`. If it fails to compile, the view keeps its current one and its log is
  /// returned.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::view
