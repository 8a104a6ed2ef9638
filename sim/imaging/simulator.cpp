#include "sim/imaging/simulator.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/imaging/device_volume.h"
#include "sim/imaging/dirty_stages.h"
#include "sim/imaging/fan_layout.h"
#include "sim/imaging/picture_programs.h"
#include "sim/imaging/stage_tables.h"
#include "sim/imaging/view_limits.h"
#include "sim/model/noise.h"
#include "sim/model/settings_file.h"
#include "sim/shaders/shared/simulation_parameters.h"

namespace insonate::gl {
namespace {

// Transposes an image: the stages store one row per line, Stages one column per line.
Image<float> transposed(const Image<float>& rows) {
  Image<float> columns(rows.height, rows.width);
  for (int y = 0; y < rows.height; ++y)
    for (int x = 0; x < rows.width; ++x) columns.at(y, x) = rows.at(x, y);
  return columns;
}

// Reads back a stage's result of four numbers per sample, each number as an image. Blocks until the device has
// finished.
std::array<Image<float>, 4> read_fours(const TexelBuffer& buffer, int width, int height) {
  const Image<float> image(width, height);
  std::array<Image<float>, 4> images{image, image, image, image};
  std::vector<float> values(4 * image.pixels.size());
  buffer.read(values.data(), values.size() * sizeof values.front());
  for (std::size_t i = 0; i < values.size(); ++i) images[i % 4].pixels[i / 4] = values[i];
  return images;
}

}  // namespace

struct Simulator::State {
  State(const ShaderSources& sources, const WorkDivision& given)
      : division(given), line_stages(sources, given), programs(sources) {}

  const WorkDivision division;
  LineStages line_stages;
  PicturePrograms programs;

  // Inputs from the caller.
  Settings settings;
  Probe probe;
  double depth_mm = 160;
  Pose patient_from_probe;
  bool stages_are_read = false;  // set by read_stages(), which needs U even where a picture needs only grey

  // Derived from these.
  FanLayout fan;
  Gaussian reflection_gaussian, transmission_gaussian;

  // Inputs of the stages.
  DeviceVolume volume;
  SimulationParameters parameters{};
  Buffer parameter_buffer{sizeof(SimulationParameters), nullptr};
  TexelBuffer line_and_sample, noise, fan_weights;  // by pixel
  Buffer fan_blocks;
  double noise_length_mm = 0;  // grain of the noise

  // Results of the stages.
  TexelBuffer picture, sharp, half_smoothed, fused, levels;  // by pixel
  Buffer brightest;                                          // by block of the fan
  Buffer maximum_buffer{sizeof(GLuint), nullptr};
  Texture image;
  Buffer image_words;  // the picture as the shaders write it, one number per pixel: faster than storing to a texture

  bool layout_changed = true;  // probe, depth, sample count or picture size
  std::optional<Stage> first_outdated = Stage::traverse;
  std::array<long, kStageCount> runs{};
  int slice_planes_traversed = 0;  // by the last traversal

  std::size_t pixels() const { return std::size_t(settings.image_width) * std::size_t(settings.image_height); }
  bool frame_sets_white() const { return settings.reference_level == ReferenceLevel::frame_maximum; }

  void invalidate_from(Stage stage) { first_outdated = std::min(first_outdated.value_or(stage), stage); }

  void lay_out();
  void prepare();
  void run_through(Stage last);
  void run(Stage stage);
  void show() { image.write(GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, image_words); }
  bool needed(Stage stage) const;
  void prepare_smoothing();
  void prepare_fusion();
  void prepare_noise();
};

// Allocates what depends on the number of lines, samples and pixels, and computes where each pixel lies.
void Simulator::State::lay_out() {
  line_stages.lay_out(scan_lines(probe, depth_mm, settings.samples), 1, settings);
  const int w = settings.image_width, h = settings.image_height;
  fan = FanLayout(probe, depth_mm, line_stages.lines(), w, h, division);
  noise = TexelBuffer();
  line_and_sample = TexelBuffer(GL_RG32F, pixels(), fan.line_and_sample.data());
  fan_blocks = Buffer(fan.blocks.size() * sizeof(glm::ivec2), fan.blocks.data());
  brightest = Buffer(fan.blocks.size() * sizeof(GLuint), nullptr);
  picture = TexelBuffer(GL_RG32F, pixels());
  fan_weights = TexelBuffer();
  fused = TexelBuffer();
  levels = TexelBuffer();
  image = Texture::make_picture(w, h, Filter::linear);
  image_words = Buffer(pixels() * sizeof(GLuint), nullptr);
  image_words.clear();
  layout_changed = false;
}

// Prepares everything that the outdated stages read and that is not the result of another stage.
void Simulator::State::prepare() {
  if (layout_changed) lay_out();
  if (*first_outdated <= Stage::scan_convert) {
    prepare_smoothing();
    if (is_noisy(settings)) prepare_noise();
  }
  prepare_fusion();
  programs.build_from(*first_outdated,
                      {settings, reflection_gaussian.radius, transmission_gaussian.radius, stages_are_read});
  parameters = parameters_of(settings, line_stages.lines(), reflection_gaussian, transmission_gaussian);
  const glm::ivec2 shift = noise_shift(patient_from_probe) % glm::ivec2(settings.image_width, settings.image_height);
  parameters.noise_shift_x = shift.x;
  parameters.noise_shift_y = shift.y;
  parameter_buffer.write(&parameters, sizeof parameters);
}

void Simulator::State::prepare_smoothing() {
  const int w = settings.image_width, h = settings.image_height, limit = std::max(w, h) - 1;
  const double per_pixel = settings.waves ? 0 : 1 / fan.geometry.mm_per_pixel;  // waves are not smoothed
  const Gaussian reflection(settings.reflection_sigma_mm * per_pixel, limit);
  const Gaussian transmission(settings.transmission_sigma_mm * per_pixel, limit);
  if (fan_weights && reflection == reflection_gaussian && transmission == transmission_gaussian) return;
  reflection_gaussian = reflection;
  transmission_gaussian = transmission;
  fan_weights = weights_of_pixels(fan, reflection, transmission);
  const GLenum format = transmission.radius > 0 ? GL_RG32F : GL_R32F;
  sharp = TexelBuffer(format, pixels());
  half_smoothed = TexelBuffer(format, pixels());
  sharp.clear();
  half_smoothed.clear();
}

void Simulator::State::prepare_fusion() {
  if (stages_are_read && !fused) (fused = TexelBuffer(GL_R32F, pixels())).clear();
  if (frame_sets_white() && !levels) levels = TexelBuffer(GL_R32F, pixels());
}

void Simulator::State::prepare_noise() {
  if (noise && noise_length_mm == settings.reflection_length_mm) return;
  noise_length_mm = settings.reflection_length_mm;
  noise = settings.waves ? noise_waves_of_pixels(fan.geometry, line_stages.lines(), settings)
                         : noise_of_pixels(fan, line_stages.lines(), settings);
}

bool Simulator::State::needed(Stage stage) const {
  if (stage == Stage::smooth) return reflection_gaussian.radius > 0 || transmission_gaussian.radius > 0;
  if (stage == Stage::compress) return frame_sets_white();
  return true;
}

void Simulator::State::run_through(Stage last) {
  if (!first_outdated || *first_outdated > last || !volume) return;
  prepare();
  parameter_buffer.bind_uniform(0);
  for (Stage stage = *first_outdated; stage <= last; stage = Stage(int(stage) + 1)) {
    if (!needed(stage)) continue;
    run(stage);
    ++runs[std::size_t(stage)];
  }
  first_outdated = last == Stage::compress ? std::nullopt : std::optional(Stage(int(last) + 1));
}

void Simulator::State::run(Stage stage) {
  const auto over_fan = [&](const Program& program) { program.dispatch_groups(fan.groups.x, fan.groups.y); };
  fan_blocks.bind_storage(7);
  switch (stage) {
    case Stage::traverse:
      line_stages.restart_counts();
      slice_planes_traversed = settings.slice_planes;
      line_stages.traverse(volume, {&patient_from_probe, 1}, settings);
      break;
    case Stage::beam:
      line_stages.beam(settings);
      break;
    case Stage::scan_convert:
      line_stages.echoes().bind(0);
      line_and_sample.bind(1);
      noise.bind(2);
      line_stages.mean_echo().bind(3);
      picture.bind_storage(0);
      sharp.bind_storage(1);
      over_fan(programs.scan_convert);
      break;
    case Stage::smooth:
      sharp.bind(0);
      half_smoothed.bind_storage(0);
      over_fan(programs.smooth);
      break;
    case Stage::fuse:
      picture.bind(0);
      half_smoothed.bind(1);
      fan_weights.bind(2);
      brightest.clear();
      brightest.bind_storage(0);
      if (fused) fused.bind_storage(1);
      if (frame_sets_white())
        levels.bind_storage(2);
      else
        image_words.bind_storage(3);
      over_fan(programs.fuse);
      if (!frame_sets_white()) show();
      break;
    case Stage::compress:
      maximum_buffer.clear();
      brightest.bind_storage(0);
      maximum_buffer.bind_storage(1);
      programs.maximum.dispatch_groups(1);
      maximum_buffer.bind_storage(0);
      levels.bind(0);
      image_words.bind_storage(3);
      over_fan(programs.compress);
      show();
      break;
  }
}

Simulator::Simulator(const ShaderSources& sources, const WorkDivision& division)
    : state_(std::make_unique<State>(sources, division)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

void Simulator::set_volume(const AcousticVolume& volume, const TissueTable& table) {
  state_->volume = DeviceVolume(volume, table);
  state_->invalidate_from(Stage::traverse);
}

void Simulator::set_probe(const Probe& probe, double depth_mm) {
  check_probe("simulator", probe, depth_mm);
  if (probe == state_->probe && depth_mm == state_->depth_mm) return;
  state_->probe = probe;
  state_->depth_mm = depth_mm;
  state_->layout_changed = true;
  state_->invalidate_from(Stage::traverse);
}

void Simulator::set_settings(const Settings& settings) {
  if (settings == state_->settings) return;
  if (const auto why = why_not_valid(settings)) throw std::invalid_argument("simulator: " + *why);
  const DirtyStages dirty = dirty_stages(state_->settings, settings);
  state_->layout_changed |= dirty.layout;
  if (dirty.beam) state_->line_stages.change_beam();
  if (dirty.first) state_->invalidate_from(*dirty.first);
  state_->settings = settings;
}

void Simulator::set_pose(const Pose& patient_from_probe) {
  if (patient_from_probe == state_->patient_from_probe) return;
  check_pose("simulator", patient_from_probe);
  state_->patient_from_probe = patient_from_probe;
  state_->invalidate_from(Stage::traverse);
}

void Simulator::run_through(Stage last) {
  state_->run_through(last);
}

const Texture& Simulator::image() {
  state_->run_through(Stage::compress);
  return state_->image;
}

long Simulator::image_version() const {
  return state_->runs[std::size_t(Stage::fuse)] + state_->runs[std::size_t(Stage::compress)];
}
const ImageGeometry& Simulator::geometry() const {
  return state_->fan.geometry;
}
const Texture& Simulator::volume_texture() const {
  return state_->volume.texture();
}
const glm::dmat4& Simulator::texture_from_patient() const {
  return state_->volume.texture_from_patient();
}
std::size_t Simulator::volume_bytes() const {
  return state_->volume.texture().bytes();
}
const std::array<long, kStageCount>& Simulator::runs() const {
  return state_->runs;
}

SampleCounts Simulator::sample_counts() const {
  return state_->line_stages.sample_counts();
}

StageCount Simulator::count(Stage stage) const {
  const State& s = *state_;
  StageCount count{s.runs[std::size_t(stage)]};
  if (count.runs == 0) return count;
  const std::uint64_t samples = s.line_stages.lines().lines.size() * std::uint64_t(s.line_stages.lines().samples);
  switch (stage) {
    case Stage::traverse:
      count.possible = samples * std::uint64_t(s.slice_planes_traversed);
      count.evaluated = sample_counts().traversed;
      break;
    case Stage::beam:
      count.possible = count.evaluated = samples;
      break;
    case Stage::scan_convert:
    case Stage::smooth:
    case Stage::fuse:
    case Stage::compress:
      count.possible = std::uint64_t(s.image.width()) * std::uint64_t(s.image.height());
      count.evaluated = s.fan.pixels_in_blocks();
      break;
  }
  return count;
}

Stages<float> Simulator::read_stages() {
  if (!std::exchange(state_->stages_are_read, true)) state_->invalidate_from(Stage::fuse);
  run_through(Stage::compress);
  const State& s = *state_;
  Stages<float> stages;
  const int n = int(s.line_stages.lines().lines.size()), d = s.line_stages.lines().samples;
  const auto scan = read_fours(s.line_stages.scan(), d, n);
  const auto echoes = read_fours(s.line_stages.echoes(), d, n);
  stages.intensity = transposed(scan[0]);
  if (s.settings.waves) {
    stages.scattered = transposed(scan[1]);
    stages.echo_re = transposed(scan[2]);
    stages.echo_im = transposed(scan[3]);
    stages.wave_re = transposed(echoes[0]);
    stages.wave_im = transposed(echoes[1]);
  } else {
    stages.reflection = transposed(scan[1]);
    stages.reflection_beam = transposed(echoes[0]);
    stages.transmission = transposed(echoes[1]);
    stages.speckle = transposed(echoes[2]);
  }
  stages.repeated = transposed(echoes[3]);
  const int w = s.image.width(), h = s.image.height();
  stages.fused = Image<float>(w, h);
  s.fused.read(stages.fused.pixels.data(), stages.fused.pixels.size() * sizeof(float));
  Image<Rgba8> rgba(w, h);
  s.image.read(GL_RGBA, GL_UNSIGNED_BYTE, rgba.pixels.data(), rgba.pixels.size() * sizeof(Rgba8));
  stages.inside = Image<std::uint8_t>(w, h);
  stages.grey = Image<std::uint8_t>(w, h);
  for (std::size_t i = 0; i < rgba.pixels.size(); ++i) {
    stages.grey.pixels[i] = rgba.pixels[i][0];
    stages.inside.pixels[i] = rgba.pixels[i][3] ? 1 : 0;
  }
  return stages;
}

std::optional<std::string> Simulator::reload(const ShaderSources& sources) {
  std::vector<Program*> programs = state_->line_stages.programs();
  for (Program* program : state_->programs.all()) programs.push_back(program);
  const std::optional<std::string> problem = Program::reload(programs, sources);
  if (!problem) state_->invalidate_from(Stage::traverse);
  return problem;
}

}  // namespace insonate::gl
