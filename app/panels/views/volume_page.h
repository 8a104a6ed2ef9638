#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/pictures/pictures.h"
#include "app/recording/sweep_recorder.h"
#include "sim/view/body/orbit_camera.h"
#include "sim/view/body/swept_view.h"
#include "sim/view/mpr_planes.h"
#include "sim/view/mpr_view.h"

namespace insonate::ui {

enum class VolumeAnswer { none, close, save };

/// The page of a swept volume: three perpendicular planes through a point of it, the volume itself with the planes'
/// outlines, or the patient cut at the probe's plane, and how well it was swept. In a plane a drag moves the point, a
/// drag with the right button turns the two other planes, and the wheel moves the plane along its normal. The volume is
/// turned as the patient is in the 3D view. Needs the OpenGL context current.
class VolumePage {
public:
  /// @param swept   not null
  /// @param places  receives the rectangles of the planes and buttons
  /// @param pictures  the patient's
  VolumeAnswer draw(const Theme& theme, const Rect& screen, const std::shared_ptr<const SweptVolume>& swept,
                    Pictures& pictures, std::map<std::string, Rect>& places);

  /// Turns the planes back to the volume's axes and its middle, and the volume to its front.
  void reset();
  /// Cuts the volume at the imaging plane, or shows it whole.
  void switch_cut();
  /// Moves the imaging plane by a number of voxels along the sweep.
  void step(int voxels);
  const view::MprPlanes& planes() const { return planes_; }

  /// Returns a number that changes whenever the pixels of that texture do, if it is one of the planes; 0 if not.
  long version_of(GLuint texture) const;

private:
  void show(const std::shared_ptr<const SweptVolume>& swept);
  void draw_volume(const Theme& theme, const Rect& panel, Pictures& pictures, std::map<std::string, Rect>& places);
  view::UltrasoundPlane face();
  void draw_plane(const Theme& theme, const Rect& panel, view::MprPlane plane, double mm_per_pixel);

  std::shared_ptr<const SweptVolume> swept_;
  std::unique_ptr<view::SweptTexture> texture_;
  std::array<std::unique_ptr<view::MprView>, 3> views_;  ///< made when the page is first shown
  std::array<GLuint, 3> pictures_{};                     ///< textures of the views
  std::unique_ptr<view::SweptView> volume_;
  std::unique_ptr<view::MprView> face_;  ///< the imaging plane's picture in the volume
  GLuint volume_picture_ = 0;
  bool in_patient_ = false;  ///< shows the patient instead of the volume
  bool cut_ = true;          ///< whether the volume is cut at the imaging plane
  view::OrbitCamera camera_;
  view::SweptLook look_;
  float wheel_ = 0;  ///< turned by less than a step
  view::MprPlanes planes_;
  std::string problem_;
};

/// Draws the box of a swept volume as a wire frame over the 3D view.
void draw_swept_box(const Theme& theme, const Rect& space, const SweptVolume& swept, const view::OrbitCamera& camera);

}  // namespace insonate::ui
