#pragma once

#include <cstdint>
#include <memory>

#include "sim/core/grid.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/view/body/orbit_camera.h"
#include "sim/view/body/transfer_function.h"
#include "sim/view/body/volume_view.h"

namespace insonate::view {

/// What a person chooses about the volume rendering of a swept volume.
struct SweptLook {
  double threshold = 70;  ///< grey level from which tissue begins to show, 0 to kMaxSweptThreshold
  double opacity = 0.4;   ///< of 1 mm of tissue at white, 0 to kMaxOpacity
  bool operator==(const SweptLook&) const = default;
};
inline constexpr double kMaxSweptThreshold = 200;

/// Returns the look as a transfer function of the values of SweptView: dark red-brown at the threshold, through the
/// amber of ultrasound machines, to near white, with opacity that rises linearly.
TransferFunction swept_function(const SweptLook& look);

/// Draws a reconstructed ultrasound volume in 3D, by the same volume rendering as the CT (VolumeView). Grey levels are
/// smoothed with a standard deviation of 1.4 voxels first, because single grains of speckle are not surfaces. Voxels
/// that nothing was seen in are transparent. Needs a current OpenGL context.
class SweptView {
public:
  /// Grey levels are stored multiplied by this, so that the surfaces of tissue are as steep as those of a CT.
  static constexpr int kValuePerGrey = 3;

  /// Takes 0.7 s for 32 million voxels on two cores. Throws gl::TextureRefused.
  /// @param grey, known  on one grid; `known` is 0 unseen, 1 filled, 2 measured
  SweptView(const Volume<std::uint8_t>& grey, const Volume<std::uint8_t>& known, const gl::ShaderSources& sources = {});
  ~SweptView();

  /// Returns the picture, as VolumeView::render() does.
  /// @param face  a plane of the volume with its picture, alpha 0 where nothing was seen. Everything between the
  ///              camera and the plane is cut away. Without a picture nothing is cut.
  const gl::Texture& render(int width, int height, const OrbitCamera& camera, const SweptLook& look,
                            const UltrasoundPlane& face = UltrasoundPlane(), const VolumeBudget& budget = {});
  /// Returns as VolumeView::renders().
  long renders() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::view
