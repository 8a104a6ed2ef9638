#include "sim/gl/simulator.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/gl/device_volume.h"
#include "sim/gl/fan_layout.h"
#include "sim/model/beam.h"
#include "sim/model/noise.h"
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
          {"SPECKLE", settings.speckle ? "1" : "0"},
          {"PLANES", std::to_string(settings.slice_planes)}};
}

bool reverberates(const Settings& settings) {
  return settings.reverberation || settings.face_reflection > 0;
}

// What beam.comp is compiled for, and reverberation.comp.
Defines beam_of(const Settings& settings) {
  return {{"FOCUSED_BEAM", settings.focused_beam ? "1" : "0"}, {"REVERBERATION", reverberates(settings) ? "1" : "0"}};
}
Defines reverberation_of(const Settings& settings) {
  return {{"IN_TISSUE", settings.reverberation ? "1" : "0"}};
}

// What fuse.comp is compiled for.
Defines fusion_of(const Settings& settings) {
  return {{"CLUTTER", settings.clutter ? "1" : "0"}};
}

constexpr double kLn10 = 2.302585092994046;

// An interface counts as too weak for its tilt to be seen where it echoes this share of what the scatterers do: 0.004
// dB. A tenth of that would show where a beam's width carries it from beside a shadow into it, and nowhere else.
constexpr double kUnseenShare = 0.001;

// As `Line` in traverse.comp.
struct GpuLine {
  glm::vec4 start, along;
  glm::vec4 lateral, elevation;
  glm::vec4 lattice_start, lattice_along;
};

Buffer storage(const std::vector<float>& values) {
  return Buffer(values.size() * sizeof(float), values.data());
}

std::vector<float> to_float(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

// A window as four neighbours see it: at place j from the first one's edge, the weights of all four.
Buffer window_of_four(const std::vector<double>& window) {
  std::vector<glm::vec4> of_four;
  const auto weight = [&](std::ptrdiff_t i) {
    return i >= 0 && i < std::ptrdiff_t(window.size()) ? float(window[std::size_t(i)]) : 0.0f;
  };
  for (std::ptrdiff_t j = 0; j < std::ptrdiff_t(window.size()) + 3; ++j)
    of_four.emplace_back(weight(j), weight(j - 1), weight(j - 2), weight(j - 3));
  return Buffer(of_four.size() * sizeof(glm::vec4), of_four.data());
}

// A Gaussian out to three sigma or the picture's size.
struct Gaussian {
  int radius = 0;  // pixels; 0 for none
  std::vector<double> weights;
  Buffer window;

  Gaussian() = default;
  Gaussian(double sigma_px, int limit_px) {
    if (sigma_px >= 0.05) radius = std::min(int(std::ceil(3 * sigma_px)), limit_px);
    for (int i = -radius; i <= radius; ++i) weights.push_back(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    window = window_of_four(weights);
  }
};

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

// What x line, y sample holds at a continuous place inside the fan, as scan_convert.comp reads it.
double bilinear(const Image<double>& image, const glm::vec2& line_and_sample) {
  const glm::dvec2 last(image.width - 1, image.height - 1);
  const glm::dvec2 position = glm::clamp(glm::dvec2(line_and_sample), glm::dvec2(0), last);
  const glm::ivec2 low(position), high = glm::min(low + 1, glm::ivec2(last));
  const glm::dvec2 f = position - glm::dvec2(low);
  return glm::mix(glm::mix(image.at(low.x, low.y), image.at(high.x, low.y), f.x),
                  glm::mix(image.at(low.x, high.y), image.at(high.x, high.y), f.x), f.y);
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
        traverse(sources, {"traverse.comp"}, traversal),
        reverberation(sources, {"reverberation.comp"}, reverberation_of({})),
        beam(sources, {"beam.comp"}, beam_defines),
        scan_convert(sources, {"scan_convert.comp"}),
        smooth(sources, {"smooth.comp"}),
        clutter(sources, {"clutter.comp"}),
        fuse(sources, {"fuse.comp"}, fusion),
        maximum(sources, {"maximum.comp"}),
        compress(sources, {"compress.comp"}) {}

  ShaderSources sources;
  Defines traversal = traversal_of({}, 1);  // what `traverse` is compiled for
  Defines beam_defines = beam_of({});       // and `beam`
  Defines reverberation_defines = reverberation_of({});
  Defines fusion = fusion_of({});  // and `fuse`
  Program traverse, reverberation, beam, scan_convert, smooth, clutter, fuse, maximum, compress;

  // What the user set.
  Probe probe;
  double depth_mm = 160;
  Settings settings;
  Pose patient_from_probe;
  ScanLines lines;
  FanLayout fan;

  // What the stages read.
  DeviceVolume volume;
  SimulationParameters parameters{};
  Buffer parameter_buffer{sizeof(SimulationParameters), nullptr};
  Texture scatterers, line_and_sample;
  Texture pixel_constants;  // see fuse.comp
  Buffer line_buffer, beam_window, speckle_scale, focused, fan_blocks;
  Gaussian reflection_gaussian, transmission_gaussian;
  std::array<double, 2> sigmas_px{};  // theirs
  double noise_length_mm = 0;         // reflection length of the noise among the constants; 0 where there is none

  // What they write.
  Texture scan, repeats, echoes, mean_echo, picture, half_smoothed, fused;
  Buffer maximum_buffer{sizeof(GLuint), nullptr};
  Buffer counters{sizeof(SampleCounts), nullptr};
  Texture image;

  bool layout_changed = true;      // probe, depth, sample count or picture size
  bool beam_changed = true;        // layout, or what the beam's windows hang on
  bool scatterers_changed = true;  // seed
  std::optional<Stage> first_due = Stage::traverse;
  std::array<long, kStageCount> runs{};

  void due_from(Stage stage) { first_due = std::min(first_due.value_or(stage), stage); }

  void lay_out();
  void upload_scatterers();
  void place_lines();
  void fill_parameters();
  void prepare();
  void run_through(Stage last);
  void run(Stage stage);
  bool needed(Stage stage) const;
  void place_pixel_constants();
};

// Allocates what depends on the number of lines, samples and pixels, and works out where each pixel lies.
void Simulator::State::lay_out() {
  lines = scan_lines(probe, depth_mm, settings.samples);
  const int n = int(lines.lines.size()), d = lines.samples;
  line_buffer = Buffer(std::size_t(settings.slice_planes) * lines.lines.size() * sizeof(GpuLine), nullptr);
  scan = Texture::make_2d(GL_RGBA32F, d, n, Filter::nearest);
  echoes = Texture::make_2d(GL_RGBA32F, d, n, Filter::nearest);
  mean_echo = Texture::make_2d(GL_R32F, d, 1, Filter::nearest);

  const int w = settings.image_width, h = settings.image_height;
  fan = FanLayout(probe, depth_mm, lines, w, h);
  pixel_constants = Texture();
  line_and_sample = Texture::make_2d(GL_RG32F, w, h, Filter::nearest);
  line_and_sample.write(GL_RG, GL_FLOAT, fan.line_and_sample.data());
  fan_blocks = Buffer(fan.blocks.size() * sizeof(glm::ivec2), fan.blocks.data());
  picture = Texture::make_2d(GL_RGBA32F, w, h, Filter::nearest);
  half_smoothed = Texture::make_2d(GL_RG32F, w, h, Filter::nearest);
  fused = Texture::make_2d(GL_R32F, w, h, Filter::nearest);
  image = Texture::make_2d(GL_RGBA8, w, h, Filter::linear);
  for (Texture* texture : {&picture, &half_smoothed, &fused, &image}) texture->clear();
  layout_changed = false;
  beam_changed = true;
}

void Simulator::State::upload_scatterers() {
  constexpr int side = ScattererLattice::kSide;
  scatterers = Texture::make_3d(GL_RG16_SNORM, side, side, side, Filter::linear, Wrap::repeat);
  scatterers.write(GL_RG, GL_SHORT, make_scatterers(settings.speckle_seed).stored.data());
  scatterers_changed = false;
}

// The lines where the probe now is, in the textures' coordinates.
void Simulator::State::place_lines() {
  const glm::dmat4 texture_from_probe = volume.texture_from_patient() * patient_from_probe.matrix();
  glm::dmat4 lattice_from_probe = lattice_from_patient(settings.speckle_cell_mm) * patient_from_probe.matrix();
  // Whole periods of the translation change nothing but cost the shader's single precision digits.
  for (int axis = 0; axis < 3; ++axis) lattice_from_probe[3][axis] -= std::floor(lattice_from_probe[3][axis]);

  const auto point = [](const glm::dmat4& map, const glm::dvec3& p) { return glm::dvec3(map * glm::dvec4(p, 1)); };
  const auto step = [](const glm::dmat4& map, const glm::dvec3& d) { return glm::dvec3(map * glm::dvec4(d, 0)); };
  const double dr = lines.dr_mm(), half_length = settings.reflection_length_mm / 2;
  std::vector<GpuLine> placed;
  placed.reserve(std::size_t(settings.slice_planes) * lines.lines.size());
  for (const SlicePlane& plane : slice_planes(settings))
    for (const ScanLine& line : lines.lines) {
      const glm::dvec3 d = line.direction, lateral(d.y, -d.x, 0), elevation = glm::cross(d, lateral);
      const glm::dvec3 first = line.start + glm::dvec3(0, 0, plane.offset_mm) + (lines.r_min_mm + dr / 2) * d;
      const glm::dvec3 start = point(texture_from_probe, first), along = step(texture_from_probe, dr * d);
      // A sample's width to spare, for the rounding of the shader's own positions.
      const auto [enters, leaves] = settings.skipping ? volume.meets_body(start, along) : std::pair(-1e9, 1e9);
      placed.push_back({{start, enters - 1},
                        {along, leaves + 1},
                        {step(texture_from_probe, half_length * lateral), plane.weight},
                        {step(texture_from_probe, half_length * elevation), 0},
                        {point(lattice_from_probe, first), 0},
                        {step(lattice_from_probe, dr * d), 0}});
    }
  line_buffer.write(placed.data(), placed.size() * sizeof(GpuLine));
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
  p.absorption_per_sample = float(settings.absorption ? settings.frequency_mhz * dr / 100 * kLn10 : 0);
  p.gel_mm = float(settings.gel_mm);
  p.least_alpha_with_normal = float(settings.skipping ? kUnseenShare * settings.blend : 0);
  p.reflection_radius_px = reflection_gaussian.radius;
  p.transmission_radius_px = transmission_gaussian.radius;
  p.speckle = settings.speckle;
  p.beam_half = (settings.beam_lines - 1) / 2;
  p.face_reflection = float(settings.face_reflection);
  p.two_way = settings.two_way;
  p.blend = float(settings.blend);
  p.clutter_share = float(clutter_share(settings));
  p.noise_level = float(noise_level(settings));
  p.grey_map = int(settings.grey_map);
  p.gain_db = float(settings.gain_db);
  p.dynamic_range_db = float(settings.dynamic_range_db);
  p.fixed_level = float(settings.fixed_level);
  p.frame_maximum = settings.reference_level == ReferenceLevel::frame_maximum;
  for (int i = 0; i < 8; ++i) p.tgc_db[i / 4][i % 4] = float(settings.tgc_db[std::size_t(i)]);
  parameter_buffer.write(&parameters, sizeof parameters);
}

// Everything that the stages due read and that is not another stage's.
void Simulator::State::prepare() {
  if (layout_changed) lay_out();
  if (scatterers_changed) upload_scatterers();
  if (*first_due == Stage::traverse) {
    const Defines wanted = traversal_of(settings, lines.dr_mm());
    if (wanted != traversal) traverse = Program(sources, {"traverse.comp"}, wanted);
    traversal = wanted;
    place_lines();
  }
  if (beam_changed) {
    const Defines wanted = beam_of(settings);
    if (wanted != beam_defines) beam = Program(sources, {"beam.comp"}, wanted);
    beam_defines = wanted;
    if (reverberates(settings)) {
      if (const auto of = reverberation_of(settings); of != reverberation_defines) {
        reverberation = Program(sources, {"reverberation.comp"}, of);
        reverberation_defines = of;
      }
      repeats = Texture::make_2d(GL_R32F, lines.samples, int(lines.lines.size()), Filter::nearest);
    }
    beam_window = window_of_four(beam_weights(settings));
    speckle_scale = storage(to_float(envelope_scale(lines, settings)));
    std::vector<glm::vec2> of_samples;
    for (double sigma : focused_beam_sigma(lines, settings))
      of_samples.emplace_back(focused_reach(sigma), focused_reach(sigma) > 0 ? -0.5 / (sigma * sigma) : 0);
    focused = Buffer(of_samples.size() * sizeof(glm::vec2), of_samples.data());
    beam_changed = false;
  }
  if (*first_due <= Stage::fuse) {
    const Defines wanted = fusion_of(settings);
    if (wanted != fusion) fuse = Program(sources, {"fuse.comp"}, wanted);
    fusion = wanted;
    place_pixel_constants();
  }
  fill_parameters();
}

void Simulator::State::place_pixel_constants() {
  const int w = settings.image_width, h = settings.image_height, limit = std::max(w, h) - 1;
  const double sigmas[] = {settings.reflection_sigma_mm / fan.geometry.mm_per_pixel,
                           settings.transmission_sigma_mm / fan.geometry.mm_per_pixel};
  const bool noisy = settings.electronic_noise || settings.clutter;
  const double length_mm = noisy ? settings.reflection_length_mm : 0;
  if (pixel_constants && sigmas[0] == sigmas_px[0] && sigmas[1] == sigmas_px[1] && noise_length_mm == length_mm) return;
  noise_length_mm = length_mm;
  std::copy(std::begin(sigmas), std::end(sigmas), sigmas_px.begin());
  reflection_gaussian = Gaussian(sigmas[0], limit);
  transmission_gaussian = Gaussian(sigmas[1], limit);
  const Image<float> reflection = one_over_window_inside(fan.inside, reflection_gaussian.weights);
  const Image<float> transmission = one_over_window_inside(fan.inside, transmission_gaussian.weights);
  const Image<double> noise = noisy ? electronic_noise(lines, settings) : Image<double>(1, 1);
  std::vector<glm::vec4> constants;
  for (std::size_t i = 0; i < reflection.pixels.size(); ++i)
    constants.emplace_back(reflection.pixels[i], transmission.pixels[i],
                           fan.inside.pixels[i] ? bilinear(noise, fan.line_and_sample[i]) : 0,
                           fan.line_and_sample[i].y);
  pixel_constants = Texture::make_2d(GL_RGBA32F, w, h, Filter::nearest);
  pixel_constants.write(GL_RGBA, GL_FLOAT, constants.data());
}

bool Simulator::State::needed(Stage stage) const {
  if (stage == Stage::smooth) return reflection_gaussian.radius > 0 || transmission_gaussian.radius > 0;
  if (stage == Stage::maximum) return parameters.frame_maximum;
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
      volume.tissue_lookup().bind_storage(1);
      counters.bind_storage(2);
      volume.texture().bind(0);
      scatterers.bind(1);
      scan.bind_image(0, GL_READ_WRITE);
      traverse.dispatch(parameters.lines, 1);
      break;
    case Stage::beam:
      if (reverberates(settings)) {
        scan.bind(0);
        repeats.bind_image(0, GL_READ_WRITE);
        reverberation.dispatch(parameters.lines, 1);
        repeats.bind(1);
      }
      beam_window.bind_storage(0);
      speckle_scale.bind_storage(1);
      focused.bind_storage(2);
      scan.bind(0);
      echoes.bind_image(0, GL_WRITE_ONLY);
      beam.dispatch(parameters.samples, (parameters.lines + 3) / 4);
      if (settings.clutter) {
        echoes.bind(0);
        mean_echo.bind_image(0, GL_WRITE_ONLY);
        clutter.dispatch(parameters.samples, 1);
      }
      break;
    case Stage::scan_convert:
      echoes.bind(0);
      line_and_sample.bind(1);
      picture.bind_image(0, GL_WRITE_ONLY);
      over_fan(scan_convert);
      break;
    case Stage::smooth:
      reflection_gaussian.window.bind_storage(0);
      transmission_gaussian.window.bind_storage(1);
      picture.bind(0);
      half_smoothed.bind_image(0, GL_WRITE_ONLY);
      over_fan(smooth);
      break;
    case Stage::fuse:
      reflection_gaussian.window.bind_storage(0);
      transmission_gaussian.window.bind_storage(1);
      picture.bind(0);
      half_smoothed.bind(1);
      pixel_constants.bind(2);
      mean_echo.bind(3);
      fused.bind_image(0, GL_WRITE_ONLY);
      over_fan(fuse);
      break;
    case Stage::maximum:
      maximum_buffer.clear();
      maximum_buffer.bind_storage(0);
      fused.bind(0);
      line_and_sample.bind(1);
      maximum.dispatch(settings.image_width, 1);
      break;
    case Stage::compress:
      maximum_buffer.bind_storage(0);
      fused.bind(0);
      line_and_sample.bind(1);
      image.bind_image(0, GL_WRITE_ONLY);
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
  if (const auto why = why_not_valid(settings)) throw std::invalid_argument("simulator: " + *why);
  const Settings& old = state_->settings;
  const auto same = [&](auto... members) { return ((old.*members == settings.*members) && ...); };
  if (!same(&Settings::samples, &Settings::slice_planes, &Settings::image_width, &Settings::image_height))
    state_->layout_changed = true;
  if (!same(&Settings::speckle_seed)) state_->scatterers_changed = true;
  if (!same(&Settings::beam_window, &Settings::beam_lines, &Settings::focused_beam, &Settings::focus_mm,
            &Settings::f_number, &Settings::frequency_mhz, &Settings::reverberation, &Settings::face_reflection,
            &Settings::speckle_cell_mm, &Settings::slice_thickness_mm))
    state_->beam_changed = true;

  using S = Settings;
  if (!same(&S::samples, &S::reflection_length_mm, &S::frequency_mhz, &S::absorption, &S::gel_mm, &S::speckle,
            &S::speckle_seed, &S::speckle_cell_mm, &S::slice_planes, &S::slice_thickness_mm, &S::image_width,
            &S::image_height, &S::skipping))
    state_->due_from(Stage::traverse);
  else if (!same(&S::beam_window, &S::beam_lines, &S::focused_beam, &S::focus_mm, &S::f_number, &S::reverberation,
                 &S::face_reflection, &S::clutter, &S::two_way))
    state_->due_from(Stage::beam);
  else if (!same(&S::reflection_sigma_mm, &S::transmission_sigma_mm))
    state_->due_from(Stage::smooth);
  else if (!same(&S::blend))
    // Beside weaker scatterers, interfaces may be seen that were not.
    state_->due_from(settings.skipping && settings.blend < old.blend ? Stage::traverse : Stage::fuse);
  else if (!same(&S::clutter_db, &S::electronic_noise, &S::noise_db) ||
           (settings.electronic_noise && !same(&S::fixed_level)))
    state_->due_from(Stage::fuse);
  else if (!same(&S::gain_db, &S::tgc_db, &S::reference_level))
    state_->due_from(Stage::maximum);
  else if (!same(&S::dynamic_range_db, &S::fixed_level, &S::grey_map))
    state_->due_from(Stage::compress);
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
  run_through(Stage::compress);
  const State& s = *state_;
  Stages<float> stages;
  const std::vector<Image<float>> scan = read_channels(s.scan, 4), echoes = read_channels(s.echoes, 4);
  stages.intensity = transposed(scan[0]);
  stages.reflection = transposed(scan[1]);
  stages.reflection_beam = transposed(echoes[0]);
  stages.transmission = transposed(echoes[1]);
  stages.speckle = transposed(echoes[2]);
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
  s.sources = sources;
  for (Program* program : {&s.traverse, &s.reverberation, &s.beam, &s.scan_convert, &s.smooth, &s.clutter, &s.fuse,
                           &s.maximum, &s.compress})
    if (const auto problem = program->reload(sources)) problems += *problem;
  s.due_from(Stage::traverse);
  return problems.empty() ? std::nullopt : std::optional(problems);
}

}  // namespace insonate::gl
