#include "sim/gl/simulator.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/model/beam.h"
#include "sim/model/scatterers.h"
#include "sim/shaders/shared/simulation_parameters.h"

namespace insonate::gl {
namespace {

// Binding points, as in the shaders.
enum Storage : GLuint { kScanLines, kTissueLookup, kBeamWeights, kSpeckleScale, kKernels, kMaximum };

constexpr int kFirstHu = -1024;
constexpr int kLookupSize = 4096;
constexpr double kLn10 = 2.302585092994046;

// As `Line` in traverse.comp.
struct GpuLine {
  glm::vec4 start, along, lateral, elevation;
  glm::vec4 lattice_start, lattice_along;
};

Buffer storage(const std::vector<float>& values) {
  return Buffer(values.size() * sizeof(float), values.data());
}

std::vector<float> to_float(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

// Half of a Gaussian out to three sigma or the picture's size, centre first.
std::vector<float> half_gaussian(double sigma_px, int limit_px) {
  const int radius = sigma_px < 0.05 ? 0 : std::min(int(std::ceil(3 * sigma_px)), limit_px);
  std::vector<float> weights;
  for (int i = 0; i <= radius; ++i)
    weights.push_back(float(radius ? std::exp(-0.5 * i * i / (sigma_px * sigma_px)) : 1.0));
  return weights;
}

Image<float> channel(const std::vector<float>& rgba, int width, int height, int index) {
  Image<float> image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = rgba[4 * i + std::size_t(index)];
  return image;
}

std::vector<float> read_rgba(const Texture& texture) {
  std::vector<float> values(4 * std::size_t(texture.width()) * std::size_t(texture.height()));
  texture.read(GL_RGBA, GL_FLOAT, values.data(), values.size() * sizeof(float));
  return values;
}

}  // namespace

struct Simulator::State {
  explicit State(const ShaderSources& sources)
      : traverse(sources, {"traverse.comp"}),
        beam(sources, {"beam.comp"}),
        scan_convert(sources, {"scan_convert.comp"}),
        smooth(sources, {"smooth.comp"}),
        fuse(sources, {"fuse.comp"}),
        maximum(sources, {"maximum.comp"}),
        compress(sources, {"compress.comp"}) {}

  Program traverse, beam, scan_convert, smooth, fuse, maximum, compress;

  // What the user set.
  Probe probe;
  double depth_mm = 160;
  Settings settings;
  Pose patient_from_probe;
  ScanLines lines;
  ImageGeometry geometry;
  glm::dmat4 texture_from_patient{1.0};

  // What the stages read.
  SimulationParameters parameters{};
  Buffer parameter_buffer{sizeof(SimulationParameters), nullptr};
  Texture volume, scatterers, line_and_sample;
  Buffer line_buffer, tissue_lookup, weights, speckle_scale, kernels;
  Buffer maximum_buffer{sizeof(GLuint), nullptr};

  // What they write.
  Texture scan, echoes, picture, half_smoothed, smoothed, fused, image;

  bool layout_changed = true;      // probe, depth, sample count or picture size
  bool scatterers_changed = true;  // seed
  std::optional<Stage> first_due = Stage::traverse;
  std::array<long, kStageCount> runs{};

  void due_from(Stage stage) { first_due = std::min(first_due.value_or(stage), stage); }
  bool smoothing() const { return parameters.reflection_radius_px > 0 || parameters.transmission_radius_px > 0; }

  void lay_out();
  void upload_scatterers();
  void place_lines();
  void fill_parameters();
  void run();
  void run_smoothing();
};

// Allocates what depends on the number of lines, samples and pixels, and works out where each pixel lies.
void Simulator::State::lay_out() {
  lines = scan_lines(probe, depth_mm, settings.samples);
  const int n = int(lines.lines.size()), d = lines.samples;
  line_buffer = Buffer(lines.lines.size() * sizeof(GpuLine), nullptr);
  scan = Texture::make_2d(GL_RGBA32F, n, d, Filter::nearest);
  echoes = Texture::make_2d(GL_RGBA32F, n, d, Filter::linear);

  const int w = settings.image_width, h = settings.image_height;
  geometry = image_geometry(probe, depth_mm, w, h);
  std::vector<glm::vec2> positions;
  positions.reserve(std::size_t(w) * std::size_t(h));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto at = line_position(probe, depth_mm, geometry.plane_mm(x, y));
      positions.push_back(at ? glm::vec2(at->line, at->r_mm / lines.dr_mm() - 0.5) : glm::vec2(-2));
    }
  line_and_sample = Texture::make_2d(GL_RG32F, w, h, Filter::nearest);
  line_and_sample.write(GL_RG, GL_FLOAT, positions.data());
  picture = Texture::make_2d(GL_RGBA32F, w, h, Filter::nearest);
  half_smoothed = Texture::make_2d(GL_RGBA32F, w, h, Filter::nearest);
  smoothed = Texture::make_2d(GL_RGBA32F, w, h, Filter::nearest);
  fused = Texture::make_2d(GL_R32F, w, h, Filter::nearest);
  image = Texture::make_2d(GL_RGBA8, w, h, Filter::linear);
  layout_changed = false;
}

void Simulator::State::upload_scatterers() {
  constexpr int side = ScattererLattice::kSide;
  scatterers = Texture::make_3d(GL_RG16_SNORM, side, side, side, Filter::linear, Wrap::repeat);
  scatterers.write(GL_RG, GL_SHORT, make_scatterers(settings.speckle_seed).stored.data());
  scatterers_changed = false;
}

// The lines where the probe now is, in the textures' coordinates.
void Simulator::State::place_lines() {
  const glm::dmat4 texture_from_probe = texture_from_patient * patient_from_probe.matrix();
  glm::dmat4 lattice_from_probe = lattice_from_patient(settings.speckle_cell_mm) * patient_from_probe.matrix();
  // Whole periods of the translation change nothing but cost the shader's single precision digits.
  for (int axis = 0; axis < 3; ++axis) lattice_from_probe[3][axis] -= std::floor(lattice_from_probe[3][axis]);

  const auto point = [](const glm::dmat4& map, const glm::dvec3& p) { return glm::vec4(map * glm::dvec4(p, 1)); };
  const auto step = [](const glm::dmat4& map, const glm::dvec3& d) { return glm::vec4(map * glm::dvec4(d, 0)); };
  std::vector<GpuLine> placed;
  placed.reserve(lines.lines.size());
  for (const ScanLine& line : lines.lines) {
    const glm::dvec3 d = line.direction, lateral(d.y, -d.x, 0);
    placed.push_back({point(texture_from_probe, line.start), step(texture_from_probe, d),
                      step(texture_from_probe, lateral), step(texture_from_probe, glm::cross(d, lateral)),
                      point(lattice_from_probe, line.start), step(lattice_from_probe, d)});
  }
  line_buffer.write(placed.data(), placed.size() * sizeof(GpuLine));
}

void Simulator::State::fill_parameters() {
  const double dr = lines.dr_mm();
  SimulationParameters& p = parameters;
  p.lines = int(lines.lines.size());
  p.samples = lines.samples;
  p.r_min_mm = float(lines.r_min_mm);
  p.dr_mm = float(dr);
  p.half_reflection_length_mm = float(settings.reflection_length_mm / 2);
  p.reflection_exponent = float(dr / settings.reflection_length_mm);
  p.absorption_per_sample = float(settings.absorption ? settings.frequency_mhz * dr / 100 * kLn10 : 0);
  p.gel_mm = float(settings.gel_mm);
  p.speckle = settings.speckle;
  p.beam_half = (settings.beam_lines - 1) / 2;
  p.two_way = settings.two_way;
  p.blend = float(settings.blend);
  p.gain = float(std::pow(10.0, settings.gain_db / 10));
  p.dynamic_range_db = float(settings.dynamic_range_db);
  p.fixed_level = float(settings.fixed_level);
  p.frame_maximum = settings.reference_level == ReferenceLevel::frame_maximum;
  for (int i = 0; i < 8; ++i) p.tgc_db[i / 4][i % 4] = float(settings.tgc_db[std::size_t(i)]);

  if (*first_due <= Stage::smooth) {
    weights = storage(to_float(beam_weights(settings)));
    speckle_scale = storage(to_float(envelope_scale(lines, settings)));
    const int limit = std::max(settings.image_width, settings.image_height) - 1;
    std::vector<float> kernel = half_gaussian(settings.reflection_sigma_mm / geometry.mm_per_pixel, limit);
    const std::vector<float> second = half_gaussian(settings.transmission_sigma_mm / geometry.mm_per_pixel, limit);
    p.reflection_radius_px = int(kernel.size()) - 1;
    p.transmission_radius_px = int(second.size()) - 1;
    kernel.insert(kernel.end(), second.begin(), second.end());
    kernels = storage(kernel);
  }
  parameter_buffer.write(&parameters, sizeof parameters);
}

void Simulator::State::run_smoothing() {
  const GLint axis = smooth.uniform("axis");
  kernels.bind_storage(kKernels);
  smooth.use();
  picture.bind(0);
  half_smoothed.bind_image(0, GL_WRITE_ONLY);
  glUniform2i(axis, 1, 0);
  smooth.dispatch(picture.width(), picture.height());
  half_smoothed.bind(0);
  smoothed.bind_image(0, GL_WRITE_ONLY);
  glUniform2i(axis, 0, 1);
  smooth.dispatch(picture.width(), picture.height());
}

void Simulator::State::run() {
  if (!first_due || !volume) return;
  if (layout_changed) lay_out();
  if (scatterers_changed) upload_scatterers();
  if (*first_due == Stage::traverse) place_lines();
  fill_parameters();
  parameter_buffer.bind_uniform(0);

  const auto due = [&](Stage stage) {
    if (stage < *first_due) return false;
    ++runs[std::size_t(stage)];
    return true;
  };
  if (due(Stage::traverse)) {
    volume.bind(0);
    scatterers.bind(1);
    line_buffer.bind_storage(kScanLines);
    tissue_lookup.bind_storage(kTissueLookup);
    scan.bind_image(0, GL_WRITE_ONLY);
    traverse.dispatch(scan.width(), 1);
  }
  if (due(Stage::beam)) {
    scan.bind(0);
    weights.bind_storage(kBeamWeights);
    speckle_scale.bind_storage(kSpeckleScale);
    echoes.bind_image(0, GL_WRITE_ONLY);
    beam.dispatch(scan.width(), scan.height());
  }
  if (due(Stage::scan_convert)) {
    echoes.bind(0);
    line_and_sample.bind(1);
    picture.bind_image(0, GL_WRITE_ONLY);
    scan_convert.dispatch(picture.width(), picture.height());
  }
  if (smoothing() && due(Stage::smooth)) run_smoothing();
  if (due(Stage::fuse)) {
    (smoothing() ? smoothed : picture).bind(0);
    fused.bind_image(0, GL_WRITE_ONLY);
    fuse.dispatch(fused.width(), fused.height());
  }
  line_and_sample.bind(1);
  maximum_buffer.bind_storage(kMaximum);
  if (parameters.frame_maximum && due(Stage::maximum)) {
    const GLuint zero = 0;
    maximum_buffer.write(&zero, sizeof zero);
    fused.bind(0);
    maximum.dispatch(fused.width(), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  if (due(Stage::compress)) {
    fused.bind(0);
    image.bind_image(0, GL_WRITE_ONLY);
    compress.dispatch(image.width(), image.height());
  }
  first_due.reset();
}

Simulator::Simulator(const ShaderSources& sources) : state_(std::make_unique<State>(sources)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

void Simulator::set_volume(const AcousticVolume& volume, const TissueTable& table) {
  const glm::ivec3 size = volume.grid.size;
  Texture texture = Texture::make_3d(GL_RG16_SNORM, size.x, size.y, size.z, Filter::linear, Wrap::border);
  const AcousticVoxel outside;
  texture.set_border(float(outside.hu) / 32767.0f, float(outside.echogenicity_cdb) / 32767.0f, 0, 0);
  texture.write(GL_RG, GL_SHORT, volume.voxels.data());
  state_->volume = std::move(texture);
  // Voxel centres lie at (i + 1/2) / size in a texture.
  glm::dmat4 texture_from_index = glm::scale(glm::dmat4(1.0), 1.0 / glm::dvec3(size));
  texture_from_index = glm::translate(texture_from_index, glm::dvec3(0.5));
  state_->texture_from_patient = texture_from_index * glm::inverse(volume.grid.matrix());

  std::vector<float> lookup;
  for (int i = 0; i < kLookupSize; ++i) {
    const TissueKnot knot = table.at(kFirstHu + i);
    lookup.push_back(float(knot.impedance_mrayl));
    lookup.push_back(float(knot.absorption_db_cm_mhz));
  }
  state_->tissue_lookup = storage(lookup);
  state_->due_from(Stage::traverse);
}

void Simulator::set_probe(const Probe& probe, double depth_mm) {
  state_->probe = probe;
  state_->depth_mm = depth_mm;
  state_->layout_changed = true;
  state_->due_from(Stage::traverse);
}

void Simulator::set_settings(const Settings& settings) {
  const Settings& old = state_->settings;
  const auto same = [&](auto... members) { return ((old.*members == settings.*members) && ...); };
  if (!same(&Settings::samples, &Settings::image_width, &Settings::image_height)) state_->layout_changed = true;
  if (!same(&Settings::speckle_seed)) state_->scatterers_changed = true;

  using S = Settings;
  if (!same(&S::samples, &S::reflection_length_mm, &S::frequency_mhz, &S::absorption, &S::gel_mm, &S::speckle,
            &S::speckle_seed, &S::speckle_cell_mm, &S::image_width, &S::image_height))
    state_->due_from(Stage::traverse);
  else if (!same(&S::beam_window, &S::beam_lines, &S::two_way))
    state_->due_from(Stage::beam);
  else if (!same(&S::reflection_sigma_mm, &S::transmission_sigma_mm))
    state_->due_from(Stage::smooth);
  else if (!same(&S::blend))
    state_->due_from(Stage::fuse);
  else if (!same(&S::gain_db, &S::tgc_db, &S::reference_level))
    state_->due_from(Stage::maximum);
  else if (!same(&S::dynamic_range_db, &S::fixed_level))
    state_->due_from(Stage::compress);
  state_->settings = settings;
}

void Simulator::set_pose(const Pose& patient_from_probe) {
  if (patient_from_probe == state_->patient_from_probe) return;
  state_->patient_from_probe = patient_from_probe;
  state_->due_from(Stage::traverse);
}

const Texture& Simulator::image() {
  state_->run();
  return state_->image;
}

const ImageGeometry& Simulator::geometry() const {
  return state_->geometry;
}
const Texture& Simulator::volume_texture() const {
  return state_->volume;
}
const glm::dmat4& Simulator::texture_from_patient() const {
  return state_->texture_from_patient;
}
const std::array<long, kStageCount>& Simulator::runs() const {
  return state_->runs;
}

Stages<float> Simulator::read_stages() {
  state_->run();
  const State& s = *state_;
  const int n = s.scan.width(), d = s.scan.height(), w = s.image.width(), h = s.image.height();
  Stages<float> stages;
  const std::vector<float> scan = read_rgba(s.scan), echoes = read_rgba(s.echoes);
  stages.intensity = channel(scan, n, d, 0);
  stages.reflection = channel(scan, n, d, 1);
  stages.reflection_beam = channel(echoes, n, d, 0);
  stages.transmission = channel(echoes, n, d, 1);
  stages.speckle = channel(echoes, n, d, 2);
  stages.fused = Image<float>(w, h);
  s.fused.read(GL_RED, GL_FLOAT, stages.fused.pixels.data(), stages.fused.pixels.size() * sizeof(float));
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
  State& s = *state_;
  std::string problems;
  for (Program* program : {&s.traverse, &s.beam, &s.scan_convert, &s.smooth, &s.fuse, &s.maximum, &s.compress})
    if (const auto problem = program->reload(sources)) problems += *problem;
  s.due_from(Stage::traverse);
  return problems.empty() ? std::nullopt : std::optional(problems);
}

}  // namespace insonate::gl
