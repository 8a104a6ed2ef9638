#include "sim/imaging/line_stages.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/imaging/stage_tables.h"
#include "sim/model/beam.h"
#include "sim/model/scatterers.h"
#include "sim/model/waves.h"

namespace insonate::gl {
namespace {

// So many samples of a line are an invocation's (mirror_image.comp): fewer would find the line's gas more often, more
// could take a software renderer beyond the steps that it grants to all loops of an invocation, 65536.
constexpr int kMirrorPart = 256;

// Adds what all stages are compiled for to the defines of one.
Defines with(const WorkDivision& division, Defines defines = {}) {
  defines.emplace_back("GROUP", std::to_string(division.group));
  return defines;
}

Defines traversal(const Settings& settings, double dr_mm, bool group_per_line, bool is_stored) {
  const double samples_per_length = settings.reflection_length_mm / dr_mm;
  const auto is = [&](double whole) { return std::abs(samples_per_length - whole) < 1e-9; };
  return {{"GROUP_PER_LINE", flag(group_per_line)},
          {"EDGES_AT", group_per_line ? "kEdgesAnywhere"  // each sample fetches its own ends
                       : is(2)        ? "kEdgesAtSamples"
                       : is(1)        ? "kEdgesAtMiddles"
                                      : "kEdgesAnywhere"},
          {"ABSORPTION", flag(settings.absorption)},
          {"SPECKLE", flag(settings.speckle)},
          {"STORED_SPECKLE", flag(is_stored)},
          {"WAVES", flag(settings.waves)},
          {"TWO_WAY", flag(settings.two_way)},
          {"EDGE_SHADOW", flag(settings.edge_shadow)},
          {"EXACT_FILTER", flag(settings.exact_filter)},
          {"SKIPPING", flag(settings.skipping)},
          {"ELEVATION_FOCUS", flag(has_elevation_focus(settings))},
          {"SLICE_PLANES", std::to_string(settings.slice_planes)},
          {"KEEP_MIDDLE", flag(keeps_middle_plane(settings))}};
}

Defines reverberation_of(const Settings& settings) {
  return {{"IN_TISSUE", flag(settings.reverberation)}, {"AT_FACE", flag(settings.face_reflection > 0)}};
}

Defines pulse_of(int radius) {
  return {{"PULSE_RADIUS", std::to_string(radius)}};
}

Defines clutter_of(const Settings& settings) {
  return {{"WAVES", flag(settings.waves)}};
}

Defines beam_of(const Settings& settings, bool is_stored = false) {
  return {{"STORED_SPECKLE", flag(is_stored)},
          {"FOCUSED_BEAM", flag(settings.focused_beam)},
          {"BEAM_HALF", settings.focused_beam ? "0" : std::to_string(settings.beam_lines / 2)},
          {"REVERBERATION", flag(reverberates(settings))}};
}

}  // namespace

LineStages::LineStages(const ShaderSources& sources, const WorkDivision& division)
    : division_(division),
      traverse_(sources, {"imaging/traverse.comp"},
                with(division, traversal({}, 1, division.lines_that_fill > 0, false))),
      mirror_image_(sources, {"imaging/mirror_image.comp"}, with(division, {{"PART", std::to_string(kMirrorPart)}})),
      reverberation_(sources, {"imaging/reverberation.comp"}, with(division, reverberation_of({}))),
      beam_(sources, {"imaging/beam.comp"}, with(division, beam_of({}))),
      pulse_(sources, {"imaging/pulse.comp"}, pulse_of(1)),
      wave_beam_(sources, {"imaging/wave_beam.comp"}, beam_of({})),
      clutter_(sources, {"imaging/clutter.comp"}, with(division, clutter_of({}))),
      clutter_tail_(sources, {"imaging/clutter_tail.comp"}),
      wall_clutter_(sources, {"imaging/wall_clutter.comp"}, with(division)),
      scatterers_(sources, division) {}

void LineStages::lay_out(const ScanLines& of_plane, int most_planes, const Settings& settings) {
  lines_ = of_plane;
  most_planes_ = most_planes;
  const std::size_t n = std::size_t(most_planes) * lines_.lines.size(), d = std::size_t(lines_.samples);
  in_air_.resize(GL_RGBA32F, d);
  scan_.resize(GL_RGBA32F, n * d);
  middle_ = TexelBuffer();
  echoes_.resize(GL_RGBA32F, n * d);
  pulsed_ = TexelBuffer();
  repeats_ = TexelBuffer();
  if (settings.waves) scatterers_.lay_out(lines_, most_planes);
  mean_echo_.resize(GL_RGBA32F, std::size_t(most_planes) * d);
  layer_echo_.resize(GL_R32F, std::size_t(most_planes) * d);
  beam_changed_ = true;
}

void LineStages::turn(const ScanLines& of_plane) {
  lines_ = of_plane;
  scatterers_.turn(lines_);
  beam_changed_ = true;
}

void LineStages::store_speckle(const StoredSpeckle* speckle) {
  stored_ = Texture();
  if (!speckle) return;
  const glm::ivec3 size = speckle->grid.size + 2;  // with a margin of 0
  Texture texture = Texture::make_3d(GL_R32F, size.x, size.y, size.z, Filter::linear, Wrap::edge);
  texture.write_inside(GL_RED, GL_FLOAT, speckle->voxels.data(), 0.0f);
  stored_ = std::move(texture);
  const glm::dmat4 texture_from_index =
      glm::translate(glm::scale(glm::dmat4(1.0), 1.0 / glm::dvec3(size)), glm::dvec3(1.5));
  stored_from_patient_ = texture_from_index * glm::inverse(speckle->grid.matrix());
}

void LineStages::prepare_lattice(const Settings& settings) {
  if (lattice_ && lattice_seed_ == settings.speckle_seed) return;
  constexpr int side = ScattererLattice::kSide;
  lattice_ = Texture::make_3d(GL_RG16_SNORM, side, side, side, Filter::linear, Wrap::repeat);
  lattice_.write(GL_RG, GL_SHORT, make_scatterers(settings.speckle_seed).stored.data());
  lattice_seed_ = settings.speckle_seed;
}

std::size_t LineStages::set_lines() const {
  return std::size_t(planes_) * lines_.lines.size();
}

bool LineStages::group_per_line() const {
  // For a sweep in parts, the answer is the same for each part.
  return std::size_t(most_planes_) * lines_.lines.size() < division_.lines_that_fill;
}

std::size_t LineStages::groups_of(std::size_t lines) const {
  const std::size_t group = std::size_t(division_.group);
  return (lines + group - 1) / group;
}

std::size_t LineStages::most_samples() const {
  return std::size_t(most_planes_) * lines_.lines.size() * std::size_t(lines_.samples);
}

void LineStages::traverse(const DeviceVolume& volume, std::span<const Pose> patient_from_plane,
                          const Settings& settings) {
  planes_ = int(patient_from_plane.size());
  traverse_.define(with(division_, traversal(settings, lines_.dr_mm(), group_per_line(), is_stored(settings))));
  if (settings.speckle && settings.waves) {
    scatterers_.place(patient_from_plane, settings);
    scatterers_.scattered().bind(3);
    scatterers_.scale().bind(4);
  } else if (is_stored(settings)) {
    stored_.bind(1);
  } else if (settings.speckle) {
    prepare_lattice(settings);
    lattice_.bind(1);
  }
  if (keeps_middle_plane(settings) && !middle_) middle_ = TexelBuffer(GL_RG32F, most_samples());
  volume.texture().bind(0);
  volume.tissue_lookup().bind(7);
  if (keeps_middle_plane(settings)) middle_.bind_storage(3);  // the results of the line in air are overwritten

  std::vector<PlacedLine> placed;
  for (const Pose& pose : patient_from_plane) {
    const std::vector<PlacedLine> of_plane =
        placed_lines(volume, pose, lines_, settings, is_stored(settings) ? &stored_from_patient_ : nullptr);
    placed.insert(placed.end(), of_plane.begin(), of_plane.end());
  }
  if (std::ranges::any_of(placed, meets_no_body)) walk(1, line_in_air(settings), air_line_buffer_, in_air_, uncounted_);
  in_air_.bind(2);
  walk(set_lines(), placed, line_buffer_, scan_, counters_);
  if (!mirrors(settings)) return;
  middle_.bind(0);
  const int parts = (lines_.samples + kMirrorPart - 1) / kMirrorPart;
  dispatch(mirror_image_, groups_of(set_lines() * std::size_t(parts)));
}

void LineStages::walk(std::size_t lines, const std::vector<PlacedLine>& placed, StreamedBuffer& line_buffer,
                      const TexelBuffer& scan, const Buffer& counters) {
  line_buffer.write(placed.data(), placed.size() * sizeof(PlacedLine));
  line_buffer.bind_storage(0);
  scan.bind_storage(1);
  counters.bind_storage(2);
  dispatch(traverse_, group_per_line() ? lines : groups_of(lines));
}

// In rows, because one row of work groups need not hold all lines.
void LineStages::dispatch(const Program& program, std::size_t groups) const {
  const glm::ivec2 in_rows = division_.in_rows(groups);
  program.dispatch_groups(in_rows.x, in_rows.y);
}

void LineStages::prepare_beam(const Settings& settings) {
  if (reverberates(settings)) reverberation_.define(with(division_, reverberation_of(settings)));
  if (settings.waves) {
    pulse_.define(pulse_of(int(pulse_weights(lines_, settings).size() / 2)));
    wave_beam_.define(beam_of(settings));
    if (!pulsed_) pulsed_ = TexelBuffer(GL_RG32F, most_samples());
  } else {
    beam_.define(with(division_, beam_of(settings, is_stored(settings))));
  }
  clutter_.define(with(division_, clutter_of(settings)));
  if (!beam_changed_) return;
  if (reverberates(settings) && !repeats_) repeats_ = TexelBuffer(GL_R32F, most_samples());
  beam_window_ = half_beam_window(settings);
  beam_at_depth_ = beam_by_depth(lines_, settings);
  beam_changed_ = false;
}

void LineStages::beam(const Settings& settings) {
  prepare_beam(settings);
  if (reverberates(settings)) {
    (keeps_middle_plane(settings) ? middle_ : scan_).bind(0);
    repeats_.clear();
    repeats_.bind_storage(0);
    dispatch(reverberation_, groups_of(set_lines()));
    repeats_.bind(2);
  }
  scan_.bind(0);
  scan_.bind(3);
  beam_window_.bind_uniform(1);
  beam_at_depth_.bind(1);
  const glm::ivec2 in_fours(lines_.samples, (int(lines_.lines.size()) + 3) / 4);
  if (settings.waves) {
    pulsed_.bind_storage(0);
    pulse_.dispatch((lines_.samples + 3) / 4, int(set_lines()));
    pulsed_.bind(0);
    echoes_.bind_storage(0);
    wave_beam_.dispatch(in_fours.x, in_fours.y, planes_);
  } else {
    echoes_.bind_storage(0);
    beam_.dispatch(in_fours.x, in_fours.y, planes_);
  }
  if (!settings.clutter) return;
  echoes_.bind(0);
  scan_.bind(1);
  mean_echo_.bind_storage(0);
  layer_echo_.bind_storage(1);
  clutter_.dispatch(lines_.samples, planes_);
  clutter_tail_.dispatch(planes_, 1);
  if (!settings.waves) return;
  layer_echo_.bind(0);
  wall_clutter_.dispatch(lines_.samples, planes_);
}

SampleCounts LineStages::sample_counts() const {
  SampleCounts counts;
  counters_.read(&counts, sizeof counts);
  return counts;
}

std::vector<Program*> LineStages::programs() {
  return {&traverse_,  &mirror_image_, &reverberation_, &beam_,         &pulse_,
          &wave_beam_, &clutter_,      &clutter_tail_,  &wall_clutter_, &scatterers_.program()};
}

}  // namespace insonate::gl
