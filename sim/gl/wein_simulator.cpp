#include "sim/gl/wein_simulator.h"

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/gl/density_volume.h"
#include "sim/gl/fan_layout.h"
#include "sim/shaders/shared/wein_parameters.h"

namespace insonate::gl {
namespace {

// Of a chunk's scan lines: what a processor's second-level cache holds.
constexpr std::size_t kChunkBytes = std::size_t(2) << 20;
constexpr std::size_t kSampleBytes = 4;

// Below this no echo is left: with any compression it is less than half a step of what the scan holds.
constexpr double kLeastIntensity = 1e-10;

constexpr std::size_t kGroup = 8;  // the shaders' local size

// Columns of pixels, one an invocation, as a table with a row a step; as many columns as whole groups have.
Texture as_table(const std::vector<std::vector<glm::vec4>>& columns, const glm::vec4& filler) {
  std::size_t steps = 0;
  for (const auto& column : columns) steps = std::max(steps, column.size());
  const std::size_t width = (columns.size() + kGroup - 1) / kGroup * kGroup;
  std::vector<glm::vec4> table(width * steps, filler);
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t step = 0; step < columns[i].size(); ++step) table[step * width + i] = columns[i][step];
  Texture texture = Texture::make_2d(GL_RGBA32F, int(width), int(steps), Filter::nearest);
  texture.write(GL_RGBA, GL_FLOAT, table.data());
  return texture;
}

// Pixels shared out to invocations, a column each, so that a group takes neighbours at a step; about 32 pixels a
// column, and no side above 16384.
Texture shared_out(const std::vector<glm::vec4>& pixels, const glm::vec4& filler) {
  if (pixels.empty()) return {};
  const std::size_t groups = std::clamp<std::size_t>(pixels.size() / (32 * kGroup), 1, 512);
  const std::size_t steps = (pixels.size() + groups * kGroup - 1) / (groups * kGroup);
  std::vector<std::vector<glm::vec4>> columns(groups * kGroup);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    columns[i / kGroup / steps * kGroup + i % kGroup].push_back(pixels[i]);
  return as_table(columns, filler);
}

// What traverses lines; `tells`: the intensity too, which no picture needs.
Program traverse_program(const ShaderSources& sources, bool tells) {
  return Program(sources, {"wein_traverse.comp"}, tells ? Defines{{"INTENSITY", ""}} : Defines{});
}

}  // namespace

struct WeinSimulator::State {
  State(const AcousticVolume& volume, const Probe& probe, double depth_mm, const WeinSettings& wanted,
        const ShaderSources& given);

  void traverse(std::span<const Pose> chunk, std::size_t first, const Program& program);
  template <typename Work>
  void by_chunks(std::span<const Pose> poses, Work&& work);
  std::vector<glm::vec4> positions() const;

  WeinSettings settings;
  ShaderSources sources;
  ScanLines lines;
  FanLayout fan;
  std::size_t chunk_images;
  glm::dmat4 texture_from_patient{1.0};
  WeinParameters parameters{};

  Program traverse_lines, picture, parts, lc2;
  Buffer parameter_buffer{sizeof(WeinParameters), nullptr}, similarities;
  std::size_t similarities_held = 0;
  Texture density, probe_lines, places, scan, fan_pixels, counted_pixels, sums, grid;
  std::vector<glm::vec4> place_rows;
};

WeinSimulator::State::State(const AcousticVolume& volume, const Probe& probe, double depth_mm,
                            const WeinSettings& wanted, const ShaderSources& given)
    : settings(wanted),
      sources(given),
      lines(scan_lines(probe, depth_mm, wanted.samples)),
      fan(probe, depth_mm, lines, wanted.image_width, wanted.image_height),
      traverse_lines(traverse_program(given, false)),
      picture(given, {"wein_picture.comp"}),
      parts(given, {"lc2_parts.comp"}),
      lc2(given, {"lc2.comp"}),
      density(density_volume(volume, wanted.reflection_length_mm)) {
  const int n = int(lines.lines.size()), d = lines.samples;
  const double dr = lines.dr_mm();
  const glm::dvec3 size(volume.grid.size);
  const glm::dmat4 index_from_patient = glm::inverse(volume.grid.matrix());
  for (int column = 0; column < 4; ++column)
    texture_from_patient[column] = index_from_patient[column] / glm::dvec4(size, 1);
  texture_from_patient[3] += glm::dvec4(0.5 / size, 0);  // voxel centres lie at (i + 1/2) / size

  std::vector<glm::vec4> ways;
  for (const ScanLine& line : lines.lines) {
    ways.emplace_back(line.start + (lines.r_min_mm + dr / 2) * line.direction, 0);
    ways.emplace_back(dr * line.direction, 0);
  }
  probe_lines = Texture::make_2d(GL_RGBA32F, 2, n, Filter::nearest);
  probe_lines.write(GL_RGBA, GL_FLOAT, ways.data());

  GLint most = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
  chunk_images =
      std::clamp<std::size_t>(kChunkBytes / (std::size_t(n) * std::size_t(d) * kSampleBytes), 1, std::size_t(most));
  scan = Texture::make_layers(GL_RG16, d, n, int(chunk_images), Filter::linear);
  places = Texture::make_2d(GL_RGBA32F, 3, int(chunk_images), Filter::nearest);
  place_rows.resize(3 * chunk_images);

  const int w = settings.image_width;
  std::vector<glm::vec4> pixels = positions();
  std::size_t inside = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (fan.inside.pixels[i]) pixels[inside++] = glm::vec4(pixels[i].x, pixels[i].y, int(i) % w, int(i) / w);
  pixels.resize(inside);
  if (inside > 0) fan_pixels = shared_out(pixels, pixels.back());

  WeinParameters& p = parameters;
  p.lines = n;
  p.samples = d;
  p.width = w;
  p.height = settings.image_height;
  p.columns = 1;
  p.shadows = settings.shadows;
  // Sample k lies at (k + 1/2) dr behind r_min: the first one that is not nearer than the contact.
  p.first_free_sample = float(std::ceil((settings.contact_mm - lines.r_min_mm) / dr - 0.5));
  p.patches = settings.similarity_patch > 0;
  p.dr_by_length = float(dr / settings.reflection_length_mm);
  p.compression = float(settings.compression);
  p.one_over_compressed_one = float(1 / std::log1p(settings.compression));
  p.dark_hu = float(settings.dark_hu);
  p.one_over_hu_range = float(1 / (settings.bright_hu - settings.dark_hu));
  p.reflection_share = float(settings.reflection_share);
  p.last_log_intensity = settings.shadows ? float(std::log(kLeastIntensity)) : -INFINITY;
  p.sides_by_dr = glm::vec4(size * volume.grid.spacing / dr, 0);
}

// Where each pixel lies in the scan's texture, in x and y.
std::vector<glm::vec4> WeinSimulator::State::positions() const {
  const glm::vec2 size(lines.samples, int(lines.lines.size()));
  std::vector<glm::vec4> result;
  for (const glm::vec2& at : fan.line_and_sample) result.emplace_back((glm::vec2(at.y, at.x) + 0.5f) / size, 0, 0);
  return result;
}

// Places a chunk's lines and walks along them.
void WeinSimulator::State::traverse(std::span<const Pose> chunk, std::size_t first, const Program& program) {
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    const glm::dmat4 rows = glm::transpose(texture_from_patient * chunk[i].matrix());
    for (int row = 0; row < 3; ++row) place_rows[3 * i + std::size_t(row)] = glm::vec4(rows[row]);
  }
  places.write(GL_RGBA, GL_FLOAT, place_rows.data());
  parameters.images = int(chunk.size());
  parameters.first = int(first);
  parameter_buffer.write(&parameters, sizeof parameters);
  parameter_buffer.bind_uniform(0);
  density.bind(0);
  probe_lines.bind(1);
  places.bind(2);
  scan.bind_image(0, GL_WRITE_ONLY);
  program.dispatch(parameters.lines, parameters.images);
}

template <typename Work>
void WeinSimulator::State::by_chunks(std::span<const Pose> poses, Work&& work) {
  for (std::size_t first = 0; first < poses.size(); first += chunk_images) {
    const std::span<const Pose> chunk = poses.subspan(first, std::min(chunk_images, poses.size() - first));
    traverse(chunk, first, traverse_lines);
    scan.bind(0);
    work(int(chunk.size()));
  }
}

WeinSimulator::WeinSimulator(const AcousticVolume& volume, const Probe& probe, double depth_mm,
                             const WeinSettings& settings, const ShaderSources& sources)
    : state_(std::make_unique<State>(volume, probe, depth_mm, settings, sources)) {}
WeinSimulator::~WeinSimulator() = default;
WeinSimulator::WeinSimulator(WeinSimulator&&) noexcept = default;
WeinSimulator& WeinSimulator::operator=(WeinSimulator&&) noexcept = default;

const ImageGeometry& WeinSimulator::geometry() const {
  return state_->fan.geometry;
}
const Image<std::uint8_t>& WeinSimulator::inside() const {
  return state_->fan.inside;
}

const Texture& WeinSimulator::simulate(std::span<const Pose> patient_from_probe) {
  State& s = *state_;
  const int w = s.settings.image_width, h = s.settings.image_height;
  const int count = std::max(int(patient_from_probe.size()), 1);
  const int columns = std::clamp(int(std::lround(std::sqrt(double(count) * h / w))), 1, count);
  const int rows = (count + columns - 1) / columns;
  const bool fits = s.grid && s.grid.width() == columns * w && s.grid.height() == rows * h;
  if (!fits) s.grid = Texture::make_2d(GL_R8, columns * w, rows * h, Filter::nearest);
  if (!fits || count < columns * rows) s.grid.clear();  // what no fan covers stays so
  s.parameters.columns = columns;
  if (!s.fan_pixels) return s.grid;
  s.by_chunks(patient_from_probe, [&](int images) {
    s.fan_pixels.bind(1);
    s.grid.bind_image(0, GL_WRITE_ONLY);
    s.picture.dispatch(s.fan_pixels.width(), images);
  });
  return s.grid;
}

glm::ivec2 WeinSimulator::tile(int image) const {
  const State& s = *state_;
  return glm::ivec2(image % s.parameters.columns, image / s.parameters.columns) *
         glm::ivec2(s.settings.image_width, s.settings.image_height);
}

void WeinSimulator::set_ultrasound(const Image<float>& image) {
  State& s = *state_;
  const Image<std::uint8_t>& fan = s.fan.inside;
  if (image.width != fan.width || image.height != fan.height)
    throw std::invalid_argument("WeinSimulator: the ultrasound image has another size than the simulated ones");
  // Brought to mean 0 and variance 1 in double precision: LC2 feels neither gain nor offset, single precision would.
  const auto counts = [&](std::size_t i) { return fan.pixels[i] && !std::isnan(image.pixels[i]); };
  double count = 0, sum = 0, squares = 0;
  float least = INFINITY, most = -INFINITY;
  for (std::size_t i = 0; i < fan.pixels.size(); ++i)
    if (counts(i)) {
      ++count;
      sum += image.pixels[i];
      least = std::min(least, image.pixels[i]);
      most = std::max(most, image.pixels[i]);
    }
  const double mean = sum / std::max(count, 1.0);
  for (std::size_t i = 0; i < fan.pixels.size(); ++i)
    if (counts(i)) squares += (image.pixels[i] - mean) * (image.pixels[i] - mean);
  const double scale = most > least ? 1 / std::sqrt(squares / count) : 0;  // of a flat image nothing is left
  const int width = fan.width, patch = s.settings.similarity_patch, across = patch ? (width + patch - 1) / patch : 0;
  const std::vector<glm::vec4> positions = s.positions();
  std::vector<glm::vec4> pixels;
  std::vector<std::vector<glm::vec4>> patches;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (counts(i)) {
      pixels.emplace_back(positions[i].x, positions[i].y, (image.pixels[i] - mean) * scale, 1);
      if (!patch) continue;
      const std::size_t in = std::size_t(int(i) / width / patch * across + int(i) % width / patch);
      patches.resize(std::max(patches.size(), in + 1));
      patches[in].push_back(pixels.back());
    }
  s.counted_pixels = patches.empty() ? shared_out(pixels, glm::vec4(0)) : as_table(patches, glm::vec4(0));
  if (s.counted_pixels)
    s.sums = Texture::make_2d(GL_RGBA32F, 3 * s.counted_pixels.width(), int(s.chunk_images), Filter::nearest);
}

std::vector<float> WeinSimulator::similarity(std::span<const Pose> patient_from_probe) {
  State& s = *state_;
  std::vector<float> result(patient_from_probe.size());
  if (result.empty() || !s.counted_pixels) return result;
  const std::size_t bytes = result.size() * sizeof(float);
  if (s.similarities_held < result.size()) {
    s.similarities = Buffer(bytes, nullptr);
    s.similarities_held = result.size();
  }
  s.by_chunks(patient_from_probe, [&](int images) {
    s.counted_pixels.bind(1);
    s.sums.bind_image(0, GL_WRITE_ONLY);
    s.parts.dispatch(s.counted_pixels.width(), images);
    s.similarities.bind_storage(0);
    s.sums.bind(0);
    s.lc2.dispatch(images, 1);
  });
  s.similarities.read(result.data(), bytes);
  return result;
}

WeinStages<float> WeinSimulator::read_stages(const Pose& patient_from_probe) {
  State& s = *state_;
  simulate({&patient_from_probe, 1});
  const int n = s.parameters.lines, d = s.parameters.samples;
  const Texture intensities = Texture::make_2d(GL_R32F, d, n, Filter::nearest);
  intensities.bind_image(1, GL_WRITE_ONLY);
  s.traverse({&patient_from_probe, 1}, 0, traverse_program(s.sources, true));
  const std::size_t count = std::size_t(n) * std::size_t(d);
  std::vector<glm::vec2> terms(count * s.chunk_images);
  s.scan.read(GL_RG, GL_FLOAT, terms.data(), terms.size() * sizeof(glm::vec2));
  std::vector<float> intensity(count);
  intensities.read(GL_RED, GL_FLOAT, intensity.data(), count * sizeof(float));
  WeinStages<float> stages;
  stages.intensity = stages.scan_echogenicity = stages.scan_reflection = Image<float>(n, d);
  for (int line = 0; line < n; ++line)
    for (int k = 0; k < d; ++k) {
      const std::size_t i = std::size_t(line) * std::size_t(d) + std::size_t(k);
      stages.scan_echogenicity.at(line, k) = terms[i].x;
      stages.scan_reflection.at(line, k) = terms[i].y;
      stages.intensity.at(line, k) = intensity[i];
    }
  stages.grey = Image<std::uint8_t>(s.settings.image_width, s.settings.image_height);
  s.grid.read(GL_RED, GL_UNSIGNED_BYTE, stages.grey.pixels.data(), stages.grey.pixels.size());
  return stages;
}

}  // namespace insonate::gl
