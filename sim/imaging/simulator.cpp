#include "sim/imaging/simulator.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/gl/streamed_buffer.h"
#include "sim/imaging/device_volume.h"
#include "sim/imaging/dirty_stages.h"
#include "sim/imaging/fan_layout.h"
#include "sim/imaging/picture_programs.h"
#include "sim/imaging/stage_tables.h"
#include "sim/imaging/view_limits.h"
#include "sim/model/compounding.h"
#include "sim/model/display_filter.h"
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
  struct Look {
    ScanLines lines;
    TexelBuffer line_and_sample;  // by pixel
    bool is_old = true;           // of another pose, or not computed yet
  };
  std::vector<Look> looks;     // by angle
  std::size_t next_look = 0;   // in motion
  bool continues = false;      // only the pose has changed since the last picture
  bool holds_before = false;   // `shown` holds some of a frame before
  double of_frame_before = 0;  // its share in this frame
  Gaussian reflection_gaussian, transmission_gaussian;

  // Inputs of the stages.
  DeviceVolume volume;
  SimulationParameters parameters{};
  StreamedBuffer parameter_buffer;
  TexelBuffer noise, fan_weights;  // by pixel
  Buffer fan_blocks;
  double noise_length_mm = 0;  // grain of the noise

  // Results of the stages.
  TexelBuffer picture, sharp, half_smoothed, fused, levels, shown, window_sums;  // by pixel
  Buffer brightest;                                                              // by block of the fan
  Buffer maximum_buffer{sizeof(GLuint), nullptr};
  Texture image;
  Buffer image_words;  // the picture as the shaders write it, one number per pixel: faster than storing to a texture

  bool layout_changed = true;  // probe, depth, sample count or picture size
  std::optional<Stage> first_outdated = Stage::traverse;
  std::array<long, kStageCount> runs{};
  int slice_planes_traversed = 0;  // by the last traversal

  std::size_t pixels() const { return std::size_t(settings.image_width) * std::size_t(settings.image_height); }
  bool frame_sets_white() const { return settings.reference_level == ReferenceLevel::frame_maximum; }

  bool is_compounded() const { return looks.size() > 1; }
  bool any_old() const { return std::ranges::any_of(looks, &Look::is_old); }

  // All looks share the buffers of the stages up to scan conversion.
  void invalidate_from(Stage stage) {
    first_outdated = std::min(first_outdated.value_or(stage), stage);
    if (stage <= Stage::scan_convert)
      for (Look& look : looks) look.is_old = true;
  }

  void lay_out();
  void prepare(int filter_radius);
  void write_parameters(std::size_t look);
  void run_through(Stage last, bool in_motion = false);
  void run_looks(Stage last, bool in_motion);
  void run_stages(Stage first, Stage last);
  void run(Stage stage);
  void show() { image.write(GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, image_words); }
  bool needed(Stage stage) const;
  void prepare_smoothing();
  void prepare_fusion(int filter_radius);
  void prepare_noise();
};

// Allocates what depends on the number of lines, samples and pixels, and computes where each pixel lies.
void Simulator::State::lay_out() {
  looks.clear();
  next_look = 0;
  for (const double angle : look_angles(probe, settings))
    looks.push_back({scan_lines(probe, depth_mm, settings.samples, angle), {}});
  line_stages.lay_out(looks[looks.size() / 2].lines, 1, settings);
  const int w = settings.image_width, h = settings.image_height;
  fan.lay_out(probe, depth_mm, line_stages.lines(), w, h, division);
  noise = TexelBuffer();
  for (Look& look : looks) {
    if (look.lines.fan.steering == 0)
      look.line_and_sample = TexelBuffer(GL_RG32F, pixels(), fan.line_and_sample.data());
    else
      look.line_and_sample = TexelBuffer(GL_RG32F, pixels(), places_among(look.lines, fan.geometry).data());
  }
  fan_blocks = Buffer(fan.blocks.size() * sizeof(glm::ivec2), fan.blocks.data());
  brightest = Buffer(fan.blocks.size() * sizeof(GLuint), nullptr);
  if (is_compounded())
    picture.resize(GL_R32F, looks.size() * pixels());
  else
    picture.resize(GL_RG32F, pixels());
  shown = TexelBuffer();
  window_sums = TexelBuffer();
  fan_weights = TexelBuffer();
  fused = TexelBuffer();
  if (image.width() != w || image.height() != h) {
    // Both or none, should the device refuse one.
    Texture picture_of_size = Texture::make_picture(w, h, Filter::linear);
    image_words = Buffer(pixels() * sizeof(GLuint), nullptr);
    image = std::move(picture_of_size);
  }
  image_words.clear();
  layout_changed = false;
}

// Prepares everything that the outdated stages read and that is not the result of another stage.
void Simulator::State::prepare(int filter_radius) {
  if (*first_outdated <= Stage::scan_convert) {
    prepare_smoothing();
    if (is_noisy(settings)) prepare_noise();
  }
  prepare_fusion(filter_radius);
  programs.build_from(*first_outdated, {settings, reflection_gaussian.radius, transmission_gaussian.radius,
                                        int(looks.size()), filter_radius, stages_are_read});
  write_parameters(looks.size() / 2);
}

// Writes the block of parameters for one of the looks.
void Simulator::State::write_parameters(std::size_t look) {
  const std::size_t straight = looks.size() / 2;
  parameters = parameters_of(settings, looks[look].lines, reflection_gaussian, transmission_gaussian);
  const glm::ivec2 shift = noise_shift(patient_from_probe, look == straight ? 0 : int(look) + 1) %
                           glm::ivec2(settings.image_width, settings.image_height);
  parameters.noise_shift_x = shift.x;
  parameters.noise_shift_y = shift.y;
  parameters.look = int(look);
  parameters.of_frame_before = float(of_frame_before);
  parameters.speckle_variance = float(speckle_variance(settings, int(looks.size())));
  parameters.filter_exponent_px = float(-0.5 / std::pow(filter_sigma_mm(settings) / fan.geometry.mm_per_pixel, 2));
  parameter_buffer.write(&parameters, sizeof parameters);
  parameter_buffer.bind_uniform(0);
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
  sharp.resize(format, pixels());
  half_smoothed.resize(format, pixels());
  sharp.clear();
  half_smoothed.clear();
}

void Simulator::State::prepare_fusion(int filter_radius) {
  if (stages_are_read && !fused) (fused = TexelBuffer(GL_R32F, pixels())).clear();
  if (frame_sets_white()) levels.resize(GL_R32F, pixels());
  if ((settings.persistence > 0 || filter_radius > 0) && !shown) (shown = TexelBuffer(GL_R32F, pixels())).clear();
  if (filter_radius > 0 && !window_sums) (window_sums = TexelBuffer(GL_RGBA32F, pixels())).clear();
}

void Simulator::State::prepare_noise() {
  if (noise && noise_length_mm == settings.reflection_length_mm) return;
  noise_length_mm = settings.reflection_length_mm;
  const ScanLines& straight = looks[looks.size() / 2].lines;
  noise = settings.waves ? noise_waves_of_pixels(fan.geometry, straight, settings)
                         : noise_of_pixels(fan, straight, settings);
}

bool Simulator::State::needed(Stage stage) const {
  if (stage == Stage::smooth) return reflection_gaussian.radius > 0 || transmission_gaussian.radius > 0;
  if (stage == Stage::compress) return frame_sets_white();
  if (stage == Stage::enhance) return is_filtered(settings);
  return true;
}

void Simulator::State::run_through(Stage last, bool in_motion) {
  if (!volume) return;
  in_motion = in_motion && continues && !layout_changed;
  const bool moved = first_outdated == Stage::traverse, rests = in_motion && !moved;
  if (!first_outdated && !any_old() && !holds_before) return;
  if (layout_changed) lay_out();
  if (is_compounded() && any_old())
    first_outdated = Stage::traverse;
  else if (holds_before)
    invalidate_from(Stage::fuse);
  // Whether a frame before is mixed in depends on whether looks remain to be computed.
  const std::ptrdiff_t left = std::ranges::count_if(looks, &Look::is_old) - 1;
  of_frame_before = in_motion && !(rests && left <= 0) ? settings.persistence : 0;
  prepare(is_filtered(settings) ? filter_radius_px(settings, fan.geometry.mm_per_pixel) : 0);
  if (is_compounded()) {
    run_looks(last, in_motion);
    if (last < Stage::scan_convert) return;
  } else {
    run_stages(*first_outdated, last);
    looks.front().is_old = looks.front().is_old && last < Stage::scan_convert;
  }
  first_outdated = last == Stage::enhance ? std::nullopt : std::optional(Stage(int(last) + 1));
  if (last < Stage::fuse) return;
  holds_before = of_frame_before > 0;
  continues = last == Stage::enhance;
}

// Computes the looks that are old, the straight one last, whose results then stay for read_stages(); in motion only
// the next one. Then the stages behind them.
void Simulator::State::run_looks(Stage last, bool in_motion) {
  const std::size_t straight = looks.size() / 2;
  std::vector<std::size_t> due;
  if (last < Stage::scan_convert) {
    due = {straight};
  } else if (any_old() && in_motion) {
    while (!looks[next_look].is_old) next_look = (next_look + 1) % looks.size();
    due = {next_look};
    next_look = (next_look + 1) % looks.size();
  } else {
    for (std::size_t i = 0; i < looks.size(); ++i)
      if (looks[i].is_old && i != straight) due.push_back(i);
    if (any_old()) due.push_back(straight);
  }
  for (const std::size_t i : due) {
    line_stages.turn(looks[i].lines);
    write_parameters(i);
    run_stages(Stage::traverse, std::min(last, Stage::scan_convert));
    looks[i].is_old = looks[i].is_old && last < Stage::scan_convert;
  }
  if (last > Stage::scan_convert) run_stages(std::max(*first_outdated, Stage::fuse), last);
}

void Simulator::State::run_stages(Stage first, Stage last) {
  for (Stage stage = first; stage <= last; stage = Stage(int(stage) + 1)) {
    if (!needed(stage)) continue;
    run(stage);
    ++runs[std::size_t(stage)];
  }
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
      looks[std::size_t(parameters.look)].line_and_sample.bind(1);
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
      if (frame_sets_white()) levels.bind_storage(2);
      image_words.bind_storage(3);
      if (shown) shown.bind_storage(4);
      over_fan(programs.fuse);
      if (!frame_sets_white() && !is_filtered(settings)) show();
      break;
    case Stage::compress:
      maximum_buffer.clear();
      brightest.bind_storage(0);
      maximum_buffer.bind_storage(1);
      programs.maximum.dispatch_groups(1);
      maximum_buffer.bind_storage(0);
      levels.bind(0);
      image_words.bind_storage(3);
      if (shown) shown.bind_storage(4);
      over_fan(programs.compress);
      if (!is_filtered(settings)) show();
      break;
    case Stage::enhance:
      shown.bind(0);
      window_sums.bind_storage(0);
      over_fan(programs.enhance_rows);
      window_sums.bind(1);
      image_words.bind_storage(3);
      over_fan(programs.enhance);
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
  state_->continues = false;
  state_->invalidate_from(Stage::traverse);
}

void Simulator::set_stored_speckle(const StoredSpeckle* speckle) {
  state_->line_stages.store_speckle(speckle);
  state_->continues = false;
  state_->invalidate_from(Stage::traverse);
}

void Simulator::set_probe(const Probe& probe, double depth_mm) {
  check_probe("simulator", probe, depth_mm);
  if (probe == state_->probe && depth_mm == state_->depth_mm) return;
  state_->probe = probe;
  state_->depth_mm = depth_mm;
  state_->layout_changed = true;
  state_->continues = false;
  state_->invalidate_from(Stage::traverse);
}

void Simulator::set_settings(const Settings& settings) {
  if (settings == state_->settings) return;
  if (const auto why = why_not_valid(settings)) throw std::invalid_argument("simulator: " + *why);
  const DirtyStages dirty = dirty_stages(state_->settings, settings);
  state_->layout_changed |= dirty.layout;
  state_->continues = false;
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
  state_->run_through(Stage::enhance);
  return state_->image;
}

const Texture& Simulator::image_in_motion() {
  state_->run_through(Stage::enhance, true);
  return state_->image;
}

long Simulator::image_version() const {
  const auto& runs = state_->runs;
  return runs[std::size_t(Stage::fuse)] + runs[std::size_t(Stage::compress)] + runs[std::size_t(Stage::enhance)];
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
    case Stage::enhance:
      count.possible = std::uint64_t(s.image.width()) * std::uint64_t(s.image.height());
      count.evaluated = s.fan.pixels_in_blocks();
      break;
  }
  return count;
}

Stages<float> Simulator::read_stages() {
  if (!std::exchange(state_->stages_are_read, true)) state_->invalidate_from(Stage::fuse);
  // In motion, the stages on the lines may be those of another look.
  if (state_->is_compounded()) state_->invalidate_from(Stage::traverse);
  run_through(Stage::enhance);
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
  if (s.shown) {
    stages.shown = Image<float>(w, h);
    s.shown.read(stages.shown.pixels.data(), stages.shown.pixels.size() * sizeof(float));
    for (float& echo : stages.shown.pixels) echo = std::max(echo - 1, 0.0f);
  }
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
