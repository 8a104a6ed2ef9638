#include "app/pictures/pictures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/model/effects.h"

namespace insonate {
namespace {

/// Below this width the fan's own samples are coarser than the screen.
constexpr int kMinWidth = 240;
/// A picture with a smaller share of the screen's pixels has half of the samples. With three quarters of the pixels
/// that takes its error from 4.0 to 4.6 dB and saves a fifth of its time (docs/benchmarks, front.csv: 480 x 360).
constexpr double kFewPixels = 0.8;
/// With a smaller share, the fewest that QualityGovernor asks for, the probe has two thirds of its lines too. That
/// takes the error from 4.6 to 5.4 dB and saves a sixth of the time (insonate-bench front with
/// --configuration 128,267,480,360, on two cores).
constexpr double kFewestPixels = 0.65;

/// A plane seen more edge-on than this (cosine of the angle to its normal) hides little of the patient, and cutting
/// there would remove most of the body.
constexpr double kEdgeOn = 0.4;

std::vector<std::string> label_names(const Case& subject) {
  std::vector<std::string> names(256);
  for (const Label& label : subject.label_table) names[label.value] = label.name;
  return names;
}

glm::vec3 white_of(BlendColour colour) {
  switch (colour) {
    case BlendColour::grey:
      break;
    case BlendColour::amber:
      return {1.0f, 0.72f, 0.30f};
    case BlendColour::green:
      return {0.45f, 1.0f, 0.55f};
  }
  return glm::vec3(1.0f);
}

}  // namespace

Settings settings_of(const Machine& machine) {
  // A log may contain any numbers. The scores use them unclamped.
  Settings settings = trainer_settings(std::clamp(machine.frequency_mhz, 1.0, 20.0), machine.depth_mm);
  settings.gain_db = std::clamp(machine.gain_db, -60.0, 60.0);
  settings.dynamic_range_db = machine.dynamic_range_db;
  settings.steering_angles = machine.steering_angles;
  settings.persistence = machine.persistence;
  settings.edge_enhancement = machine.edge_enhancement;
  settings.speckle_reduction = machine.speckle_reduction;
  settings.ring_down = kUsualRingDown;
  for (std::size_t i = 0; i < machine.time_gain_db.size(); ++i) settings.tgc_db[i] += machine.time_gain_db[i];
  for (const auto& [name, value] : machine.effects)
    if (const Effect* effect = find_effect(name)) effect->set(settings, value);
  return settings;
}

Machine with_usual_effects(Machine machine) {
  machine.effects.clear();
  return machine;
}

Pictures::Pictures(const gl::ShaderSources& sources, Quality level)
    : level_(level),
      simulator_(sources),
      slice_view_(sources),
      blend_view_(sources),
      volume_view_(sources),
      cut_view_(sources) {
  for (int axis = 0; axis < 3; ++axis) axis_slices_.emplace_back(sources);
}

void Pictures::show(const LoadedCase& loaded_case) {
  // Everything that the device may refuse comes first, so that the current patient stays on the screen then.
  view::PatientTextures patient(simulator_.volume_texture(), loaded_case.subject.ct, loaded_case.subject.labels,
                                view::colours_of_organs(label_names(loaded_case.subject)));
  simulator_.set_volume(loaded_case.acoustic, loaded_case.tissues);
  patient_ = std::move(patient);
  ultrasound_ = slice_ = blend_ = volume_ = nullptr;
  has_labels_ = !loaded_case.subject.labels.empty();
  outlined_.clear();
  for (std::size_t label = 1; label < patient_->colours().size(); ++label)
    if (patient_->colours()[label].opacity > 0) outlined_.push_back(std::uint8_t(label));
  for (AxisPicture& each : axis_slices_) {
    each.view.forget();
    each.picture = nullptr;
  }
  slices_to_cross_hair();
  slice_view_.forget();
  blend_view_.forget();
  volume_view_.forget();
  cut_view_.forget();
  grid_ = loaded_case.subject.ct.grid;
  reset_camera();
  look.begin(loaded_case.subject.name, loaded_case.subject.ct);
  look.offer(loaded_case.subject.label_table, patient_->colours());
}

void Pictures::update(const std::optional<Pose>& pose, const Machine& machine, const PictureSizes& sizes,
                      const Effort& effort, bool anatomy) {
  if (!patient_ || !pose) return;
  const int width = std::max(sizes.ultrasound_width, 1), height = std::max(sizes.ultrasound_height, 1);
  const auto high = [&](int wide) { return std::max(1, wide * height / width); };
  Settings settings = settings_of(machine);
  settings.image_width = std::min(width, 4096);
  settings.image_height = high(settings.image_width);
  double quality = effort.quality;
  if (ultrasound_ && settings == shown_ && *pose == shown_pose_) quality = std::max(quality, shown_quality_);
  shown_ = settings;
  shown_pose_ = *pose;
  shown_quality_ = quality;
  settings.image_width =
      std::max(int(std::lround(settings.image_width * quality)), std::min(kMinWidth, settings.image_width));
  settings.image_height = high(settings.image_width);
  const int few_samples = at_quality(settings, Quality::fast).samples;
  settings = at_quality(settings, level_);
  Probe probe = machine.transducer();
  if (level_ == Quality::balanced) {
    if (quality < kFewPixels) settings.samples = few_samples;
    if (quality < kFewestPixels) probe.lines = 2 * probe.lines / 3;
  }
  simulator_.set_probe(probe, machine.depth_mm);
  probe_name_ = machine.probe;
  depth_mm_ = machine.depth_mm;
  simulator_.set_settings(settings);
  simulator_.set_pose(*pose);
  // A frozen picture and that of a probe at rest are those of their pose alone.
  ultrasound_ = machine.frozen || effort.at_rest ? &simulator_.image() : &simulator_.image_in_motion();

  if (times_) times_->end(FramePart::ultrasound);

  plane_.image = ultrasound_;
  plane_.image_version = simulator_.image_version();
  plane_.geometry = simulator_.geometry();
  plane_.probe = machine.transducer();
  plane_.patient_from_probe = *pose;

  const bool shows_slice = anatomy && sizes.slice_width > 0, shows_blend = anatomy && sizes.blend_width > 0,
             shows_volume = sizes.volume_width > 0;
  // Slice and blend have one turn: beside each other they must show the same moment.
  constexpr std::size_t kOfPlane = 0, kVolume = 1, kAxes = 2;
  std::array<bool, 5> shown{shows_slice || shows_blend, shows_volume};
  for (std::size_t i = 0; i < axis_slices_.size(); ++i) shown[kAxes + i] = anatomy && sizes.axis_slices[i].x > 0;
  // The volume has two turns of a round: the probe's way is followed there.
  constexpr std::array kRound{kOfPlane, kVolume, kAxes, kAxes + 1, kAxes + 2, kVolume};
  const bool next = ++calls_since_turn_ >= effort.calls_per_turn;
  for (std::size_t i = 0; next && i < kRound.size(); ++i) {
    turn_ = (turn_ + 1) % kRound.size();
    if (shown[kRound[turn_]]) break;
  }
  if (next) calls_since_turn_ = 0;
  const auto is_due = [&](std::size_t view, const gl::Texture* drawn) {
    return shown[view] && (effort.calls_per_turn == 0 || (next && view == kRound[turn_]) || !drawn);
  };

  view::SliceStyle style;
  static_cast<view::CtStyle&>(style) = ct_style();
  const auto scale = [&](int wide, int tall) {
    return std::min(1.0, std::max(double(wide) / plane_.geometry.width, double(tall) / plane_.geometry.height));
  };
  if (!shows_slice) slice_ = nullptr;
  style.scale = scale(sizes.slice_width, sizes.slice_height);
  const bool of_plane_due =
      is_due(kOfPlane, shows_slice ? slice_ : blend_) || (shows_slice && !slice_) || (shows_blend && !blend_);
  if (shows_slice && of_plane_due) slice_ = &slice_view_.render(*patient_, plane_, style);
  if (!shows_blend) blend_ = nullptr;
  style.scale = scale(sizes.blend_width, sizes.blend_height);
  style.ultrasound = blend_share;
  style.ultrasound_white = white_of(ct.blend_colour);
  if (shows_blend && of_plane_due) blend_ = &blend_view_.render(*patient_, plane_, style);
  for (std::size_t i = 0; i < axis_slices_.size(); ++i) {
    if (!shown[kAxes + i]) axis_slices_[i].picture = nullptr;
    if (is_due(kAxes + i, axis_slices_[i].picture)) draw_axis_slice(view::SliceAxis(i), sizes.axis_slices[i]);
  }
  if (times_) times_->end(FramePart::slices);

  if (!camera_placed_)
    camera = view::OrbitCamera::facing(
        grid_, *pose, shows_volume ? double(sizes.volume_width) / std::max(sizes.volume_height, 1) : 1);
  camera_placed_ = true;
  view::VolumeStyle body;
  if (anatomy) {
    body = body_style();
  } else {
    body.organs = false;
    body.skin = 1;
  }
  body.cut = anatomy && look.hides_plane() &&
             std::abs(glm::dot(camera.patient_from_camera().rotation[2], pose->rotation[2])) > kEdgeOn;
  if (!shows_volume) volume_ = nullptr;
  if (is_due(kVolume, volume_)) {
    volume_camera_ = camera;
    volume_pose_ = *pose;
    volume_ = &volume_view_.render(sizes.volume_width, std::max(sizes.volume_height, 1), *patient_, camera, plane_,
                                   body, {0.4 * effort.volume_ms, 0.6 * effort.volume_ms});
  }
  if (times_) times_->end(FramePart::volume);
}

view::VolumeStyle Pictures::body_style() const {
  view::VolumeStyle body;
  if (look.shown()) {
    body.ct.emplace();
    body.ct->function = *look.shown();
    body.ct->structures = look.shown_structures();
  }
  return body;
}

view::CtStyle Pictures::ct_style() const {
  view::CtStyle style;
  style.window_hu = ct.grey.window_hu;
  style.level_hu = ct.grey.level_hu;
  if (ct.outlines) style.outlined = outlined_;
  return style;
}

void Pictures::draw_axis_slice(view::SliceAxis axis, const glm::ivec2& size) {
  AxisPicture& drawn = axis_slices_[std::size_t(axis)];
  glm::dvec3 through = cross_hair();
  through[view::normal_axis(axis)] += drawn.offset_mm;
  drawn.geometry = view::AxisSlice::fitting(axis, grid_, through, size.x, std::max(size.y, 1));
  drawn.picture = &drawn.view.render(*patient_, drawn.geometry, ct_style());
}

glm::dvec3 Pictures::cross_hair() const {
  return plane_.patient_from_probe.point({0, ct.cross_hair == CrossHair::face ? 0 : depth_mm_ / 2, 0});
}

void Pictures::move_slice(view::SliceAxis axis, int slices) {
  const double to_head_front_or_left = axis == view::SliceAxis::coronal ? -1 : 1;
  double& offset_mm = axis_slices_[std::size_t(axis)].offset_mm;
  offset_mm += to_head_front_or_left * slices * view::slice_step_mm(axis, grid_);
  // Within the volume, so that turning the wheel back moves the slice at once.
  glm::dvec3 through = cross_hair();
  const int normal = view::normal_axis(axis);
  const double at_cross_hair = through[normal];
  through[normal] += offset_mm;
  offset_mm = view::AxisSlice::fitting(axis, grid_, through, 1, 1).middle[normal] - at_cross_hair;
  if (std::abs(offset_mm) < 1e-9) offset_mm = 0;
}

void Pictures::slices_to_cross_hair() {
  for (AxisPicture& each : axis_slices_) each.offset_mm = 0;
}

void Pictures::look_from(view::Side side) {
  camera = view::OrbitCamera::from(side, grid_);
  side_ = side;
}

void Pictures::look_from_next() {
  using view::Side;
  constexpr std::array kRound{Side::front, Side::left, Side::back, Side::right, Side::head, Side::feet, Side::front};
  look_from(side_ ? *(std::find(kRound.begin(), kRound.end(), *side_) + 1) : kRound.front());
}

std::optional<Image<Rgba8>> Pictures::reference_picture(const ReferenceView& view) {
  if (!find_probe(view.probe)) return std::nullopt;
  Machine untouched;
  untouched.choose(view.probe);
  untouched.depth_mm = std::clamp(view.depth_mm, Machine::kMinDepth_mm, Machine::kMaxDepth_mm);
  return still(view.patient_from_probe, untouched);
}

std::optional<Image<Rgba8>> Pictures::still(const Pose& patient_from_probe, const Machine& machine) {
  const Probe* probe = find_probe(machine.probe);
  if (!ultrasound_ || !probe) return std::nullopt;
  Settings settings = settings_of(machine);
  settings.image_width = shown_.image_width;
  settings.image_height = shown_.image_height;
  simulator_.set_probe(*probe, machine.depth_mm);
  simulator_.set_settings(at_quality(settings, level_));
  simulator_.set_pose(patient_from_probe);
  return read_back(simulator_.image());
}

const gl::Texture* Pictures::draw_body(const view::OrbitCamera& from, int width, int height, double budget_ms) {
  if (!patient_) return nullptr;
  view::VolumeStyle body;
  body.cut = body.plane = body.probe = false;
  body.skin = 0.35;
  return volume_ = &volume_view_.render(width, height, *patient_, from, view::UltrasoundPlane(), body,
                                        {budget_ms, budget_ms});
}

const gl::Texture* Pictures::draw_cut(const view::UltrasoundPlane& plane, const view::OrbitCamera& from, int width,
                                      int height, const view::VolumeBudget& budget) {
  if (!patient_) return nullptr;
  view::VolumeStyle body = body_style();
  body.probe = false;
  return cut_ = &cut_view_.render(width, height, *patient_, from, plane, body, budget);
}

const gl::Texture* Pictures::draw_probe(const view::OrbitCamera& from, int width, int height, const Probe& probe,
                                        const Pose& patient_from_probe, bool on_body) {
  if (!patient_) return nullptr;
  view::VolumeStyle style;
  style.cut = style.plane = style.organs = false;
  style.skin = on_body ? 1 : 0;
  view::UltrasoundPlane plane;
  plane.probe = probe;
  plane.patient_from_probe = patient_from_probe;
  return volume_ = &volume_view_.render(width, height, *patient_, from, plane, style);
}

long Pictures::version_of(GLuint texture) const {
  const auto is = [&](const gl::Texture* picture) { return picture && picture->name() == texture; };
  if (is(ultrasound_)) return simulator_.image_version();
  if (is(slice_)) return slice_view_.renders();
  if (is(blend_)) return blend_view_.renders();
  if (is(volume_)) return volume_view_.renders();
  if (is(cut_)) return cut_view_.renders();
  for (const AxisPicture& each : axis_slices_)
    if (is(each.picture)) return each.view.renders();
  return 0;
}

double Pictures::fan_share() const {
  const Probe* probe = find_probe(probe_name_);
  if (!probe) return 1;
  const double fan_mm = image_geometry(*probe, depth_mm_, 1, 8192).mm_per_pixel;  // a single column is as wide as it
  return std::min(1.0, fan_mm / (geometry().mm_per_pixel * geometry().width));
}

long Pictures::simulator_runs() const {
  long sum = 0;
  for (const long runs : simulator_.runs()) sum += runs;
  return sum;
}

long Pictures::drawn() const {
  long sum = simulator_runs() + slice_view_.renders() + blend_view_.renders() + volume_view_.renders();
  for (const AxisPicture& each : axis_slices_) sum += each.view.renders();
  return sum;
}

std::optional<std::string> Pictures::reload(const gl::ShaderSources& sources) {
  std::string problems;
  const auto add = [&](const std::optional<std::string>& problem) {
    if (problem) problems += *problem + "\n";
  };
  add(simulator_.reload(sources));
  add(slice_view_.reload(sources));
  add(blend_view_.reload(sources));
  for (AxisPicture& each : axis_slices_) add(each.view.reload(sources));
  add(volume_view_.reload(sources));
  add(cut_view_.reload(sources));
  return problems.empty() ? std::nullopt : std::optional(problems);
}

Image<Rgba8> read_back(const gl::Texture& texture) {
  Image<Rgba8> image(texture.width(), texture.height());
  texture.read(GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data(), image.pixels.size() * sizeof(Rgba8));
  return image;
}

}  // namespace insonate
