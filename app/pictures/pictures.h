#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "app/pictures/frame_times.h"
#include "app/pictures/patient_look.h"
#include "app/session/session.h"
#include "sim/imaging/simulator.h"
#include "sim/model/quality.h"
#include "sim/view/orbit_camera.h"
#include "sim/view/slice_view.h"
#include "sim/view/volume_view.h"

namespace insonate {

/// Size of each picture on the screen, in pixels.
struct PictureSizes {
  int ultrasound_width = 800, ultrasound_height = 560;
  int volume_width = 440, volume_height = 330;
  int slice_width = 220, slice_height = 200;  ///< of the slice and of the blend
};

/// What drawing may leave out to be in time; by default nothing.
struct Effort {
  /// 0 to 1: the share of the screen's pixels, along each side, that the ultrasound is computed for. A picture that
  /// exists already is not drawn again with fewer pixels.
  double quality = 1;
  /// Time for the volume view, which gets coarser while things move to stay within it.
  double volume_ms = std::numeric_limits<double>::infinity();
  /// The views beside the ultrasound take turns: each call draws one of them.
  bool turns = false;
};

/// Draws a session's pictures on the graphics card, each only when something it shows has changed. Needs an OpenGL 4.5
/// context from construction to destruction.
class Pictures {
public:
  /// @param level  quality of the ultrasound
  explicit Pictures(const gl::ShaderSources& sources = {}, Quality level = Quality::balanced);

  /// Uploads a patient, which takes some tenths of a second. `loaded_case` must outlive this object or stay until the
  /// next one is shown. Throws gl::TextureRefused if the device cannot hold the patient beside the previous one; the
  /// previous one stays shown then.
  void show(const LoadedCase& loaded_case);

  /// Chooses another quality of the ultrasound, from the next update() on.
  void choose(Quality level) { level_ = level; }

  /// Draws the pictures whose content has changed.
  void update(const Session& session, const PictureSizes& sizes, const Effort& effort = {}) {
    update(session.shown_pose(), session.machine(), sizes, effort, session.shows_anatomy());
  }
  /// Does the same for a given pose, which may be empty, and a given machine.
  /// @param anatomy  whether the patient's inside is shown. Without it slice() and blend() are null and volume() shows
  ///                 the skin only.
  void update(const std::optional<Pose>& pose, const Machine& machine, const PictureSizes& sizes,
              const Effort& effort = {}, bool anatomy = true);
  /// Reports the time that each picture takes to `times`, which must outlive this object.
  void measure(FrameTimes& times) { times_ = &times; }

  /// Returns the ultrasound of a reference view with the machine's default settings, in the full resolution of the last
  /// picture. Row 0 is the top; the marker's side is on the right. To be called between two frames: ultrasound() is
  /// correct again after the next update(). Empty before update() has drawn a pose, and for an unknown probe.
  std::optional<Image<Rgba8>> reference_picture(const ReferenceView& view);
  /// Draws the body alone, without probe and ultrasound plane, from any side, and returns it; null without a patient.
  /// Replaces volume().
  const gl::Texture* draw_body(const view::OrbitCamera& from, int width, int height, double budget_ms);
  const Grid& grid() const { return grid_; }

  /// Shows the whole patient from one side in volume().
  void look_from(view::Side side);
  /// Does so from the side after the last one: the front first.
  void look_from_next();
  /// Turns the camera back to the plane of the ultrasound, as for a new patient.
  void reset_camera() {
    camera_placed_ = false;
    side_.reset();
  }

  /// Null before update() has drawn a pose. Row 0 is the top; the marker's side is on the right.
  const gl::Texture* ultrasound() const { return ultrasound_; }
  /// Returns a number that changes whenever the ultrasound's pixels change.
  long ultrasound_version() const { return simulator_.image_version(); }
  /// Returns a number that changes whenever the pixels of that texture do, if it is one of the pictures; 0 if not.
  long version_of(GLuint texture) const;
  const gl::Texture* slice() const { return slice_; }
  const gl::Texture* blend() const { return blend_; }
  const gl::Texture* volume() const { return volume_; }
  /// Returns the screen's pixels per pixel of volume(), along each side.
  int volume_scale() const { return volume_view_.scale(); }
  const ImageGeometry& geometry() const { return simulator_.geometry(); }
  /// Returns the share of the pictures' width that the fan covers where it is widest, 0 to 1.
  double fan_share() const;

  view::OrbitCamera camera;   ///< facing the plane of a new patient's first pose
  double blend_share = 0.55;  ///< 0: the CT, 1: the ultrasound
  PatientLook look;           ///< in the 3D view, where the patient's inside may be seen

  /// Returns how often any picture was drawn; each simulator stage that ran counts as one.
  long drawn() const;
  long simulator_runs() const;

  /// Rebuilds all shaders from `sources`. A picture whose shaders do not compile keeps its current ones, and the
  /// compiler's messages are returned.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  Quality level_;
  gl::Simulator simulator_;
  view::SliceView slice_view_, blend_view_;
  view::VolumeView volume_view_;
  std::optional<view::PatientTextures> patient_;
  Grid grid_;  ///< the patient's
  bool camera_placed_ = false;
  std::optional<view::Side> side_;  ///< that the patient was last looked at from, since the camera was placed
  const gl::Texture* ultrasound_ = nullptr;
  const gl::Texture* slice_ = nullptr;
  const gl::Texture* blend_ = nullptr;
  const gl::Texture* volume_ = nullptr;
  std::string probe_name_;
  double depth_mm_ = 0;

  // State that the current ultrasound shows.
  Settings shown_;  ///< with the full resolution of the screen
  Pose shown_pose_;
  double shown_quality_ = 0;

  int turn_ = 0;  ///< counts the views that take turns
  FrameTimes* times_ = nullptr;
};

/// Returns a texture's pixels, row 0 at the top.
Image<Rgba8> read_back(const gl::Texture& texture);

}  // namespace insonate
