#include "sim/gl/wein_simulator.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

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
constexpr std::size_t kSampleBytes = 16;

// As `Line` in wein_traverse.comp.
struct GpuLine {
  glm::vec4 start, along, direction;
};

// Per row of a mask: the first pixel in it and the one behind the last; both 0 where there is none.
Buffer rows_of(const Image<std::uint8_t>& mask) {
  std::vector<glm::ivec2> rows(std::size_t(mask.height), glm::ivec2(0));
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask.at(x, y)) {
        glm::ivec2& row = rows[std::size_t(y)];
        if (row.y == 0) row.x = x;
        row.y = x + 1;
      }
  return Buffer(rows.size() * sizeof(glm::ivec2), rows.data());
}

}  // namespace

struct WeinSimulator::State {
  State(const AcousticVolume& volume, const Probe& probe, double depth_mm, const WeinSettings& wanted,
        const ShaderSources& sources);

  void begin(std::span<const Pose> chunk, std::size_t first);
  template <typename Work>
  void by_chunks(std::span<const Pose> poses, Work&& work);
  void write_pixels(const std::vector<glm::vec2>& u_and_weight);

  WeinSettings settings;
  ScanLines lines;
  FanLayout fan;
  std::size_t chunk_images;
  glm::dmat4 texture_from_patient{1.0};
  glm::dmat3 axes_from_patient{1.0};
  WeinParameters parameters{};

  Program traverse, picture, rows, lc2;
  Buffer parameter_buffer{sizeof(WeinParameters), nullptr};
  Buffer line_buffer, fan_rows, counted_rows, similarities;
  std::size_t similarities_held = 0;
  Texture density, pixels, scan, sums, grid;
  std::vector<GpuLine> placed;
};

WeinSimulator::State::State(const AcousticVolume& volume, const Probe& probe, double depth_mm,
                            const WeinSettings& wanted, const ShaderSources& sources)
    : settings(wanted),
      lines(scan_lines(probe, depth_mm, wanted.samples)),
      fan(probe, depth_mm, lines, wanted.image_width, wanted.image_height),
      traverse(sources, {"wein_traverse.comp"}),
      picture(sources, {"wein_picture.comp"}),
      rows(sources, {"lc2_rows.comp"}),
      lc2(sources, {"lc2.comp"}),
      density(density_volume(volume, wanted.reflection_length_mm)) {
  const int n = int(lines.lines.size()), d = lines.samples, w = settings.image_width, h = settings.image_height;
  const glm::dvec3 size(volume.grid.size);
  const glm::dmat4 index_from_patient = glm::inverse(volume.grid.matrix());
  for (int column = 0; column < 4; ++column)
    texture_from_patient[column] = index_from_patient[column] / glm::dvec4(size, 1);
  texture_from_patient[3] += glm::dvec4(0.5 / size, 0);  // voxel centres lie at (i + 1/2) / size
  axes_from_patient = glm::inverse(volume.grid.direction);

  GLint longest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &longest);
  chunk_images = std::clamp<std::size_t>(kChunkBytes / (std::size_t(n) * std::size_t(d) * kSampleBytes), 1,
                                         std::size_t(std::max(longest / n, 1)));
  const int scan_rows = n * int(chunk_images);
  line_buffer = Buffer(std::size_t(scan_rows) * sizeof(GpuLine), nullptr);
  scan = Texture::make_2d(GL_RGBA32F, d, scan_rows, Filter::nearest);
  sums = Texture::make_2d(GL_RGBA32F, 3 * h, int(chunk_images), Filter::nearest);
  pixels = Texture::make_2d(GL_RGBA32F, w, h, Filter::nearest);
  fan_rows = rows_of(fan.inside);
  write_pixels(std::vector<glm::vec2>(fan.inside.pixels.size(), glm::vec2(0)));

  WeinParameters& p = parameters;
  p.lines = n;
  p.samples = d;
  p.width = w;
  p.height = h;
  p.columns = 1;
  // Sample k lies at (k + 1/2) dr behind r_min: the first one that is not nearer than the contact.
  p.first_free_sample = float(std::ceil((settings.contact_mm - lines.r_min_mm) / lines.dr_mm() - 0.5));
  p.dr_by_length = float(lines.dr_mm() / settings.reflection_length_mm);
  p.compression = float(settings.compression);
  p.one_over_compressed_one = float(1 / std::log1p(settings.compression));
  p.dark_hu = float(settings.dark_hu);
  p.one_over_hu_range = float(1 / (settings.bright_hu - settings.dark_hu));
  p.reflection_share = float(settings.reflection_share);
  p.shadows = settings.shadows;
}

// Where each pixel lies among the lines, and what of the ultrasound image is there.
void WeinSimulator::State::write_pixels(const std::vector<glm::vec2>& u_and_weight) {
  std::vector<glm::vec4> texels;
  for (std::size_t i = 0; i < u_and_weight.size(); ++i) texels.emplace_back(fan.line_and_sample[i], u_and_weight[i]);
  pixels.write(GL_RGBA, GL_FLOAT, texels.data());
  Image<std::uint8_t> counted = fan.inside;
  for (std::size_t i = 0; i < texels.size(); ++i) counted.pixels[i] = texels[i].w > 0;
  counted_rows = rows_of(counted);
}

// Places a chunk's lines and walks along them.
void WeinSimulator::State::begin(std::span<const Pose> chunk, std::size_t first) {
  const double dr = lines.dr_mm(), r0 = lines.r_min_mm + dr / 2;
  placed.clear();
  for (const Pose& pose : chunk) {
    const glm::dmat4 texture_from_probe = texture_from_patient * pose.matrix();
    const glm::dmat3 turn(texture_from_probe), axes_from_probe = axes_from_patient * pose.rotation;
    const glm::dvec3 shift(texture_from_probe[3]);
    for (const ScanLine& line : lines.lines)
      placed.push_back({glm::vec4(turn * (line.start + r0 * line.direction) + shift, 0),
                        glm::vec4(turn * (dr * line.direction), 0), glm::vec4(axes_from_probe * line.direction, 0)});
  }
  line_buffer.write(placed.data(), placed.size() * sizeof(GpuLine));
  parameters.images = int(chunk.size());
  parameters.first = int(first);
  parameter_buffer.write(&parameters, sizeof parameters);
  parameter_buffer.bind_uniform(0);
  line_buffer.bind_storage(0);
  density.bind(0);
  scan.bind_image(0, GL_WRITE_ONLY);
  traverse.dispatch(int(placed.size()), 1);
}

template <typename Work>
void WeinSimulator::State::by_chunks(std::span<const Pose> poses, Work&& work) {
  for (std::size_t first = 0; first < poses.size(); first += chunk_images) {
    const std::span<const Pose> chunk = poses.subspan(first, std::min(chunk_images, poses.size() - first));
    begin(chunk, first);
    scan.bind(0);
    pixels.bind(1);
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
  s.by_chunks(patient_from_probe, [&](int images) {
    s.fan_rows.bind_storage(0);
    s.grid.bind_image(0, GL_WRITE_ONLY);
    s.picture.dispatch(images * h, 1);
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
  std::vector<glm::vec2> u_and_weight(fan.pixels.size(), glm::vec2(0));
  for (std::size_t i = 0; i < fan.pixels.size(); ++i)
    if (counts(i)) u_and_weight[i] = glm::vec2(float((image.pixels[i] - mean) * scale), 1);
  s.write_pixels(u_and_weight);
}

std::vector<float> WeinSimulator::similarity(std::span<const Pose> patient_from_probe) {
  State& s = *state_;
  std::vector<float> result(patient_from_probe.size());
  if (result.empty()) return result;
  const std::size_t bytes = result.size() * sizeof(float);
  if (s.similarities_held < result.size()) {
    s.similarities = Buffer(bytes, nullptr);
    s.similarities_held = result.size();
  }
  s.by_chunks(patient_from_probe, [&](int images) {
    s.counted_rows.bind_storage(0);
    s.sums.bind_image(0, GL_WRITE_ONLY);
    s.rows.dispatch(images * s.settings.image_height, 1);
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
  std::vector<glm::vec4> values(std::size_t(s.scan.width()) * std::size_t(s.scan.height()));
  s.scan.read(GL_RGBA, GL_FLOAT, values.data(), values.size() * sizeof(glm::vec4));
  WeinStages<float> stages;
  stages.intensity = stages.scan_echogenicity = stages.scan_reflection = Image<float>(n, d);
  for (int line = 0; line < n; ++line)
    for (int k = 0; k < d; ++k) {
      const glm::vec4& value = values[std::size_t(line) * std::size_t(d) + std::size_t(k)];
      stages.scan_echogenicity.at(line, k) = value.x;
      stages.scan_reflection.at(line, k) = value.y;
      stages.intensity.at(line, k) = value.z;
    }
  stages.grey = Image<std::uint8_t>(s.settings.image_width, s.settings.image_height);
  s.grid.read(GL_RED, GL_UNSIGNED_BYTE, stages.grey.pixels.data(), stages.grey.pixels.size());
  return stages;
}

}  // namespace insonate::gl
