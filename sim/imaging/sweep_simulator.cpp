#include "sim/imaging/sweep_simulator.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "sim/gl/streamed_buffer.h"
#include "sim/imaging/device_volume.h"
#include "sim/imaging/dirty_stages.h"
#include "sim/imaging/line_stages.h"
#include "sim/imaging/stage_tables.h"
#include "sim/imaging/sweep_conversion.h"
#include "sim/imaging/view_limits.h"
#include "sim/model/noise.h"
#include "sim/model/settings_file.h"
#include "sim/shaders/shared/simulation_parameters.h"

namespace insonate::gl {
namespace {

using Part = SweepConversion::Part;

constexpr std::size_t kGroupVoxels = 4 * 64;  // per work group of sweep_compress.comp

// Returns parts of as many planes as a buffer has room for, both as samples and as placed lines. A part has at least
// two planes, because voxels lie between planes.
std::vector<Part> parts_of(const Sweep& sweep, const Settings& settings, const WorkDivision& division) {
  const int planes = int(sweep.patient_from_plane.size());
  const std::size_t placed = std::size_t(settings.slice_planes) * sizeof(PlacedLine) / (4 * sizeof(float));
  const std::size_t plane = std::size_t(sweep.probe.lines) * std::max(std::size_t(settings.samples), placed);
  const int most = int(std::clamp<std::size_t>(division.most_texels / plane, 2, std::size_t(planes)));
  std::vector<Part> parts;
  for (int first = 0; first + 1 < planes; first += most - 1) parts.push_back({first, std::min(most, planes - first)});
  return parts;
}

Defines fusion(const Settings& settings) {
  return {{"NOISE", flag(is_noisy(settings))}, {"CLUTTER", flag(settings.clutter)}, {"WAVES", flag(settings.waves)}};
}

Defines display(const Settings& settings, bool finds_maximum) {
  return {{"FIND_MAXIMUM", finds_maximum ? "1" : "0"},
          {"FRAME_MAXIMUM", settings.reference_level == ReferenceLevel::frame_maximum ? "1" : "0"},
          {"TIME_GAIN", has_time_gain(settings) ? "1" : "0"},
          {"GREY_MAP", std::to_string(int(settings.grey_map))}};
}

}  // namespace

struct SweepSimulator::State {
  State(const ShaderSources& given, const WorkDivision& of_device)
      : division(of_device),
        line_stages(given, of_device),
        conversion(given, of_device),
        fuse(given, {"imaging/sweep_fuse.comp"}, fusion({})),
        maximum(given, {"imaging/sweep_compress.comp"}, display({}, true)),
        compress(given, {"imaging/sweep_compress.comp"}, display({}, false)) {}

  const WorkDivision division;
  LineStages line_stages;
  SweepConversion conversion;
  Program fuse, maximum, compress;

  // Inputs from the caller.
  Settings settings;
  Sweep sweep;
  Grid grid;
  DeviceVolume volume;

  // Derived from these, and results of the stages.
  std::vector<Part> parts;
  StreamedBuffer parameter_buffer;
  TexelBuffer noise;           // by sample of a plane
  double noise_length_mm = 0;  // grain of the noise
  TexelBuffer fused;           // by sample of a part
  Buffer maximum_buffer{sizeof(GLuint), nullptr};
  Buffer packed;  // voxels of one slab
  Texture grey;

  bool lines_changed = true, grid_changed = true;  // in number
  std::optional<SweepStage> first_outdated = SweepStage::traverse;
  std::array<long, kSweepStageCount> runs{};
  std::uint64_t samples = 0, slice_samples = 0, voxels = 0;  // of the last run

  bool is_whole() const { return !sweep.patient_from_plane.empty() && grid.count() > 0 && volume; }
  bool needed(SweepStage stage) const {
    return stage != SweepStage::maximum || settings.reference_level == ReferenceLevel::frame_maximum;
  }
  std::size_t voxels_of(const SweepConversion::Slab& slab) const {
    return std::size_t(grid.size.x) * std::size_t(grid.size.y) * std::size_t(slab.slices);
  }
  void invalidate_from(SweepStage stage) { first_outdated = std::min(first_outdated.value_or(stage), stage); }

  void lay_out();
  void prepare();
  void write_parameters(const Part& part);
  void run_part(const Part& part, SweepStage first);
  template <typename Work>
  void for_each_slab(const Program& program, Work&& then);
  void count_what_ran(SweepStage first);
  void run();
};

void SweepSimulator::State::lay_out() {
  if (lines_changed) {
    parts = parts_of(sweep, settings, division);
    const int most = parts.front().planes;
    line_stages.lay_out(scan_lines(sweep.probe, sweep.depth_mm, settings.samples), most, settings);
    fused = TexelBuffer(GL_R32F, std::size_t(most) * std::size_t(sweep.probe.lines) * std::size_t(settings.samples));
    noise = TexelBuffer();
    lines_changed = false;
  }
  conversion.lay_out(grid);
  if (grid_changed) {
    grey = Texture::make_3d(GL_RG8, grid.size.x, grid.size.y, grid.size.z, Filter::linear, Wrap::edge);
    packed = Buffer((voxels_of(conversion.slabs().front()) + 3) / 4 * 8, nullptr);  // 2 bytes per voxel, in fours
    grid_changed = false;
  }
}

// Prepares everything that the outdated stages read and that is not the result of another stage.
void SweepSimulator::State::prepare() {
  lay_out();
  if (is_noisy(settings) && (!noise || noise_length_mm != settings.reflection_length_mm)) {
    noise = settings.waves ? noise_waves_of_lines(line_stages.lines(), settings)
                           : noise_of_lines(line_stages.lines(), settings);
    noise_length_mm = settings.reflection_length_mm;
  }
  fuse.define(fusion(settings));
  if (needed(SweepStage::maximum)) maximum.define(display(settings, true));
  compress.define(display(settings, false));
}

void SweepSimulator::State::write_parameters(const Part& part) {
  SimulationParameters parameters = parameters_of(settings, line_stages.lines(), {}, {});
  parameters.planes = part.planes;
  parameters.first_plane = part.first;
  parameters.noise_step = noise_step(sweep.probe.lines);
  parameter_buffer.write(&parameters, sizeof parameters);
  parameter_buffer.bind_uniform(0);
}

void SweepSimulator::State::run_part(const Part& part, SweepStage first) {
  write_parameters(part);
  if (first <= SweepStage::traverse)
    line_stages.traverse(volume,
                         std::span(sweep.patient_from_plane).subspan(std::size_t(part.first), std::size_t(part.planes)),
                         settings);
  if (first <= SweepStage::beam) line_stages.beam(settings);
  if (first <= SweepStage::fuse) {
    line_stages.echoes().bind(0);
    noise.bind(1);
    line_stages.mean_echo().bind(2);
    fused.bind_storage(0);
    fuse.dispatch(settings.samples, sweep.probe.lines, part.planes);
  }
  conversion.convert(sweep, part, fused, settings.samples);
}

template <typename Work>
void SweepSimulator::State::for_each_slab(const Program& program, Work&& then) {
  maximum_buffer.bind_storage(0);
  packed.bind_storage(1);
  for (const SweepConversion::Slab& slab : conversion.slabs()) {
    slab.voxels.bind(0);
    const glm::ivec2 groups = division.in_rows((voxels_of(slab) + kGroupVoxels - 1) / kGroupVoxels);
    program.dispatch_groups(groups.x, groups.y);
    then(slab);
  }
}

void SweepSimulator::State::run() {
  if (!first_outdated || !is_whole()) return;
  prepare();
  SweepStage first = *first_outdated;
  if (first < SweepStage::maximum) {
    if (parts.size() > 1) first = SweepStage::traverse;  // the lines' stages keep only the last part
    if (first == SweepStage::traverse) line_stages.restart_counts();
    for (const Part& part : parts) run_part(part, first);
  } else {
    write_parameters(parts.front());
  }
  if (needed(SweepStage::maximum) && first <= SweepStage::maximum) {
    maximum_buffer.clear();
    for_each_slab(maximum, [](const auto&) {});
  }
  for_each_slab(compress, [&](const SweepConversion::Slab& slab) {
    grey.write_slices(GL_RG, GL_UNSIGNED_BYTE, slab.first_slice, slab.slices, packed);
  });
  count_what_ran(first);
  for (int stage = int(first); stage < kSweepStageCount; ++stage)
    if (needed(SweepStage(stage))) ++runs[std::size_t(stage)];
  first_outdated.reset();
}

void SweepSimulator::State::count_what_ran(SweepStage first) {
  voxels = grid.count();
  if (first > SweepStage::fuse) return;
  samples = 0;
  for (const Part& part : parts)
    samples += std::uint64_t(part.planes) * std::uint64_t(sweep.probe.lines) * std::uint64_t(settings.samples);
  if (first == SweepStage::traverse) slice_samples = samples * std::uint64_t(settings.slice_planes);
}

SweepSimulator::SweepSimulator(const ShaderSources& sources, const WorkDivision& division)
    : state_(std::make_unique<State>(sources, division)) {}
SweepSimulator::~SweepSimulator() = default;
SweepSimulator::SweepSimulator(SweepSimulator&&) noexcept = default;
SweepSimulator& SweepSimulator::operator=(SweepSimulator&&) noexcept = default;

void SweepSimulator::set_volume(const AcousticVolume& volume, const TissueTable& table) {
  state_->volume = DeviceVolume(volume, table);
  state_->invalidate_from(SweepStage::traverse);
}

void SweepSimulator::set_sweep(const Sweep& sweep) {
  const Sweep& before = state_->sweep;
  if (sweep == before) return;
  if (sweep.patient_from_plane.size() < 2) throw std::invalid_argument("sweep simulator: fewer than two planes");
  check_probe("sweep simulator", sweep.probe, sweep.depth_mm);
  for (const Pose& pose : sweep.patient_from_plane) check_pose("sweep simulator", pose);
  state_->lines_changed |= sweep.probe != before.probe || sweep.depth_mm != before.depth_mm ||
                           sweep.patient_from_plane.size() != before.patient_from_plane.size();
  state_->sweep = sweep;
  state_->invalidate_from(SweepStage::traverse);
}

void SweepSimulator::set_grid(const Grid& grid) {
  if (grid == state_->grid) return;
  state_->grid_changed |= grid.size != state_->grid.size;
  state_->grid = grid;
  state_->invalidate_from(SweepStage::scan_convert);
}

void SweepSimulator::set_settings(const Settings& settings) {
  if (settings == state_->settings) return;
  if (const auto why = why_not_valid(settings)) throw std::invalid_argument("sweep simulator: " + *why);
  const DirtySweepStages dirty = dirty_sweep_stages(state_->settings, settings);
  state_->lines_changed |= dirty.layout;
  if (dirty.beam) state_->line_stages.change_beam();
  if (dirty.first) state_->invalidate_from(*dirty.first);
  state_->settings = settings;
}

const Texture& SweepSimulator::volume() {
  state_->run();
  return state_->grey;
}

Volume<std::int16_t> SweepSimulator::read_grey() {
  const Texture& texture = volume();
  Volume<std::int16_t> read{state_->grid, {}};
  std::vector<std::array<std::uint8_t, 2>> voxels(read.grid.count());
  texture.read(GL_RG, GL_UNSIGNED_BYTE, voxels.data(), voxels.size() * sizeof voxels[0]);
  read.voxels.reserve(voxels.size());
  for (const auto& [grey, inside] : voxels) read.voxels.push_back(inside ? grey : std::int16_t(-1));
  return read;
}

Volume<float> SweepSimulator::read_fused() {
  volume();
  return state_->conversion.read();
}

const std::array<long, kSweepStageCount>& SweepSimulator::runs() const {
  return state_->runs;
}

StageCount SweepSimulator::count(SweepStage stage) const {
  const State& s = *state_;
  StageCount count{s.runs[std::size_t(stage)]};
  if (count.runs == 0) return count;
  count.possible = stage >= SweepStage::scan_convert ? s.voxels
                   : stage == SweepStage::traverse   ? s.slice_samples
                                                     : s.samples;
  count.evaluated = stage == SweepStage::traverse ? s.line_stages.sample_counts().traversed : count.possible;
  return count;
}

std::optional<std::string> SweepSimulator::reload(const ShaderSources& sources) {
  State& s = *state_;
  std::vector<Program*> programs = s.line_stages.programs();
  for (Program* program : {&s.conversion.program(), &s.fuse, &s.maximum, &s.compress}) programs.push_back(program);
  const std::optional<std::string> problem = Program::reload(programs, sources);
  if (!problem) s.invalidate_from(SweepStage::traverse);
  return problem;
}

}  // namespace insonate::gl
