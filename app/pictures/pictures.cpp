#include "app/pictures/pictures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace insonate {
namespace {

/// Below this width the fan's own samples are coarser than the screen.
constexpr int kLeastWidth = 240;

/// A plane seen more edge-on than this (cosine of the angle to its normal) hides little of the patient, and cutting
/// there would remove most of the body.
constexpr double kEdgeOn = 0.4;

std::vector<std::string> label_names(const Case& subject) {
  std::vector<std::string> names(256);
  for (const Label& label : subject.label_table) names[label.value] = label.name;
  return names;
}

/// Converts the machine's settings to the simulator's. The caller sets the picture's size.
Settings settings_of(const Machine& machine) {
  // A log may contain any numbers. The scores use them unclamped.
  Settings settings = trainer_settings(std::clamp(machine.frequency_mhz, 1.0, 20.0), machine.depth_mm);
  settings.gain_db = std::clamp(machine.gain_db, -60.0, 60.0);
  settings.dynamic_range_db = machine.dynamic_range_db;
  for (std::size_t i = 0; i < machine.time_gain_db.size(); ++i) settings.tgc_db[i] += machine.time_gain_db[i];
  return settings;
}

}  // namespace

Pictures::Pictures(const gl::ShaderSources& sources, Quality level)
    : level_(level), simulator_(sources), slice_view_(sources), blend_view_(sources), volume_view_(sources) {}

void Pictures::show(const LoadedCase& loaded_case) {
  // Everything that the device may refuse comes first, so that the current patient stays on the screen then.
  view::PatientTextures patient(simulator_.volume_texture(), loaded_case.subject.ct, loaded_case.subject.labels,
                                view::colours_of_organs(label_names(loaded_case.subject)));
  simulator_.set_volume(loaded_case.acoustic, loaded_case.tissues);
  patient_ = std::move(patient);
  ultrasound_ = slice_ = blend_ = volume_ = nullptr;
  slice_view_.forget();
  blend_view_.forget();
  volume_view_.forget();
  grid_ = loaded_case.subject.ct.grid;
  reset_camera();
  look.begin(loaded_case.subject.name, loaded_case.subject.ct);
}

void Pictures::update(const std::optional<Pose>& pose, const Machine& machine, const PictureSizes& sizes,
                      const Effort& effort, bool anatomy) {
  if (!patient_ || !pose) return;
  if (machine.probe != probe_name_ || machine.depth_mm != depth_mm_) {
    simulator_.set_probe(machine.transducer(), machine.depth_mm);
    probe_name_ = machine.probe;
    depth_mm_ = machine.depth_mm;
  }
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
      std::max(int(std::lround(settings.image_width * quality)), std::min(kLeastWidth, settings.image_width));
  settings.image_height = high(settings.image_width);
  simulator_.set_settings(at_quality(settings, level_));
  simulator_.set_pose(*pose);
  ultrasound_ = &simulator_.image();

  if (times_) times_->end(FramePart::ultrasound);

  view::UltrasoundPlane plane;
  plane.image = ultrasound_;
  plane.image_version = simulator_.image_version();
  plane.geometry = simulator_.geometry();
  plane.probe = machine.transducer();
  plane.patient_from_probe = *pose;
  turn_ = (turn_ + 1) % 3;
  const auto is_due = [&](int turn, const gl::Texture* drawn) { return !effort.turns || turn == turn_ || !drawn; };
  view::SliceStyle style;
  style.scale = std::min(1.0, std::max(double(sizes.slice_width) / plane.geometry.width,
                                       double(sizes.slice_height) / plane.geometry.height));
  if (!anatomy) slice_ = blend_ = nullptr;
  if (anatomy && is_due(0, slice_)) slice_ = &slice_view_.render(*patient_, plane, style);
  style.ultrasound = blend_share;
  if (anatomy && is_due(1, blend_)) blend_ = &blend_view_.render(*patient_, plane, style);
  if (times_) times_->end(FramePart::slices);

  if (!camera_placed_) camera = view::OrbitCamera::facing(grid_, *pose);
  camera_placed_ = true;
  view::VolumeStyle body;
  if (!anatomy) {
    body.organs = false;
    body.skin = 1;
  } else if (look.shown()) {
    body.ct.emplace();
    body.ct->function = *look.shown();
  }
  body.cut = anatomy && std::abs(glm::dot(camera.patient_from_camera().rotation[2], pose->rotation[2])) > kEdgeOn;
  if (is_due(2, volume_))
    volume_ = &volume_view_.render(std::max(sizes.volume_width, 1), std::max(sizes.volume_height, 1), *patient_, camera,
                                   plane, body, {0.5 * effort.volume_ms, 0.5 * effort.volume_ms});
  if (times_) times_->end(FramePart::volume);
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
  const Probe* probe = find_probe(view.probe);
  if (!ultrasound_ || !probe) return std::nullopt;
  Machine untouched;
  untouched.choose(view.probe);
  untouched.depth_mm = std::clamp(view.depth_mm, Machine::kLeastDepth_mm, Machine::kMostDepth_mm);
  Settings settings = settings_of(untouched);
  settings.image_width = shown_.image_width;
  settings.image_height = shown_.image_height;
  simulator_.set_probe(*probe, untouched.depth_mm);
  simulator_.set_settings(at_quality(settings, level_));
  simulator_.set_pose(view.patient_from_probe);
  probe_name_.clear();  // forces the next update() to set the session's probe again
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

long Pictures::version_of(GLuint texture) const {
  const auto is = [&](const gl::Texture* picture) { return picture && picture->name() == texture; };
  if (is(ultrasound_)) return simulator_.image_version();
  if (is(slice_)) return slice_view_.renders();
  if (is(blend_)) return blend_view_.renders();
  if (is(volume_)) return volume_view_.renders();
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
  return simulator_runs() + slice_view_.renders() + blend_view_.renders() + volume_view_.renders();
}

std::optional<std::string> Pictures::reload(const gl::ShaderSources& sources) {
  std::string problems;
  for (const auto& problem : {simulator_.reload(sources), slice_view_.reload(sources), blend_view_.reload(sources),
                              volume_view_.reload(sources)})
    if (problem) problems += *problem + "\n";
  return problems.empty() ? std::nullopt : std::optional(problems);
}

Image<Rgba8> read_back(const gl::Texture& texture) {
  Image<Rgba8> image(texture.width(), texture.height());
  texture.read(GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data(), image.pixels.size() * sizeof(Rgba8));
  return image;
}

}  // namespace insonate
