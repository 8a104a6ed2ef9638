#include "sim/gl/simulator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/gl/device_volume.h"
#include "sim/gl/fan_layout.h"
#include "sim/gl/stage_tables.h"
#include "sim/model/beam.h"
#include "sim/model/noise.h"
#include "sim/model/refraction.h"
#include "sim/model/scatterers.h"
#include "sim/model/settings_file.h"
#include "sim/shaders/shared/simulation_parameters.h"

namespace insonate::gl {
namespace {

// What traverse.comp is compiled for.
Defines traversal_of(const Settings& settings, double dr_mm) {
  const double samples_a_length = settings.reflection_length_mm / dr_mm;
  const auto is = [&](double whole) { return std::abs(samples_a_length - whole) < 1e-9; };
  return {{"EDGES_AT", is(2)   ? "kEdgesAtSamples"
                       : is(1) ? "kEdgesAtMiddles"
                               : "kEdgesAnywhere"},
          {"ABSORPTION", settings.absorption ? "1" : "0"},
          {"SPECKLE", settings.speckle ? "1" : "0"},
          {"EDGE_SHADOW", settings.edge_shadow ? "1" : "0"},
          {"ELEVATION_FOCUS", slice_bends(settings) ? "1" : "0"},
          {"PLANES", std::to_string(settings.slice_planes)}};
}

bool reverberates(const Settings& settings) {
  return settings.reverberation || settings.face_reflection > 0;
}

// What beam.comp is compiled for, and reverberation.comp.
Defines beam_of(const Settings& settings) {
  return {{"FOCUSED_BEAM", settings.focused_beam ? "1" : "0"},
          {"BEAM_HALF", settings.focused_beam ? "0" : std::to_string(settings.beam_lines / 2)},
          {"REVERBERATION", reverberates(settings) ? "1" : "0"}};
}
Defines reverberation_of(const Settings& settings) {
  return {{"IN_TISSUE", settings.reverberation ? "1" : "0"}, {"AT_FACE", settings.face_reflection > 0 ? "1" : "0"}};
}

constexpr double kLn10 = 2.302585092994046;

// An interface counts as too weak for its tilt to be seen where it echoes this share of what the scatterers do: 0.004
// dB. A tenth of that would show where a beam's width carries it from beside a shadow into it, and nowhere else.
constexpr double kUnseenShare = 0.001;

// The channels of a texture, each as an image.
std::vector<Image<float>> read_channels(const Texture& texture, int channels) {
  const std::size_t count = std::size_t(channels);
  Image<float> image(texture.width(), texture.height());
  std::vector<float> values(count * image.pixels.size());
  texture.read(channels == 4 ? GL_RGBA : GL_RED, GL_FLOAT, values.data(), values.size() * sizeof(float));
  std::vector<Image<float>> images(count, image);
  for (std::size_t i = 0; i < values.size(); ++i) images[i % count].pixels[i / count] = values[i];
  return images;
}

// Textures have a row a line, Stages a column.
Image<float> transposed(const Image<float>& rows) {
  Image<float> columns(rows.height, rows.width);
  for (int y = 0; y < rows.height; ++y)
    for (int x = 0; x < rows.width; ++x) columns.at(y, x) = rows.at(x, y);
  return columns;
}

}  // namespace

struct Simulator::State {
  explicit State(const ShaderSources& shader_sources)
      : sources(shader_sources),
        traverse(sources, {"traverse.comp"}, traversal_of({}, 1)),
        reverberation(sources, {"reverberation.comp"}, reverberation_of({})),
        beam(sources, {"beam.comp"}, beam_of({})),
        clutter(sources, {"clutter.comp"}),
        clutter_tail(sources, {"clutter_tail.comp"}),
        scan_convert(sources, {"scan_convert.comp"}, conversion()),
        smooth(sources, {"smooth.comp"}, smoothing()),
        fuse(sources, {"fuse.comp"}, fusion()),
        maximum(sources, {"maximum.comp"}),
        compress(sources, {"compress.comp"}, display()) {}

  ShaderSources sources;
  Settings settings;
  Gaussian reflection_gaussian, transmission_gaussian;
  bool stages_are_read = false;  // by read_stages(), which asks for U where grey is all that a picture needs
  Program traverse, reverberation, beam, clutter, clutter_tail, scan_convert, smooth, fuse, maximum, compress;

  // What the user set.
  Probe probe;
  double depth_mm = 160;
  Pose patient_from_probe;
  ScanLines lines;
  FanLayout fan;

  // What the stages read.
  DeviceVolume volume;
  SimulationParameters parameters{};
  Buffer parameter_buffer{sizeof(SimulationParameters), nullptr};
  Texture scatterers, line_and_sample;
  Texture beam_at_depth, noise, fan_weights;
  Buffer line_buffer, beam_window, fan_blocks;
  double noise_length_mm = 0;  // the noise's grain

  // What they write.
  Texture scan, repeats, echoes, mean_echo, picture, sharp, half_smoothed, fused, levels;
  Buffer brightest;  // a block of the fan
  Buffer maximum_buffer{sizeof(GLuint), nullptr};
  Buffer counters{sizeof(SampleCounts), nullptr};
  Texture image;

  bool layout_changed = true;      // probe, depth, sample count or picture size
  bool beam_changed = true;        // layout, or what the beam's windows hang on
  bool scatterers_changed = true;  // seed
  std::optional<Stage> first_due = Stage::traverse;
  std::array<long, kStageCount> runs{};

  bool noisy() const { return settings.electronic_noise || settings.clutter; }
  bool frame_sets_white() const { return settings.reference_level == ReferenceLevel::frame_maximum; }

  // What the picture's stages are compiled for.
  Defines conversion() const {
    return {{"REFLECTION_SMOOTHED", reflection_gaussian.radius > 0 ? "1" : "0"},
            {"TRANSMISSION_SMOOTHED", transmission_gaussian.radius > 0 ? "1" : "0"},
            {"SMOOTHED_FORMAT", transmission_gaussian.radius > 0 ? "rg32f" : "r32f"},
            {"NOISE", noisy() ? "1" : "0"},
            {"CLUTTER", settings.clutter ? "1" : "0"}};
  }
  Defines smoothing() const {
    return {{"REFLECTION_RADIUS", std::to_string(reflection_gaussian.radius)},
            {"TRANSMISSION_RADIUS", std::to_string(transmission_gaussian.radius)},
            {"SMOOTHED_FORMAT", transmission_gaussian.radius > 0 ? "rg32f" : "r32f"}};
  }
  Defines display() const { return {{"GREY_MAP", std::to_string(int(settings.grey_map))}}; }
  Defines fusion() const {
    Defines defines = smoothing();
    defines.push_back(display().front());
    const auto none = [](double db) { return db == 0; };
    defines.emplace_back("TIME_GAIN", std::ranges::all_of(settings.tgc_db, none) ? "0" : "1");
    defines.emplace_back("FRAME_MAXIMUM", frame_sets_white() ? "1" : "0");
    defines.emplace_back("KEEP_FUSED", stages_are_read ? "1" : "0");
    return defines;
  }

  void due_from(Stage stage) { first_due = std::min(first_due.value_or(stage), stage); }

  void lay_out();
  void upload_scatterers();
  void fill_parameters();
  void prepare();
  void run_through(Stage last);
  void run(Stage stage);
  bool needed(Stage stage) const;
  void prepare_smoothing();
  void prepare_fusion();
  void prepare_noise();
};

// Allocates what depends on the number of lines, samples and pixels, and works out where each pixel lies.
void Simulator::State::lay_out() {
  lines = scan_lines(probe, depth_mm, settings.samples);
  const int n = int(lines.lines.size()), d = lines.samples;
  line_buffer = Buffer(std::size_t(settings.slice_planes) * lines.lines.size() * sizeof(PlacedLine), nullptr);
  scan = Texture::make_2d(GL_RGBA32F, d, n, Filter::nearest);
  echoes = Texture::make_2d(GL_RGBA32F, d, n, Filter::nearest);
  mean_echo = Texture::make_2d(GL_R32F, d, 1, Filter::nearest);

  const int w = settings.image_width, h = settings.image_height;
  fan = FanLayout(probe, depth_mm, lines, w, h);
  noise = Texture();
  line_and_sample = Texture::make_2d(GL_RG32F, w, h, Filter::nearest);
  line_and_sample.write(GL_RG, GL_FLOAT, fan.line_and_sample.data());
  fan_blocks = Buffer(fan.blocks.size() * sizeof(glm::ivec2), fan.blocks.data());
  brightest = Buffer(fan.blocks.size() * sizeof(GLuint), nullptr);
  picture = Texture::make_2d(GL_RG32F, w, h, Filter::nearest);
  fan_weights = Texture();
  fused = Texture();
  levels = Texture();
  image = Texture::make_2d(GL_RGBA8, w, h, Filter::linear);
  image.clear();
  layout_changed = false;
  beam_changed = true;
}

void Simulator::State::upload_scatterers() {
  constexpr int side = ScattererLattice::kSide;
  scatterers = Texture::make_3d(GL_RG16_SNORM, side, side, side, Filter::linear, Wrap::repeat);
  scatterers.write(GL_RG, GL_SHORT, make_scatterers(settings.speckle_seed).stored.data());
  scatterers_changed = false;
}

void Simulator::State::fill_parameters() {
  const double dr = lines.dr_mm(), samples_a_length = settings.reflection_length_mm / dr;
  SimulationParameters& p = parameters;
  p.lines = int(lines.lines.size());
  p.samples = lines.samples;
  p.width = settings.image_width;
  p.height = settings.image_height;
  p.r_min_mm = float(lines.r_min_mm);
  p.dr_mm = float(dr);
  p.half_reflection_length = float(samples_a_length / 2);
  p.reflection_exponent = float(1 / samples_a_length);
  p.absorption_per_sample = float(settings.frequency_mhz * dr / 100 * kLn10);
  p.gel_mm = float(settings.gel_mm);
  p.least_alpha_with_normal = float(settings.skipping ? kUnseenShare * settings.blend : 0);
  p.reflection_exponent_px = float(reflection_gaussian.exponent);
  p.transmission_exponent_px = float(transmission_gaussian.exponent);
  p.face_reflection = float(settings.face_reflection);
  p.turn_kept = float(std::exp(-dr / kTurn_mm));
  p.turn_per_step = float(dr / (settings.reflection_length_mm * kTurn_rad));
  p.turn_loss = float(dr / kTurn_mm);
  p.slice_thickness_mm = float(settings.slice_thickness_mm);
  p.elevation_focus_mm = float(settings.elevation_focus_mm);
  p.clutter_kept = float(std::exp(-dr / kClutterTail_mm));
  p.slice_spread = float(slice_spread(settings));
  p.two_way = settings.two_way;
  p.blend = float(settings.blend);
  p.clutter_share = float(clutter_share(settings));
  p.noise_level = float(noise_level(settings));
  p.gain_db = float(settings.gain_db);
  p.dynamic_range_db = float(settings.dynamic_range_db);
  p.fixed_level = float(settings.fixed_level);
  for (int i = 0; i < 8; ++i) p.tgc_db[i / 4][i % 4] = float(settings.tgc_db[std::size_t(i)]);
  parameter_buffer.write(&parameters, sizeof parameters);
}

// Everything that the stages due read and that is not another stage's.
void Simulator::State::prepare() {
  if (layout_changed) lay_out();
  if (scatterers_changed) upload_scatterers();
  if (*first_due == Stage::traverse) {
    traverse.define(sources, traversal_of(settings, lines.dr_mm()));
    const std::vector<PlacedLine> placed = placed_lines(volume, patient_from_probe, lines, settings);
    line_buffer.write(placed.data(), placed.size() * sizeof(PlacedLine));
  }
  if (beam_changed) {
    beam.define(sources, beam_of(settings));
    if (reverberates(settings)) {
      reverberation.define(sources, reverberation_of(settings));
      repeats = Texture::make_2d(GL_R32F, lines.samples, int(lines.lines.size()), Filter::nearest);
    }
    beam_window = half_beam_window(settings);
    beam_at_depth = beam_by_depth(lines, settings);
    beam_changed = false;
  }
  if (*first_due <= Stage::scan_convert) {
    prepare_smoothing();
    if (noisy()) prepare_noise();
    scan_convert.define(sources, conversion());
    smooth.define(sources, smoothing());
  }
  fuse.define(sources, fusion());
  prepare_fusion();
  compress.define(sources, display());
  fill_parameters();
}

void Simulator::State::prepare_smoothing() {
  const int w = settings.image_width, h = settings.image_height, limit = std::max(w, h) - 1;
  const Gaussian reflection(settings.reflection_sigma_mm / fan.geometry.mm_per_pixel, limit);
  const Gaussian transmission(settings.transmission_sigma_mm / fan.geometry.mm_per_pixel, limit);
  if (fan_weights && reflection == reflection_gaussian && transmission == transmission_gaussian) return;
  reflection_gaussian = reflection;
  transmission_gaussian = transmission;
  fan_weights = weights_of_pixels(fan, reflection, transmission);
  const GLenum format = transmission.radius > 0 ? GL_RG32F : GL_R32F;
  sharp = Texture::make_2d(format, w, h, Filter::nearest);
  half_smoothed = Texture::make_2d(format, w, h, Filter::nearest);
  sharp.clear();
  half_smoothed.clear();
}

void Simulator::State::prepare_fusion() {
  const int w = settings.image_width, h = settings.image_height;
  if (stages_are_read && !fused) (fused = Texture::make_2d(GL_R32F, w, h, Filter::nearest)).clear();
  if (frame_sets_white() && !levels) levels = Texture::make_2d(GL_R32F, w, h, Filter::nearest);
}

void Simulator::State::prepare_noise() {
  if (noise && noise_length_mm == settings.reflection_length_mm) return;
  noise_length_mm = settings.reflection_length_mm;
  noise = noise_of_pixels(fan, lines, settings);
}

bool Simulator::State::needed(Stage stage) const {
  if (stage == Stage::smooth) return reflection_gaussian.radius > 0 || transmission_gaussian.radius > 0;
  if (stage == Stage::compress) return frame_sets_white();
  return true;
}

void Simulator::State::run_through(Stage last) {
  if (!first_due || *first_due > last || !volume) return;
  prepare();
  parameter_buffer.bind_uniform(0);
  for (Stage stage = *first_due; stage <= last; stage = Stage(int(stage) + 1)) {
    if (!needed(stage)) continue;
    run(stage);
    ++runs[std::size_t(stage)];
  }
  first_due = last == Stage::compress ? std::nullopt : std::optional(Stage(int(last) + 1));
}

void Simulator::State::run(Stage stage) {
  const auto over_fan = [&](const Program& program) { program.dispatch_groups(int(fan.blocks.size())); };
  fan_blocks.bind_storage(7);
  switch (stage) {
    case Stage::traverse:
      counters.clear();
      line_buffer.bind_storage(0);
      volume.tissue_lookup().bind(7);
      counters.bind_storage(2);
      volume.texture().bind(0);
      scatterers.bind(1);
      scan.bind_image(0, GL_READ_WRITE);
      traverse.dispatch(parameters.lines, 1);
      break;
    case Stage::beam:
      if (reverberates(settings)) {
        repeats.clear();
        scan.bind(0);
        repeats.bind_image(0, GL_READ_WRITE);
        reverberation.dispatch(parameters.lines, 1);
        repeats.bind(2);
      }
      beam_window.bind_uniform(1);
      scan.bind(0);
      beam_at_depth.bind(1);
      echoes.bind_image(0, GL_WRITE_ONLY);
      beam.dispatch(parameters.samples, (parameters.lines + 3) / 4);
      if (settings.clutter) {
        echoes.bind(0);
        mean_echo.bind_image(0, GL_READ_WRITE);
        clutter.dispatch(parameters.samples, 1);
        clutter_tail.dispatch(1, 1);
      }
      break;
    case Stage::scan_convert:
      echoes.bind(0);
      line_and_sample.bind(1);
      noise.bind(2);
      mean_echo.bind(3);
      picture.bind_image(0, GL_WRITE_ONLY);
      sharp.bind_image(1, GL_WRITE_ONLY);
      over_fan(scan_convert);
      break;
    case Stage::smooth:
      sharp.bind(0);
      half_smoothed.bind_image(0, GL_WRITE_ONLY);
      over_fan(smooth);
      break;
    case Stage::fuse:
      picture.bind(0);
      half_smoothed.bind(1);
      fan_weights.bind(2);
      brightest.clear();
      brightest.bind_storage(0);
      if (fused) fused.bind_image(0, GL_WRITE_ONLY);
      if (frame_sets_white())
        levels.bind_image(1, GL_WRITE_ONLY);
      else
        image.bind_image_as(1, GL_WRITE_ONLY, GL_R32UI);
      over_fan(fuse);
      break;
    case Stage::compress:
      maximum_buffer.clear();
      brightest.bind_storage(0);
      maximum_buffer.bind_storage(1);
      maximum.dispatch_groups(1);
      maximum_buffer.bind_storage(0);
      levels.bind(0);
      image.bind_image_as(0, GL_WRITE_ONLY, GL_R32UI);
      over_fan(compress);
      break;
  }
}

Simulator::Simulator(const ShaderSources& sources) : state_(std::make_unique<State>(sources)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

void Simulator::set_volume(const AcousticVolume& volume, const TissueTable& table) {
  state_->volume = DeviceVolume(volume, table);
  state_->due_from(Stage::traverse);
}

void Simulator::set_probe(const Probe& probe, double depth_mm) {
  state_->probe = probe;
  state_->depth_mm = depth_mm;
  state_->layout_changed = true;
  state_->due_from(Stage::traverse);
}

void Simulator::set_settings(const Settings& settings) {
  if (settings == state_->settings) return;
  if (const auto why = why_not_valid(settings)) throw std::invalid_argument("simulator: " + *why);
  const Settings& old = state_->settings;
  const auto same = [&](auto... members) { return ((old.*members == settings.*members) && ...); };
  if (!same(&Settings::samples, &Settings::slice_planes, &Settings::image_width, &Settings::image_height))
    state_->layout_changed = true;
  if (!same(&Settings::speckle_seed)) state_->scatterers_changed = true;
  if (!same(&Settings::beam_window, &Settings::beam_lines, &Settings::focused_beam, &Settings::focus_mm,
            &Settings::f_number, &Settings::frequency_mhz, &Settings::speckle, &Settings::reverberation,
            &Settings::face_reflection, &Settings::speckle_cell_mm, &Settings::slice_thickness_mm,
            &Settings::elevation_focus_mm))
    state_->beam_changed = true;

  using S = Settings;
  if (!same(&S::samples, &S::reflection_length_mm, &S::frequency_mhz, &S::absorption, &S::gel_mm, &S::speckle,
            &S::speckle_seed, &S::speckle_cell_mm, &S::slice_planes, &S::slice_thickness_mm, &S::elevation_focus_mm,
            &S::edge_shadow, &S::image_width, &S::image_height, &S::skipping) ||
      (settings.skipping && settings.blend < old.blend))  // interfaces may be seen that were not beside more echo
    state_->due_from(Stage::traverse);
  else if (!same(&S::beam_window, &S::beam_lines, &S::focused_beam, &S::focus_mm, &S::f_number, &S::reverberation,
                 &S::face_reflection, &S::clutter, &S::two_way))
    state_->due_from(Stage::beam);
  else if (!same(&S::reflection_sigma_mm, &S::transmission_sigma_mm, &S::blend, &S::clutter_db, &S::electronic_noise,
                 &S::noise_db) ||
           (settings.electronic_noise && !same(&S::fixed_level)))
    state_->due_from(Stage::scan_convert);
  else if (!same(&S::gain_db, &S::tgc_db, &S::reference_level, &S::fixed_level))
    state_->due_from(Stage::fuse);
  else if (!same(&S::dynamic_range_db, &S::grey_map))
    state_->due_from(settings.reference_level == ReferenceLevel::fixed ? Stage::fuse : Stage::compress);
  state_->settings = settings;
}

void Simulator::set_pose(const Pose& patient_from_probe) {
  if (patient_from_probe == state_->patient_from_probe) return;
  state_->patient_from_probe = patient_from_probe;
  state_->due_from(Stage::traverse);
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
const std::array<long, kStageCount>& Simulator::runs() const {
  return state_->runs;
}

SampleCounts Simulator::sample_counts() const {
  SampleCounts counts;
  state_->counters.read(&counts, sizeof counts);
  return counts;
}

Stages<float> Simulator::read_stages() {
  if (!std::exchange(state_->stages_are_read, true)) state_->due_from(Stage::fuse);
  run_through(Stage::compress);
  const State& s = *state_;
  Stages<float> stages;
  const std::vector<Image<float>> scan = read_channels(s.scan, 4), echoes = read_channels(s.echoes, 4);
  stages.intensity = transposed(scan[0]);
  stages.reflection = transposed(scan[1]);
  stages.reflection_beam = transposed(echoes[0]);
  stages.transmission = transposed(echoes[1]);
  stages.speckle = transposed(echoes[2]);
  stages.repeated = transposed(echoes[3]);
  stages.fused = read_channels(s.fused, 1)[0];
  const int w = s.image.width(), h = s.image.height();
  Image<Rgba8> rgba(w, h);
  s.image.read(GL_RGBA, GL_UNSIGNED_BYTE, rgba.pixels.data(), rgba.pixels.size() * sizeof(Rgba8));
  stages.inside = Image<std::uint8_t>(w, h);
  stages.grey = Image<std::uint8_t>(w, h);
  for (std::size_t i = 0; i < rgba.pixels.size(); ++i) {
    stages.grey.pixels[i] = rgba.pixels[i][0];
    stages.inside.pixels[i] = rgba.pixels[i][3] ? 1 : 0;
    stages.fused.pixels[i] = std::max(stages.fused.pixels[i], 0.0f);
  }
  return stages;
}

std::optional<std::string> Simulator::reload(const ShaderSources& sources) {
  State& s = *state_;
  std::string problems;
  for (Program* program : {&s.traverse, &s.reverberation, &s.beam, &s.scan_convert, &s.smooth, &s.clutter,
                           &s.clutter_tail, &s.fuse, &s.maximum, &s.compress})
    if (const auto problem = program->reload(sources)) problems += *problem;
  if (problems.empty()) s.sources = sources;  // others would fail when a program is built for other settings
  s.due_from(Stage::traverse);
  return problems.empty() ? std::nullopt : std::optional(problems);
}

}  // namespace insonate::gl
