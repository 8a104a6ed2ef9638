#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/pictures/ct_look.h"
#include "app/pictures/frame_times.h"
#include "app/pictures/patient_look.h"
#include "app/session/session.h"
#include "sim/imaging/simulator.h"
#include "sim/model/quality.h"
#include "sim/view/axis_slice_view.h"
#include "sim/view/body/orbit_camera.h"
#include "sim/view/body/volume_view.h"
#include "sim/view/slice_view.h"

namespace insonate {

/// Size of each picture on the screen, in pixels. A picture without width is not on the screen and not drawn. Only the
/// ultrasound is always drawn, because recordings, reports and OpenIGTLink clients take it.
struct PictureSizes {
  int ultrasound_width = 800, ultrasound_height = 560;
  int volume_width = 440, volume_height = 330;
  int slice_width = 220, slice_height = 200;
  int blend_width = 220, blend_height = 200;
  std::array<glm::ivec2, 3> axis_slices{};  ///< by view::SliceAxis
};

/// What drawing may leave out to be in time; by default nothing.
struct Effort {
  /// 0 to 1: the share of the screen's pixels, along each side, that the ultrasound is computed for. A picture that
  /// exists already is not drawn again with fewer pixels. Below 0.8 it has half of the samples too, and below 0.65
  /// two thirds of the lines, if its quality is balanced.
  double quality = 1;
  /// Time for the volume view, which gets coarser while things move to stay within it.
  double volume_ms = std::numeric_limits<double>::infinity();
  /// The views beside the ultrasound take turns: one of them is drawn per so many calls; 0: all of them in each. The
  /// volume view has two turns of a round.
  int calls_per_turn = 0;
  /// The ultrasound is that of a probe at rest, at once (gl::Simulator::image()), as where a recording stands still.
  bool at_rest = false;
};

/// Converts the machine's settings to the simulator's. The caller sets the picture's size.
Settings settings_of(const Machine& machine);

/// Returns the same machine without changed effects.
Machine with_usual_effects(Machine machine);

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
  /// @param anatomy  whether the patient's inside is shown. Without it slice(), blend() and axis_slice() are null and
  ///                 volume() shows the skin only.
  void update(const std::optional<Pose>& pose, const Machine& machine, const PictureSizes& sizes,
              const Effort& effort = {}, bool anatomy = true);
  /// Reports the time that each picture takes to `times`, which must outlive this object.
  void measure(FrameTimes& times) { times_ = &times; }

  /// Returns the ultrasound of a reference view with the machine's default settings, in the full resolution of the last
  /// picture. Row 0 is the top; the marker's side is on the right. To be called between two frames: ultrasound() is
  /// correct again after the next update(). Empty before update() has drawn a pose, and for an unknown probe.
  std::optional<Image<Rgba8>> reference_picture(const ReferenceView& view);
  /// Returns the ultrasound of a pose with a machine's settings, as reference_picture() does.
  std::optional<Image<Rgba8>> still(const Pose& patient_from_probe, const Machine& machine);
  /// Draws the body alone, without probe and ultrasound plane, from any side, and returns it; null without a patient.
  /// Replaces volume().
  const gl::Texture* draw_body(const view::OrbitCamera& from, int width, int height, double budget_ms);
  /// Draws the body as it looks, cut at a plane with a picture on the cut, from any side; null without a patient. The
  /// result is valid until the next call.
  const gl::Texture* draw_cut(const view::UltrasoundPlane& plane, const view::OrbitCamera& from, int width, int height,
                              const view::VolumeBudget& budget);
  /// Draws a probe, and the closed body if it is `on_body`, and returns it; null without a patient. Replaces volume().
  const gl::Texture* draw_probe(const view::OrbitCamera& from, int width, int height, const Probe& probe,
                                const Pose& patient_from_probe, bool on_body);
  const Grid& grid() const { return grid_; }
  /// Returns whether the patient has labels, whose outlines can be drawn.
  bool has_labels() const { return has_labels_; }

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
  /// These are null while they are not drawn.
  const gl::Texture* slice() const { return slice_; }
  const gl::Texture* blend() const { return blend_; }
  const gl::Texture* volume() const { return volume_; }
  /// Return what volume() was drawn with. Valid while that is not null.
  const view::OrbitCamera& volume_camera() const { return volume_camera_; }
  const Pose& volume_pose() const { return volume_pose_; }
  const gl::Texture* axis_slice(view::SliceAxis axis) const { return axis_slices_[std::size_t(axis)].picture; }
  /// Returns what axis_slice() shows. Valid while that is not null.
  const view::AxisSlice& axis_geometry(view::SliceAxis axis) const { return axis_slices_[std::size_t(axis)].geometry; }
  /// Returns the plane, probe and depth of the ultrasound. Valid while that is not null.
  const view::UltrasoundPlane& plane() const { return plane_; }
  double depth_mm() const { return depth_mm_; }
  /// Returns where the slices along the patient's axes cross unless they are moved, patient mm.
  glm::dvec3 cross_hair() const;
  /// Moves a slice by whole slices of the CT: to the patient's head, front or left.
  void move_slice(view::SliceAxis axis, int slices);
  /// Returns how far a slice was moved from the cross-hair, mm along the patient's x, y or z.
  double slice_offset_mm(view::SliceAxis axis) const { return axis_slices_[std::size_t(axis)].offset_mm; }
  /// Moves all slices back to the cross-hair.
  void slices_to_cross_hair();
  /// Returns the screen's pixels per pixel of volume(), along each side.
  int volume_scale() const { return volume_view_.scale(); }
  /// Returns the number of pictures of the volume view so far, or of parts of one while nothing moves.
  long volumes_drawn() const { return volume_view_.renders(); }
  const ImageGeometry& geometry() const { return simulator_.geometry(); }
  /// Returns the share of the pictures' width that the fan covers where it is widest, 0 to 1.
  double fan_share() const;

  view::OrbitCamera camera;   ///< facing the plane of a new patient's first pose
  double blend_share = 0.55;  ///< 0: the CT, 1: the ultrasound
  PatientLook look;           ///< in the 3D view, where the patient's inside may be seen
  CtLook ct;

  /// Returns how often any picture was drawn; each simulator stage that ran counts as one.
  long drawn() const;
  long simulator_runs() const;

  /// Rebuilds all shaders from `sources`. A picture whose shaders do not compile keeps its current ones, and the
  /// compiler's messages are returned.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  struct AxisPicture {
    explicit AxisPicture(const gl::ShaderSources& sources) : view(sources) {}

    view::AxisSliceView view;
    const gl::Texture* picture = nullptr;
    view::AxisSlice geometry;
    double offset_mm = 0;
  };

  view::CtStyle ct_style() const;
  /// Returns how the patient looks in 3D.
  view::VolumeStyle body_style() const;
  void draw_axis_slice(view::SliceAxis axis, const glm::ivec2& size);

  Quality level_;
  gl::Simulator simulator_;
  view::SliceView slice_view_, blend_view_;
  std::vector<AxisPicture> axis_slices_;  ///< by view::SliceAxis
  view::VolumeView volume_view_, cut_view_;
  std::optional<view::PatientTextures> patient_;
  Grid grid_;  ///< the patient's
  bool camera_placed_ = false;
  std::optional<view::Side> side_;  ///< that the patient was last looked at from, since the camera was placed
  const gl::Texture* ultrasound_ = nullptr;
  const gl::Texture* slice_ = nullptr;
  const gl::Texture* blend_ = nullptr;
  const gl::Texture* volume_ = nullptr;
  const gl::Texture* cut_ = nullptr;
  view::UltrasoundPlane plane_;
  view::OrbitCamera volume_camera_;
  Pose volume_pose_;
  bool has_labels_ = false;
  std::vector<std::uint8_t> outlined_;  ///< labels that have a colour
  std::string probe_name_;
  double depth_mm_ = 0;

  // State that the current ultrasound shows.
  Settings shown_;  ///< with the full resolution of the screen
  Pose shown_pose_;
  double shown_quality_ = 0;

  std::size_t turn_ = 0;      ///< which of the views that take turns was last
  int calls_since_turn_ = 0;  ///< that were drawn without its next one
  FrameTimes* times_ = nullptr;
};

/// Returns a texture's pixels, row 0 at the top.
Image<Rgba8> read_back(const gl::Texture& texture);

}  // namespace insonate
