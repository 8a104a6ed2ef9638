#include "sim/view/volume_view.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/shaders/shared/volume_view_parameters.h"
#include "sim/view/picture_target.h"
#include "sim/view/plane_state.h"
#include "sim/view/tissue_classes.h"

namespace insonate::view {
namespace {

constexpr int kCoarsest = 4;

// One sample every half voxel, fewer where pixels are coarser. Smoothing spreads an edge over two voxels, so that four
// samples lie in it and no steps show.
constexpr double kStepInVoxels = 0.5;
double step_mm(const PatientTextures& patient, int scale) {
  return kStepInVoxels * patient.tissue_voxel_mm() * (1 + 0.35 * (scale - 1));
}

VolumeViewParameters parameters_for(const PatientTextures& patient, const OrbitCamera& camera,
                                    const UltrasoundPlane& plane, const VolumeStyle& style, int width, int height,
                                    int scale) {
  const Pose patient_from_camera = camera.patient_from_camera();
  const double slope = std::tan(glm::radians(camera.field_of_view_deg / 2));
  const double aspect = double(width) / height;
  const auto axis = [&](int i, double length) {
    return glm::vec4(glm::vec3(patient_from_camera.rotation[i] * length), 0);
  };
  const ImageGeometry& g = plane.geometry;
  const bool curved = plane.probe.kind == ProbeKind::curvilinear;

  VolumeViewParameters p{};
  p.tissue_from_patient = glm::mat4(patient.tissue_from_patient());
  p.texture_from_patient = glm::mat4(patient.texture_from_patient());
  p.probe_from_patient = glm::mat4(plane.patient_from_probe.inverse().matrix());
  p.eye = glm::vec4(glm::vec3(patient_from_camera.translation), 1);
  p.right = axis(0, slope * aspect);
  p.down = axis(1, slope);
  p.into = axis(2, 1);
  p.picture = glm::vec4(width, height, 2 * slope / height, 0);
  // Texels extend half a pixel around their centres.
  p.image_geometry = glm::vec4(glm::vec2(g.top_left_mm - g.mm_per_pixel / 2), g.mm_per_pixel, 0);
  p.probe_shape = curved ? glm::vec4(plane.probe.radius_mm, glm::radians(plane.probe.field_of_view_deg / 2), 0, 0)
                         : glm::vec4(0, plane.probe.width_mm / 2, 0, 0);
  p.step_mm = float(step_mm(patient, scale));
  p.voxel_mm = float(patient.tissue_voxel_mm());
  p.skin = float(style.skin);
  p.cut_face = float(style.cut_face);
  p.cut = style.cut;
  p.show_plane = style.plane && plane.image;
  p.show_probe = style.probe;
  p.show_organs = style.organs;
  return p;
}

struct Inputs {
  int width, height;
  const PatientTextures* patient;
  OrbitCamera camera;
  PlaneState plane;
  VolumeStyle style;
  bool operator==(const Inputs&) const = default;
};

/// Measures how long drawing takes, from whole pictures: parts differ, because the patient lies in the middle. The
/// device time of a part is read only when the next part begins. By then it has long been ready, so that nothing waits.
class Pace {
public:
  void begin(bool first_part) {
    collect();
    if (first_part) sum_ms_ = sum_pixels_ = 0;
    timer_.begin();
  }
  void end(double pixels, bool last_part) {
    timer_.end();
    pending_pixels_ = pixels;
    pending_is_last_ = last_part;
  }
  /// Returns the time per pixel, ms; nothing before the first whole picture.
  std::optional<double> pixel_ms() {
    collect();
    return pixel_ms_;
  }

private:
  void collect() {
    if (pending_pixels_ == 0) return;
    sum_ms_ += timer_.milliseconds();
    sum_pixels_ += std::exchange(pending_pixels_, 0);
    if (pending_is_last_) pixel_ms_ = sum_ms_ / sum_pixels_;
  }

  gl::Timer timer_;
  double pending_pixels_ = 0;
  bool pending_is_last_ = false;
  double sum_ms_ = 0, sum_pixels_ = 0;
  std::optional<double> pixel_ms_;
};

}  // namespace

struct VolumeView::State {
  explicit State(const gl::ShaderSources& sources)
      : program(sources, {"view/full_screen.vert", "view/volume_view.frag"},
                {{"VOXELS_PER_BLOCK", std::to_string(TissueClasses::kBlock)}}) {}

  gl::Program program;
  gl::FullScreenTriangle triangle;
  gl::Buffer parameters{sizeof(VolumeViewParameters), nullptr};
  PictureTarget full, reduced;
  Pace pace;

  std::optional<Inputs> drawn;
  int scale = 1;         // scale of the picture shown
  int moving_scale = 1;  // scale of the last picture drawn while inputs changed
  int full_rows = 0;     // rows of the full picture drawn so far
  long renders = 0;

  int choose_scale(double full_pixels, double budget_ms);
  void draw(const PictureTarget& target, int first_row, int end_row, const PatientTextures& patient,
            const UltrasoundPlane& plane, const VolumeViewParameters& values);
};

// Returns the finest scale that fits the budget. A finer scale than the last is chosen only if it fits with room to
// spare, so that the picture does not flicker between two sharpnesses.
int VolumeView::State::choose_scale(double full_pixels, double budget_ms) {
  if (std::isinf(budget_ms)) return 1;
  const std::optional<double> pixel_ms = pace.pixel_ms();
  if (!pixel_ms) return kCoarsest;
  for (int candidate = 1; candidate < kCoarsest; ++candidate) {
    const double expected_ms = *pixel_ms * full_pixels / (candidate * candidate);
    if (expected_ms <= (candidate < moving_scale ? 0.75 : 1.0) * budget_ms) return candidate;
  }
  return kCoarsest;
}

void VolumeView::State::draw(const PictureTarget& target, int first_row, int end_row, const PatientTextures& patient,
                             const UltrasoundPlane& plane, const VolumeViewParameters& values) {
  parameters.write(&values, sizeof values);
  parameters.bind_uniform(0);
  patient.acoustic_volume().bind(0);
  if (plane.image) plane.image->bind(1);
  patient.tissue().bind(2);
  patient.body().bind(3);
  patient.distance().bind(4);
  const ScopedDrawTarget drawing(target, first_row, end_row);
  program.use();
  pace.begin(first_row == 0);
  triangle.draw();
  pace.end(double(target.texture.width()) * (end_row - first_row), end_row == target.texture.height());
  ++renders;
}

VolumeView::VolumeView(const gl::ShaderSources& sources) : state_(std::make_unique<State>(sources)) {}
VolumeView::~VolumeView() = default;
VolumeView::VolumeView(VolumeView&&) noexcept = default;
VolumeView& VolumeView::operator=(VolumeView&&) noexcept = default;

const gl::Texture& VolumeView::render(int width, int height, const PatientTextures& patient, const OrbitCamera& camera,
                                      const UltrasoundPlane& plane, const VolumeStyle& style, double budget_ms) {
  State& s = *state_;
  const Inputs inputs{width, height, &patient, camera, PlaneState(plane), style};
  if (s.drawn != inputs) {
    s.drawn = inputs;
    s.scale = s.moving_scale = s.choose_scale(double(width) * height, budget_ms);
    s.full_rows = s.scale == 1 ? height : 0;
    PictureTarget& target = s.scale == 1 ? s.full : s.reduced;
    const int w = (width + s.scale - 1) / s.scale, h = (height + s.scale - 1) / s.scale;
    target.resize(w, h);
    s.draw(target, 0, h, patient, plane, parameters_for(patient, camera, plane, style, w, h, s.scale));
    return target.texture;
  }
  if (s.full_rows < height) {
    s.full.resize(width, height);
    const double row_ms = s.pace.pixel_ms().value_or(0) * width;
    const int rows = row_ms * height <= budget_ms ? height : int(std::max(budget_ms / row_ms, height / 64.0)) + 1;
    const int first = s.full_rows;
    s.full_rows = std::min(first + rows, height);
    s.draw(s.full, first, s.full_rows, patient, plane, parameters_for(patient, camera, plane, style, width, height, 1));
    if (s.full_rows == height) s.scale = 1;
  }
  return s.scale == 1 ? s.full.texture : s.reduced.texture;
}

void VolumeView::forget() {
  state_->drawn.reset();
}

long VolumeView::renders() const {
  return state_->renders;
}

int VolumeView::scale() const {
  return state_->scale;
}

double VolumeView::full_picture_ms() const {
  const std::optional<Inputs>& drawn = state_->drawn;
  return drawn ? state_->pace.pixel_ms().value_or(0) * drawn->width * drawn->height : 0;
}

std::optional<std::string> VolumeView::reload(const gl::ShaderSources& sources) {
  const std::optional<std::string> problem = gl::Program::reload(std::array{&state_->program}, sources);
  if (!problem) forget();
  return problem;
}

}  // namespace insonate::view
