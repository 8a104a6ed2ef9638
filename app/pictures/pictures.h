#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/session/session.h"
#include "sim/imaging/simulator.h"
#include "sim/model/quality.h"
#include "sim/view/orbit_camera.h"
#include "sim/view/slice_view.h"
#include "sim/view/volume_view.h"

namespace insonate {

/// How many pixels the screen has for each picture.
struct PictureSizes {
  int ultrasound_width = 800, ultrasound_height = 560;
  int volume_width = 440, volume_height = 330;
};

/// The graphics card's side of a session: draws its pictures, each only when something it shows has changed. Needs an
/// OpenGL 4.5 context from construction to destruction.
class Pictures {
public:
  /// @param level  of the ultrasound
  explicit Pictures(const gl::ShaderSources& sources = {}, Quality level = Quality::balanced);

  /// Uploads a patient; takes some tenths of a second. The loaded_case outlives this or the next one shown. Throws
  /// gl::TextureRefused, and goes on as it was, when the device cannot hold the patient beside the one before.
  void show(const LoadedCase& loaded_case);

  /// Draws what is due.
  /// @param quality    0 to 1: the share of the screen's pixels that the ultrasound is computed for, along each side; a
  ///                   picture that is there already is not drawn again with fewer
  /// @param budget_ms  for the volume view, which gets coarser while things move to stay within it
  void update(const Session& session, const PictureSizes& sizes, double quality, double budget_ms) {
    update(session.shown_pose(), session.machine(), sizes, quality, budget_ms, session.shows_anatomy());
  }
  /// The same of a pose, or of none, and a machine that are at hand.
  /// @param anatomy  whether the patient is shown from within: without it there is no slice() and no blend(), and
  ///                 volume() shows the skin alone
  void update(const std::optional<Pose>& pose, const Machine& machine, const PictureSizes& sizes, double quality,
              double budget_ms, bool anatomy = true);

  /// The ultrasound of a reference view as the machine shows it before anything on it was changed, with all of the
  /// pixels that the screen had for the last picture; row 0 is the top, the marker's side on the right. To be called
  /// between two frames: what ultrasound() shows is right again after the next update(). Empty until update() had a
  /// pose to draw, and for an unknown probe.
  std::optional<Image<Rgba8>> reference_picture(const ReferenceView& view);
  /// The body alone, without probe and picture, from any side; null without a patient. Takes the place of volume().
  const gl::Texture* draw_body(const view::OrbitCamera& from, int width, int height, double budget_ms);
  const Grid& grid() const { return grid_; }

  /// Null until update() had a pose to draw. Row 0 is the top; the marker's side is on the right.
  const gl::Texture* ultrasound() const { return ultrasound_; }
  /// Another number whenever its pixels changed.
  long ultrasound_version() const { return simulator_.image_version(); }
  const gl::Texture* slice() const { return slice_; }
  const gl::Texture* blend() const { return blend_; }
  const gl::Texture* volume() const { return volume_; }
  const ImageGeometry& geometry() const { return simulator_.geometry(); }

  view::OrbitCamera camera;   ///< faces the plane of a new patient's first pose
  double blend_share = 0.55;  ///< 0: the CT, 1: the ultrasound

  /// How often any picture was drawn; a stage of the simulator that ran counts as one.
  long drawn() const;
  long simulator_runs() const;

  /// Builds all shaders from other sources; a picture one of whose shaders does not build goes on as it was, and that
  /// is told of.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  Quality level_;
  gl::Simulator simulator_;
  view::SliceView slice_view_, blend_view_;
  view::VolumeView volume_view_;
  std::optional<view::PatientTextures> patient_;
  Grid grid_;  ///< the patient's
  bool camera_placed_ = false;
  const gl::Texture* ultrasound_ = nullptr;
  const gl::Texture* slice_ = nullptr;
  const gl::Texture* blend_ = nullptr;
  const gl::Texture* volume_ = nullptr;
  std::string probe_name_;
  double depth_mm_ = 0;

  // What the ultrasound shows.
  Settings shown_;  ///< all of the screen's pixels
  Pose shown_pose_;
  double shown_quality_ = 0;
};

/// A texture's pixels, row 0 at the top.
Image<Rgba8> read_back(const gl::Texture& texture);

}  // namespace insonate
