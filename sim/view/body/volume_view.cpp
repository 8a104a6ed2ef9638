#include "sim/view/body/volume_view.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/gl/streamed_buffer.h"
#include "sim/shaders/view/volume_view_parameters.h"
#include "sim/view/body/classified_ct.h"
#include "sim/view/body/picture_area.h"
#include "sim/view/body/tissue_classes.h"
#include "sim/view/picture_target.h"
#include "sim/view/plane_state.h"

namespace insonate::view {
namespace {

// Of the layers, and of the plane and the silhouette, which are edges.
constexpr int kCoarsest = 5, kCoarsestPlane = 2;

// One sample every half voxel, fewer where pixels are coarser. Smoothing spreads an edge over two voxels, so that four
// samples lie in it and no steps show.
constexpr double kStepInVoxels = 0.5;
double coarsening(int scale) {
  return 1 + 0.35 * (scale - 1);
}
double step_mm(const PatientTextures& patient, int scale) {
  return kStepInVoxels * patient.tissue_voxel_mm() * coarsening(scale);
}

/// The rows of a picture from `first` to before `end`.
struct Rows {
  int first, end;
};

/// Returns the corners of a box around the probe's housing (view/probe_body.glsl) in the probe's frame, mm.
std::array<glm::dvec3, 2> box_of_probe(const Probe& probe) {
  constexpr double kGrip_mm = 20;   // more than half its thickness
  constexpr double kMarker_mm = 5;  // how far it stands out at the side
  constexpr double kLength_mm = 135;
  const double half_width_mm = probe.kind == ProbeKind::curvilinear
                                   ? probe.radius_mm * std::sin(glm::radians(probe.field_of_view_deg / 2))
                                   : probe.width_mm / 2;
  const double side_mm = std::max(half_width_mm + kMarker_mm, kGrip_mm);
  return {glm::dvec3(-side_mm, -kLength_mm, -kGrip_mm), glm::dvec3(side_mm, 2, kGrip_mm)};
}

VolumeViewParameters parameters_for(const PatientTextures& patient, const OrbitCamera& camera,
                                    const UltrasoundPlane& plane, const VolumeStyle& style, int width, int height,
                                    int scale, Rows rows) {
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
  const auto [low, high] = box_of_probe(plane.probe);
  p.probe_low = glm::vec4(glm::vec3(low), 0);
  p.probe_high = glm::vec4(glm::vec3(high), 0);
  p.step_mm = float(step_mm(patient, scale));
  p.voxel_mm = float(patient.tissue_voxel_mm());
  p.skin = float(style.skin);
  p.cut_face = float(style.cut_face);
  p.cut = style.cut;
  p.show_plane = style.plane && plane.image;
  p.show_probe = style.probe;
  p.show_organs = style.organs;
  p.first_row = rows.first;
  p.end_row = rows.end;
  if (style.ct) {
    p.ct_step_mm = float(style.ct->step * patient.ct_voxel_mm() * coarsening(scale));
    p.jitter = style.ct->jittered;
    p.skip_empty = style.ct->skips_empty;
    p.body_only = style.ct->body_only;
    p.structure_opacity = float(style.ct->structure_opacity);
  }
  return p;
}

struct VolumeInputs {
  int width, height;
  const PatientTextures* patient;
  OrbitCamera camera;
  PlaneState plane;
  VolumeStyle style;
  bool operator==(const VolumeInputs&) const = default;
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

/// What lies in front of the ultrasound's plane and behind it, and what hides the probe.
struct Layers {
  gl::Texture front, back, before_probe;
  gl::Framebuffer framebuffer;

  void resize(int width, int height) {
    if (front && front.width() == width && front.height() == height) return;
    front = gl::Texture::make_2d(GL_RGBA8, width, height, gl::Filter::linear);
    back = gl::Texture::make_2d(GL_RGBA8, width, height, gl::Filter::linear);
    before_probe = gl::Texture::make_2d(GL_R8, width, height, gl::Filter::linear);
    framebuffer = gl::Framebuffer({&front, &back, &before_probe});
  }
  void clear() const {
    constexpr GLfloat kEmpty[4] = {};
    for (GLint output = 0; output < 3; ++output) glClearBufferfv(GL_COLOR, output, kEmpty);
  }
};

}  // namespace

struct VolumeView::State {
  State(const gl::ShaderSources& sources, RayShader shader)
      : by_groups(shader == RayShader::compute),
        whole(sources,
              by_groups ? std::vector<std::string>{"view/volume_view.comp"}
                        : std::vector<std::string>{"view/full_screen.vert", "view/volume_view.frag"},
              kDefines),
        layers_program(sources, {"view/full_screen.vert", "view/volume_layers.frag"}, kDefines),
        finish(sources, {"view/full_screen.vert", "view/volume_finish.frag"}),
        silhouette(sources, {"view/silhouette.vert", "view/volume_view.frag"}, kDefines),
        classified(sources, shader) {}

  inline static const gl::Defines kDefines{{"VOXELS_PER_BLOCK", std::to_string(TissueClasses::kBlock)}};
  gl::Defines defines_for(const std::optional<CtVolumeStyle>& ct) const;
  bool by_groups;  // whole pictures are drawn by a compute shader
  gl::Program whole, layers_program, finish, silhouette;
  gl::FullScreenTriangle triangle;
  gl::Points points;
  gl::StreamedBuffer parameters;
  ClassifiedCt classified;
  PictureTarget full, reduced;
  gl::Buffer full_words;  // the full picture as a compute shader writes it, one number per pixel
  Layers layers;
  Pace pace, finish_pace;

  std::optional<VolumeInputs> drawn;
  int scale = 1;         // scale of the picture shown
  int moving_scale = 1;  // scale of the last picture drawn while inputs changed
  int finish_scale = 1;  // scale of the plane in that picture
  int full_rows = 0;     // rows of the full picture drawn so far
  long renders = 0;

  gl::Defines finish_defines(gl::Defines defines) const;
  void bind(const VolumeInputs& inputs, const UltrasoundPlane& plane, int width, int height, int coarseness, Rows rows);
  void draw_whole(const VolumeInputs& inputs, const UltrasoundPlane& plane, Rows rows);
  void cast_rays(const VolumeInputs& inputs, Rows rows);
  void draw_moving(const VolumeInputs& inputs, const UltrasoundPlane& plane);
  PictureArea draw_layers(const VolumeInputs& inputs, const UltrasoundPlane& plane);
  void draw_silhouette(const VolumeInputs& inputs, const PictureArea& area, float pixels_per_layer);
};

namespace {

/// Returns corners of the patient's box, or of what the cut leaves of it.
std::vector<glm::dvec3> points_of_body(const VolumeInputs& inputs, const UltrasoundPlane& plane) {
  const PatientTextures& patient = *inputs.patient;
  const BoxCorners box = corners_of(inputs.style.ct ? patient.texture_from_patient() : patient.tissue_from_patient());
  if (!inputs.style.cut) return {box.begin(), box.end()};
  std::vector<glm::dvec3> points = cut_through(box, plane.patient_from_probe);
  const Pose plane_from_patient = plane.patient_from_probe.inverse();
  const double eye = plane_from_patient.point(inputs.camera.patient_from_camera().translation).z;
  for (const glm::dvec3& corner : box)
    if (plane_from_patient.point(corner).z * eye < 0) points.push_back(corner);
  return points;
}

/// Returns corners of all that composite_plane() in view/volume_ray.glsl can show: the picture, and the cut's face.
std::vector<glm::dvec3> points_of_plane(const VolumeInputs& inputs, const UltrasoundPlane& plane) {
  std::vector<glm::dvec3> points;
  if (inputs.style.cut)
    points = cut_through(corners_of(inputs.patient->tissue_from_patient()), plane.patient_from_probe);
  if (!inputs.style.plane || !plane.image) return points;
  const ImageGeometry& g = plane.geometry;
  const glm::dvec2 size_mm = g.mm_per_pixel * glm::dvec2(plane.image->width(), plane.image->height());
  for (const double x : {0.0, size_mm.x})
    for (const double y : {0.0, size_mm.y})
      points.push_back(plane.patient_from_probe.point(glm::dvec3(g.top_left_mm + glm::dvec2(x, y), 0)));
  return points;
}

std::vector<glm::dvec3> points_of_probe(const VolumeInputs& inputs, const UltrasoundPlane& plane) {
  if (!inputs.style.probe) return {};
  const auto [low, high] = box_of_probe(plane.probe);
  std::vector<glm::dvec3> points;
  for (const double x : {low.x, high.x})
    for (const double y : {low.y, high.y})
      for (const double z : {low.z, high.z}) points.push_back(plane.patient_from_probe.point({x, y, z}));
  return points;
}

std::vector<glm::dvec3> points_of_all(const VolumeInputs& inputs, const UltrasoundPlane& plane) {
  std::vector<glm::dvec3> points = points_of_body(inputs, plane);
  for (const std::vector<glm::dvec3>& more : {points_of_plane(inputs, plane), points_of_probe(inputs, plane)})
    points.insert(points.end(), more.begin(), more.end());
  return points;
}

// Restricts drawing to an area, which may be empty.
void cut_to(const PictureArea& area) {
  glScissor(area.first.x, area.first.y, area.end.x - area.first.x, area.end.y - area.first.y);
}

// Returns the finest scale up to `coarsest` that fits the budget. A finer scale than the last is chosen only if it fits
// with room to spare, so that the picture does not flicker between two sharpnesses.
int chosen_scale(Pace& pace, double full_pixels, double budget_ms, int last, int coarsest) {
  if (std::isinf(budget_ms)) return 1;
  const std::optional<double> pixel_ms = pace.pixel_ms();
  if (!pixel_ms) return coarsest;
  for (int candidate = 1; candidate < coarsest; ++candidate) {
    const double expected_ms = *pixel_ms * full_pixels / (candidate * candidate);
    if (expected_ms <= (candidate < last ? 0.75 : 1.0) * budget_ms) return candidate;
  }
  return coarsest;
}

int scaled(int pixels, int scale) {
  return (pixels + scale - 1) / scale;
}

}  // namespace

gl::Defines VolumeView::State::defines_for(const std::optional<CtVolumeStyle>& ct) const {
  if (!ct) return kDefines;
  return {{"CT_MARCH", "1"},
          {"CT_CLASSIFICATION", ct->classification == Classification::post ? "POST_CLASSIFICATION" : "PRE_INTEGRATED"},
          {"CT_SHADED", gl::flag(ct->shaded)},
          {"STRUCTURES", gl::flag(classified.shows_structures())},
          {"VOXELS_PER_CELL", std::to_string(MacroCells::kSide)}};
}

// Adds what view/volume_ray.glsl needs to know of the second pass.
gl::Defines VolumeView::State::finish_defines(gl::Defines defines) const {
  if (finish_scale > 1) defines.emplace_back("FEW_PIXELS", "");
  return defines;
}

void VolumeView::State::bind(const VolumeInputs& inputs, const UltrasoundPlane& plane, int width, int height,
                             int coarseness, Rows rows) {
  const VolumeViewParameters values =
      parameters_for(*inputs.patient, inputs.camera, plane, inputs.style, width, height, coarseness, rows);
  if (inputs.style.ct) classified.update(*inputs.patient, *inputs.style.ct);
  parameters.write(&values, sizeof values);
  parameters.bind_uniform(0);
  inputs.patient->acoustic_volume().bind(0);
  if (plane.image) plane.image->bind(1);
  inputs.patient->tissue().bind(2);
  inputs.patient->body().bind(3);
  inputs.patient->distance().bind(4);
  inputs.patient->smooth_ct().bind(10);
  if (inputs.style.ct) classified.bind();
}

void VolumeView::State::draw_whole(const VolumeInputs& inputs, const UltrasoundPlane& plane, Rows rows) {
  if (by_groups && !full.has_size(inputs.width, inputs.height))
    full_words = gl::Buffer(std::size_t(inputs.width) * std::size_t(inputs.height) * sizeof(GLuint), nullptr);
  full.resize(inputs.width, inputs.height);
  bind(inputs, plane, inputs.width, inputs.height, 1, rows);
  whole.define(defines_for(inputs.style.ct));
  pace.begin(rows.first == 0);
  if (by_groups) {
    cast_rays(inputs, rows);
  } else {
    const ScopedDrawTarget drawing(full.framebuffer, rows.first, rows.end);
    finish.define({{"BACKGROUND", ""}});
    finish.use();
    triangle.draw();
    PictureArea area = area_of(points_of_all(inputs, plane), inputs.camera, inputs.width, inputs.height);
    area.first.y = std::clamp(area.first.y, rows.first, rows.end);
    area.end.y = std::clamp(area.end.y, rows.first, rows.end);
    cut_to(area);
    whole.use();
    triangle.draw();
  }
  pace.end(double(inputs.width) * (rows.end - rows.first), rows.end == inputs.height);
  ++renders;
}

// Draws by the compute shader. The picture becomes a texture once all of its rows are there.
void VolumeView::State::cast_rays(const VolumeInputs& inputs, Rows rows) {
  full_words.bind_storage(0);
  whole.dispatch(inputs.width, rows.end - rows.first);
  if (rows.end == inputs.height) full.texture.write(GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, full_words);
}

void VolumeView::State::draw_moving(const VolumeInputs& inputs, const UltrasoundPlane& plane) {
  const PictureArea area = draw_layers(inputs, plane);
  const int width = scaled(inputs.width, finish_scale), height = scaled(inputs.height, finish_scale);
  reduced.resize(width, height);
  bind(inputs, plane, width, height, scale, {0, height});
  layers.front.bind(5);
  layers.back.bind(6);
  layers.before_probe.bind(7);
  const ScopedDrawTarget drawing(reduced.framebuffer, 0, height);
  finish_pace.begin(true);
  const auto draw = [&](const gl::Defines& without, const PictureArea& part) {
    cut_to(part);
    finish.define(without);
    finish.use();
    triangle.draw();
  };
  const auto around = [&](const std::vector<glm::dvec3>& of) { return area_of(of, inputs.camera, width, height); };
  draw({{"WITHOUT_PLANE", ""}}, {{0, 0}, {width, height}});
  draw(finish_defines({{"WITHOUT_PROBE", ""}}), around(points_of_plane(inputs, plane)));
  draw(finish_defines({}), around(points_of_probe(inputs, plane)));
  finish_pace.end(double(width) * height, true);
  // A software renderer would draw all of it together, and the time of the silhouette, which has as many pixels of the
  // layers at each scale, would count as time of the plane.
  glFlush();
  cut_to({{0, 0}, {width, height}});
  draw_silhouette(inputs, area, float(width) / float(layers.front.width()));
  ++renders;
}

// Returns the area that the layers may show something in.
PictureArea VolumeView::State::draw_layers(const VolumeInputs& inputs, const UltrasoundPlane& plane) {
  const int width = scaled(inputs.width, scale), height = scaled(inputs.height, scale);
  const PictureArea area = area_of(points_of_body(inputs, plane), inputs.camera, width, height);
  layers.resize(width, height);
  bind(inputs, plane, width, height, scale, {0, height});
  const ScopedDrawTarget drawing(layers.framebuffer, 0, height);
  layers_program.define(defines_for(inputs.style.ct));
  layers_program.use();
  pace.begin(true);
  layers.clear();
  cut_to(area);
  triangle.draw();
  pace.end(double(width) * height, true);
  return area;
}

void VolumeView::State::draw_silhouette(const VolumeInputs& inputs, const PictureArea& area, float pixels_per_layer) {
  silhouette.define(finish_defines(defines_for(inputs.style.ct)));
  silhouette.use();
  const glm::ivec2 size = area.end - area.first;
  glUniform3i(silhouette.uniform("vertices"), area.first.x, area.first.y, size.x);
  points.draw(size.x * size.y, pixels_per_layer);
}

VolumeView::VolumeView(const gl::ShaderSources& sources, RayShader shader)
    : state_(std::make_unique<State>(sources, shader)) {}
VolumeView::~VolumeView() = default;
VolumeView::VolumeView(VolumeView&&) noexcept = default;
VolumeView& VolumeView::operator=(VolumeView&&) noexcept = default;

const gl::Texture& VolumeView::render(int width, int height, const PatientTextures& patient, const OrbitCamera& camera,
                                      const UltrasoundPlane& plane, const VolumeStyle& style,
                                      const VolumeBudget& budget) {
  State& s = *state_;
  const VolumeInputs inputs{width, height, &patient, camera, PlaneState(plane), style};
  const double pixels = double(width) * height;
  if (s.drawn != inputs) {
    if (s.drawn && s.drawn->style.ct.has_value() != style.ct.has_value())
      s.pace = Pace();  // costs several times as much
    s.drawn = inputs;
    s.scale = s.moving_scale = chosen_scale(s.pace, pixels, budget.volume_ms, s.moving_scale, kCoarsest);
    s.full_rows = s.scale == 1 ? height : 0;
    if (s.scale == 1) {
      s.draw_whole(inputs, plane, {0, height});
    } else {
      s.finish_scale =
          chosen_scale(s.finish_pace, pixels, budget.plane_ms, s.finish_scale, std::min(s.scale, kCoarsestPlane));
      s.draw_moving(inputs, plane);
    }
  } else if (s.full_rows < height) {
    const double row_ms = s.pace.pixel_ms().value_or(0) * width, budget_ms = budget.volume_ms + budget.plane_ms;
    const int rows = row_ms * height <= budget_ms ? height : int(std::max(budget_ms / row_ms, height / 64.0)) + 1;
    const int first = s.full_rows;
    s.full_rows = std::min(first + rows, height);
    s.draw_whole(inputs, plane, {first, s.full_rows});
    if (s.full_rows == height) s.scale = 1;
  }
  return s.scale == 1 ? s.full.texture : s.reduced.texture;
}

void VolumeView::forget() {
  state_->drawn.reset();
  state_->classified.forget();
}

long VolumeView::renders() const {
  return state_->renders;
}

int VolumeView::scale() const {
  return state_->scale;
}

double VolumeView::full_picture_ms() const {
  const std::optional<VolumeInputs>& drawn = state_->drawn;
  return drawn ? state_->pace.pixel_ms().value_or(0) * drawn->width * drawn->height : 0;
}

std::optional<std::string> VolumeView::reload(const gl::ShaderSources& sources) {
  std::vector<gl::Program*> programs = state_->classified.programs();
  programs.insert(programs.end(), {&state_->whole, &state_->layers_program, &state_->finish, &state_->silhouette});
  const std::optional<std::string> problem = gl::Program::reload(programs, sources);
  if (!problem) forget();
  return problem;
}

}  // namespace insonate::view
