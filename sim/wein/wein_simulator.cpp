#include "sim/wein/wein_simulator.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "sim/core/text.h"
#include "sim/gl/streamed_buffer.h"
#include "sim/imaging/device_volume.h"
#include "sim/imaging/fan_layout.h"
#include "sim/imaging/view_limits.h"
#include "sim/shaders/wein/wein_parameters.h"
#include "sim/wein/density_volume.h"
#include "sim/wein/pixel_table.h"
#include "sim/wein/scan_stages.h"
#include "sim/wein/wein_settings_file.h"

namespace insonate::gl {
namespace {

// Bounds the memory of a chunk's scan lines; their grey takes half as much again. The fixed overhead of a chunk equals
// about three images (`insonate-bench batch`, llvmpipe), so the images that a search asks for at once fit one chunk.
constexpr std::size_t kChunkBytes = std::size_t(16) << 20;
constexpr std::size_t kSampleBytes = 4;
constexpr std::size_t kMaxChunk = 2048;  // images; some tables have one row per image

// Below this no echo is left: with any compression, it is less than half a step of what the scan stores.
constexpr double kMinIntensity = 1e-10;

// Nodes of bent lines: from the first line to the last, and segments along a line.
constexpr int kBendAcross = 33, kMaxBendSegments = 32;

// Returns the number of images per chunk: whole texels of interleaved images if that many fit.
std::size_t images_of_chunk(std::size_t image_samples) {
  const std::size_t fit = std::clamp<std::size_t>(kChunkBytes / (image_samples * kSampleBytes), 1, kMaxChunk);
  return fit < ScanStages::kInterleaved ? fit : fit - fit % ScanStages::kInterleaved;
}

constexpr const char* kName = "Wein simulator";

void check_poses(std::span<const Pose> poses) {
  for (const Pose& pose : poses) check_pose(kName, pose);
}

void check_places(std::span<const glm::dmat4> places) {
  for (const glm::dmat4& place : places) {
    const glm::dvec4 last(place[0][3], place[1][3], place[2][3], place[3][3]);
    bool fine = last == glm::dvec4(0, 0, 0, 1) && glm::length(glm::dvec3(place[3])) <= kMaxDistance_mm;
    for (int axis = 0; axis < 3; ++axis) {
      const double scale = glm::length(glm::dvec3(place[axis]));
      fine = fine && scale >= WeinSimulator::kMinStretch && scale <= WeinSimulator::kMaxStretch;
    }
    if (!fine) throw std::invalid_argument(std::string(kName) + ": a place is not an affine map that it accepts");
  }
}

std::vector<glm::dmat4> matrices_of(std::span<const Pose> poses) {
  std::vector<glm::dmat4> matrices;
  matrices.reserve(poses.size());
  for (const Pose& pose : poses) matrices.push_back(pose.matrix());
  return matrices;
}

// Returns a number as a GLSL expression.
std::string literal(double value) {
  return formatted("float(%.9g)", value);
}

}  // namespace

// What lines that bend need besides the rest, built when they are first asked for.
struct Bent {
  std::optional<Program> interleaved;
  Program alone, lc2;
  Texture bends;
  std::vector<glm::vec4> rows;
  Buffer shares;
  std::size_t shares_held = 0;
};

struct WeinSimulator::State {
  State(const AcousticVolume& volume, const Probe& probe, double depth_mm, const WeinSettings& wanted,
        const ShaderSources& given, const WorkDivision& chosen);

  const ScanStages& stages_for(std::size_t images) const { return images > 1 && interleaved ? *interleaved : alone; }
  void traverse(std::span<const glm::dmat4> chunk, std::size_t first, const ScanStages& stages, const Program& program,
                const TexelBuffer& scan);
  void ran(WeinStage stage, std::size_t images, std::size_t pixels);
  void place_bends(std::size_t first, std::size_t count);
  template <typename Work>
  void by_chunks(std::span<const glm::dmat4> poses, const ScanStages& stages, const Program& program,
                 const TexelBuffer& scan, Work&& work);
  Defines constants(const AcousticVolume& volume) const;

  WeinSettings settings;
  ShaderSources sources;
  const WorkDivision division;
  const std::size_t group;  // the shaders' local size
  ScanLines lines;
  const int row_samples;  // per line of a scan: even, so that no pair of samples spans two lines
  FanLayout fan;
  const std::size_t image_samples, chunk_images;
  const int tile_words;  // per row of an image in the grid, four pixels each
  glm::dmat4 texture_from_patient{1.0};
  WeinParameters parameters{};

  std::optional<ScanStages> interleaved;  // for calls with several images, with a software renderer
  ScanStages alone;
  Program lc2;
  StreamedBuffer parameter_buffer;
  Buffer similarities;
  std::size_t similarities_held = 0;
  TexelBuffer tiles;
  std::vector<PixelPlace> pixel_places;
  PixelTable fan_pixels;
  ComparedPixels ultrasound;
  Texture density, probe_lines, places, sums, grid;
  std::vector<glm::vec4> place_rows;

  int bend_samples;  // per segment of a bent line: even, so that a pair of samples lies in one
  std::vector<glm::dvec3> bend_nodes;
  std::optional<Bent> bent;
  std::span<const glm::vec3> bends;  // of the call; empty: lines are straight

  std::vector<glm::dmat4> drawn, compared;  // of the last calls
  ImageRange compared_with;                 // ultrasound images, by the last call
  std::vector<float> similar;               // for `compared`

  Buffer samples_traversed{sizeof(GLuint), nullptr};  // by the last call
  std::array<StageCount, kWeinStageCount> counts{};
};

WeinSimulator::State::State(const AcousticVolume& volume, const Probe& probe, double depth_mm,
                            const WeinSettings& wanted, const ShaderSources& given, const WorkDivision& chosen)
    : settings(wanted),
      sources(given),
      division(chosen),
      group(std::size_t(division.group)),
      lines(scan_lines(probe, depth_mm, wanted.samples)),
      row_samples(lines.samples + lines.samples % 2),
      fan(probe, depth_mm, lines, wanted.image_width, wanted.image_height),
      image_samples(lines.lines.size() * std::size_t(row_samples)),
      chunk_images(images_of_chunk(image_samples)),
      tile_words((wanted.image_width + kWordPixels - 1) / kWordPixels),
      interleaved(std::min(std::size_t(chosen.images_per_invocation), chunk_images) >= ScanStages::kInterleaved
                      ? std::optional<ScanStages>(std::in_place, given, constants(volume), ScanStages::kInterleaved,
                                                  chosen.images_per_invocation, image_samples, chunk_images)
                      : std::nullopt),
      alone(given, constants(volume), 1, chosen.images_per_invocation, image_samples, interleaved ? 1 : chunk_images),
      lc2(given, {"wein/lc2.comp"}, alone.compiled_in),
      density(density_volume(volume, wanted.reflection_length_mm)) {
  const int n = int(lines.lines.size());
  const double dr = lines.dr_mm();
  const glm::dvec3 size(volume.grid.size + 2 * kAirMargin);
  const glm::dmat4 index_from_patient = glm::inverse(volume.grid.matrix());
  for (int column = 0; column < 4; ++column)
    texture_from_patient[column] = index_from_patient[column] / glm::dvec4(size, 1);
  texture_from_patient[3] += glm::dvec4((kAirMargin + 0.5) / size, 0);  // texels' centres lie at (i + 1/2) / size

  std::vector<glm::vec4> ways;
  for (const ScanLine& line : lines.lines) {
    ways.emplace_back(line.start + (lines.r_min_mm + dr / 2) * line.direction, 0);
    ways.emplace_back(dr * line.direction, 0);
  }
  probe_lines = Texture::make_2d(GL_RGBA32F, 2, n, Filter::nearest);
  probe_lines.write(GL_RGBA, GL_FLOAT, ways.data());

  places = Texture::make_2d(GL_RGBA32F, 3, int(chunk_images), Filter::nearest);
  place_rows.resize(3 * chunk_images);

  bend_samples = 2 * ((lines.samples + 2 * kMaxBendSegments - 1) / (2 * kMaxBendSegments));
  for (int k = 0; k < lines.samples + bend_samples; k += bend_samples)
    for (int node = 0; node < kBendAcross; ++node) {
      const double across = double(node) * (n - 1) / (kBendAcross - 1), r = lines.r_min_mm + (k + 0.5) * dr;
      const int left = std::clamp(int(across), 0, std::max(n - 2, 0)), right = std::min(left + 1, n - 1);
      const auto at = [&](int line) {
        const ScanLine& of = lines.lines[std::size_t(line)];
        return of.start + r * of.direction;
      };
      bend_nodes.push_back(glm::mix(at(left), at(right), across - left));
    }

  parameters.columns = 1;
  pixel_places = places_in_scan(fan, lines, row_samples);
  fan_pixels = picture_pixels(pixel_places, wanted.image_width, wanted.image_height, group);
}

// Returns the defines that no call changes.
Defines WeinSimulator::State::constants(const AcousticVolume& volume) const {
  const double dr = lines.dr_mm();
  const glm::dvec3 sides_by_dr = glm::dvec3(volume.grid.size + 2 * kAirMargin) * volume.grid.spacing / dr;
  return {{"GROUP", std::to_string(group)},
          {"LINES", std::to_string(lines.lines.size())},
          {"SAMPLES", std::to_string(lines.samples)},
          {"ROW_SAMPLES", std::to_string(row_samples)},
          {"TILE_WORDS", std::to_string(tile_words)},
          {"TILE_HEIGHT", std::to_string(settings.image_height)},
          {"PATCHES", settings.similarity_patch > 0 ? "1" : "0"},
          {"SHADOWS", settings.shadows ? "1" : "0"},
          {"EXACT_FILTER", settings.exact_filter ? "1" : "0"},
          // Sample k lies at (k + 1/2) dr behind r_min. This is the first sample that is not nearer than the contact.
          {"FIRST_FREE_SAMPLE", literal(std::ceil((settings.contact_mm - lines.r_min_mm) / dr - 0.5))},
          {"DR_BY_LENGTH", literal(dr / settings.reflection_length_mm)},
          {"COMPRESSION", literal(settings.compression)},
          {"ONE_OVER_COMPRESSED_ONE", literal(1 / std::log1p(settings.compression))},
          {"DARK_HU", literal(settings.dark_hu)},
          {"ONE_OVER_HU_RANGE", literal(1 / (settings.bright_hu - settings.dark_hu))},
          {"REFLECTION_SHARE", literal(settings.reflection_share)},
          {"LAST_LOG_INTENSITY", literal(settings.shadows ? std::log(kMinIntensity) : -1e30)},
          {"SIDES_BY_DR",
           "vec3(" + literal(sides_by_dr.x) + ", " + literal(sides_by_dr.y) + ", " + literal(sides_by_dr.z) + ")"}};
}

// Places a chunk's lines and traverses them.
void WeinSimulator::State::traverse(std::span<const glm::dmat4> chunk, std::size_t first, const ScanStages& stages,
                                    const Program& program, const TexelBuffer& scan) {
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    const glm::dmat4 rows = glm::transpose(texture_from_patient * chunk[i]);
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
  if (!bends.empty()) place_bends(first, chunk.size());
  scan.bind_storage(0);
  samples_traversed.bind_storage(1);
  program.dispatch_groups(stages.image_groups(int(chunk.size())),
                          (int(lines.lines.size()) + int(group) - 1) / int(group));
}

// Binds the bends of a chunk's lines, in the volume's texture.
void WeinSimulator::State::place_bends(std::size_t first, std::size_t count) {
  const std::size_t nodes = bend_nodes.size();
  const glm::mat3 turned(texture_from_patient);
  for (std::size_t i = 0; i < count * nodes; ++i) bent->rows[i] = glm::vec4(turned * bends[first * nodes + i], 0);
  bent->bends.write(GL_RGBA, GL_FLOAT, bent->rows.data());
  bent->bends.bind(3);
}

void WeinSimulator::State::ran(WeinStage stage, std::size_t images, std::size_t pixels) {
  if (images == 0) return;
  StageCount& count = counts[std::size_t(stage)];
  ++count.runs;
  count.evaluated = images * pixels;
  count.possible = images * fan.inside.pixels.size();
}

template <typename Work>
void WeinSimulator::State::by_chunks(std::span<const glm::dmat4> poses, const ScanStages& stages,
                                     const Program& program, const TexelBuffer& scan, Work&& work) {
  if (poses.empty()) return;
  samples_traversed.clear();
  StageCount& count = counts[std::size_t(WeinStage::traverse)];
  ++count.runs;
  count.possible = poses.size() * lines.lines.size() * std::size_t(lines.samples);
  for (std::size_t first = 0; first < poses.size(); first += chunk_images) {
    const std::span<const glm::dmat4> chunk = poses.subspan(first, std::min(chunk_images, poses.size() - first));
    traverse(chunk, first, stages, program, scan);
    scan.bind(0);
    work(int(chunk.size()));
  }
}

WeinSimulator::WeinSimulator(const AcousticVolume& volume, const Probe& probe, double depth_mm,
                             const WeinSettings& settings, const ShaderSources& sources, const WorkDivision& division) {
  check_probe(kName, probe, depth_mm);
  if (const auto why = why_not_valid(settings)) throw std::invalid_argument(std::string(kName) + ": " + *why);
  state_ = std::make_unique<State>(volume, probe, depth_mm, settings, sources, division);
}
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
  check_poses(patient_from_probe);
  return simulate(std::span<const glm::dmat4>(matrices_of(patient_from_probe)));
}

const Texture& WeinSimulator::simulate(std::span<const glm::dmat4> patient_from_probe) {
  check_places(patient_from_probe);
  State& s = *state_;
  if (s.grid && std::ranges::equal(patient_from_probe, s.drawn)) return s.grid;
  s.drawn.clear();  // stays empty until all are drawn
  const int w = s.settings.image_width, h = s.settings.image_height;
  const int count = std::max(int(patient_from_probe.size()), 1);
  const int columns = std::clamp(int(std::lround(std::sqrt(double(count) * h / w))), 1, count);
  const int rows = (count + columns - 1) / columns;
  const int grid_width = columns * s.tile_words * kWordPixels;
  const bool fits = s.grid && s.grid.width() == grid_width && s.grid.height() == rows * h;
  if (!fits) {
    s.grid = Texture::make_2d(GL_R8, grid_width, rows * h, Filter::nearest);
    s.tiles = TexelBuffer(GL_R32UI, std::size_t(grid_width / kWordPixels) * std::size_t(rows * h));
  }
  if (!fits || count < columns * rows) s.tiles.clear();  // pixels that no fan covers stay 0
  s.parameters.columns = columns;
  const ScanStages& stages = s.stages_for(patient_from_probe.size());
  if (s.fan_pixels)
    s.by_chunks(patient_from_probe, stages, stages.traverse_grey, stages.grey_scan, [&](int images) {
      s.fan_pixels.places.bind(1);
      s.tiles.bind_storage(0);
      stages.picture.dispatch(int(s.fan_pixels.columns), stages.image_groups(images));
    });
  s.grid.write(GL_RED, GL_UNSIGNED_BYTE, s.tiles.values());
  s.ran(WeinStage::scan_convert, patient_from_probe.size(), s.fan_pixels.pixels);
  s.drawn.assign(patient_from_probe.begin(), patient_from_probe.end());
  return s.grid;
}

glm::ivec2 WeinSimulator::tile(int image) const {
  const State& s = *state_;
  return glm::ivec2(image % s.parameters.columns, image / s.parameters.columns) *
         glm::ivec2(s.tile_words * kWordPixels, s.settings.image_height);
}

void WeinSimulator::set_ultrasound(std::span<const Image<float>> images) {
  State& s = *state_;
  for (const Image<float>& image : images)
    if (image.width != s.fan.inside.width || image.height != s.fan.inside.height)
      throw std::invalid_argument(std::string(kName) +
                                  ": the ultrasound image has another size than the simulated ones");
  s.compared.clear();
  if (images.empty())
    s.ultrasound = ComparedPixels();
  else
    s.ultrasound = compared_pixels(s.pixel_places, images, s.settings.similarity_patch, s.group);
  if (s.ultrasound.table)
    s.sums = Texture::make_2d(GL_RGBA32F, 3 * int(s.ultrasound.table.columns), int(s.chunk_images), Filter::nearest);
}

const std::vector<double>& WeinSimulator::ultrasound_variation() const {
  return state_->ultrasound.variation;
}

std::vector<float> WeinSimulator::similarity(std::span<const Pose> patient_from_probe, ImageRange used) {
  check_poses(patient_from_probe);
  return similarity(std::span<const glm::dmat4>(matrices_of(patient_from_probe)), used);
}

std::vector<float> WeinSimulator::similarity(std::span<const glm::dmat4> patient_from_probe, ImageRange used) {
  check_places(patient_from_probe);
  State& s = *state_;
  std::vector<float> result(patient_from_probe.size());
  if (result.empty() || !s.ultrasound.table) return result;
  used = used.within(s.ultrasound.variation.size());
  if (used.count == 0) return result;
  if (used == s.compared_with && std::ranges::equal(patient_from_probe, s.compared)) return s.similar;
  s.parameters.first_ultrasound = int(used.first);
  s.parameters.ultrasounds = int(used.count);
  const std::size_t bytes = result.size() * sizeof(float);
  if (s.similarities_held < result.size()) {
    s.similarities = Buffer(bytes, nullptr);
    s.similarities_held = result.size();
  }
  const ScanStages& stages = s.stages_for(patient_from_probe.size());
  s.by_chunks(patient_from_probe, stages, stages.traverse_terms, stages.term_scan, [&](int images) {
    s.ultrasound.table.places.bind(1);
    s.ultrasound.values.bind(2);
    s.sums.bind_image(0, GL_WRITE_ONLY);
    stages.parts.dispatch(int(s.ultrasound.table.columns), stages.term_groups(images));
    s.similarities.bind_storage(0);
    s.sums.bind(0);
    s.lc2.dispatch(images, 1);
  });
  s.similarities.read(result.data(), bytes);
  s.ran(WeinStage::compare, result.size(), s.ultrasound.table.pixels);
  s.compared.assign(patient_from_probe.begin(), patient_from_probe.end());
  s.compared_with = used;
  s.similar = result;
  return result;
}

const std::vector<glm::dvec3>& WeinSimulator::bend_nodes() const {
  return state_->bend_nodes;
}
int WeinSimulator::patches_across() const {
  const int patch = state_->settings.similarity_patch;
  return patch > 0 ? (state_->settings.image_width + patch - 1) / patch : 1;
}
int WeinSimulator::patches_down() const {
  const int patch = state_->settings.similarity_patch;
  return patch > 0 ? (state_->settings.image_height + patch - 1) / patch : 1;
}

std::vector<float> WeinSimulator::patch_similarity(std::span<const glm::dmat4> patient_from_probe,
                                                   std::span<const glm::vec3> bends) {
  check_places(patient_from_probe);
  State& s = *state_;
  const auto refuse = [](const char* why) { throw std::invalid_argument(std::string(kName) + ": " + why); };
  if (s.settings.similarity_patch == 0) refuse("there are no patches");
  if (bends.size() != patient_from_probe.size() * s.bend_nodes.size()) refuse("there is not one bend per node");
  if (!std::ranges::all_of(bends, [](const glm::vec3& bend) { return std::isfinite(glm::dot(bend, bend)); }))
    refuse("a bend is not finite");
  const std::size_t of_image = std::size_t(patches_across()) * std::size_t(patches_down());
  std::vector<float> result(patient_from_probe.size() * of_image);
  if (result.empty() || !s.ultrasound.table) return result;
  if (!s.bent) {
    const auto traverse = [&](const ScanStages& stages) {
      Defines defines = stages.compiled_in;
      defines.emplace_back("BENT", "");
      defines.emplace_back("BEND_ACROSS", std::to_string(kBendAcross));
      defines.emplace_back("BEND_SAMPLES", std::to_string(s.bend_samples));
      return ScanStages::traverse_program(s.sources, std::move(defines), ScanStages::Leaves::terms);
    };
    Defines by_patch = s.alone.compiled_in;
    by_patch.emplace_back("BY_PATCH", "");
    s.bent.emplace();
    if (s.interleaved) s.bent->interleaved = traverse(*s.interleaved);
    s.bent->alone = traverse(s.alone);
    s.bent->lc2 = Program(s.sources, {"wein/lc2.comp"}, std::move(by_patch));
    s.bent->bends = Texture::make_2d(GL_RGBA32F, int(s.bend_nodes.size()), int(s.chunk_images), Filter::nearest);
    s.bent->rows.resize(s.bend_nodes.size() * s.chunk_images);
  }
  Bent& bent = *s.bent;
  const std::size_t columns = s.ultrasound.table.columns, count = patient_from_probe.size() * columns;
  if (bent.shares_held < count) {
    bent.shares = Buffer(count * sizeof(float), nullptr);
    bent.shares_held = count;
  }
  const ScanStages& stages = s.stages_for(patient_from_probe.size());
  s.parameters.first_ultrasound = 0;
  s.parameters.ultrasounds = int(s.ultrasound.variation.size());
  s.bends = bends;
  s.by_chunks(patient_from_probe, stages, &stages == &s.alone ? bent.alone : *bent.interleaved, stages.term_scan,
              [&](int images) {
                s.ultrasound.table.places.bind(1);
                s.ultrasound.values.bind(2);
                s.sums.bind_image(0, GL_WRITE_ONLY);
                stages.parts.dispatch(int(columns), stages.term_groups(images));
                bent.shares.bind_storage(0);
                s.sums.bind(0);
                bent.lc2.dispatch(images, 1);
              });
  s.bends = {};
  std::vector<float> shares(count);
  bent.shares.read(shares.data(), count * sizeof(float));
  for (std::size_t i = 0; i < patient_from_probe.size(); ++i)
    for (std::size_t patch = 0; patch < std::min(columns, of_image); ++patch)
      result[i * of_image + patch] = shares[i * columns + patch];
  s.ran(WeinStage::compare, patient_from_probe.size(), s.ultrasound.table.pixels);
  return result;
}

StageCount WeinSimulator::count(WeinStage stage) const {
  StageCount count = state_->counts[std::size_t(stage)];
  if (stage != WeinStage::traverse || count.runs == 0) return count;
  GLuint traversed = 0;
  state_->samples_traversed.read(&traversed, sizeof traversed);
  count.evaluated = traversed;
  return count;
}

WeinStages<float> WeinSimulator::read_stages(const Pose& patient_from_probe) {
  State& s = *state_;
  simulate(std::span<const Pose>(&patient_from_probe, 1));
  const int n = int(s.lines.lines.size()), d = s.lines.samples;
  Texture intensities = Texture::make_2d(GL_R32F, d, n, Filter::nearest);
  intensities.clear();  // the traversal does not write behind a line's end
  intensities.bind_image(1, GL_WRITE_ONLY);
  s.samples_traversed.clear();
  const glm::dmat4 matrix = patient_from_probe.matrix();
  s.traverse({&matrix, 1}, 0, s.alone,
             ScanStages::traverse_program(s.sources, s.alone.compiled_in, ScanStages::Leaves::intensity),
             s.alone.term_scan);
  const std::size_t count = std::size_t(n) * std::size_t(d), row = std::size_t(s.row_samples);
  std::vector<std::array<std::uint16_t, 2>> terms(std::size_t(n) * row);
  s.alone.term_scan.read(terms.data(), terms.size() * sizeof terms.front());
  std::vector<float> intensity(count);
  intensities.read(GL_RED, GL_FLOAT, intensity.data(), count * sizeof(float));
  WeinStages<float> stages;
  stages.intensity = stages.scan_echogenicity = stages.scan_reflection = Image<float>(n, d);
  for (int line = 0; line < n; ++line)
    for (int k = 0; k < d; ++k) {
      const auto& both = terms[std::size_t(line) * row + std::size_t(k)];
      stages.scan_echogenicity.at(line, k) = float(both[0]) / 65535;
      stages.scan_reflection.at(line, k) = float(both[1]) / 65535;
      stages.intensity.at(line, k) = intensity[std::size_t(line) * std::size_t(d) + std::size_t(k)];
    }
  stages.grey = Image<std::uint8_t>(s.settings.image_width, s.settings.image_height);
  Image<std::uint8_t> tile(s.grid.width(), s.grid.height());
  s.grid.read(GL_RED, GL_UNSIGNED_BYTE, tile.pixels.data(), tile.pixels.size());
  for (int y = 0; y < stages.grey.height; ++y)
    for (int x = 0; x < stages.grey.width; ++x) stages.grey.at(x, y) = tile.at(x, y);
  return stages;
}

}  // namespace insonate::gl
