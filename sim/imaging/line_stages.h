#pragma once

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <span>
#include <vector>

#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/streamed_buffer.h"
#include "sim/gl/work_division.h"
#include "sim/imaging/device_volume.h"
#include "sim/imaging/scatterer_stage.h"
#include "sim/model/settings.h"
#include "sim/model/stored_speckle.h"
#include "sim/probe/probe.h"

namespace insonate::gl {

struct PlacedLine;

/// What the traversal did, modulo 2^32. A line ends where it has lost its energy; a line that does not meet the body
/// does not start. Where a work group traverses a line, it ends with the stretch in which the energy is lost. The
/// remaining samples of that stretch count too, because they were computed.
struct SampleCounts {
  std::uint32_t traversed = 0;  ///< samples traversed, of slice planes x lines x samples
  std::uint32_t normals = 0;    ///< of these, samples with a normal; edge shadows sample around all of them
};

/// Runs the stages of model S that depend on scan lines alone: traversal, and the beam with reverberation and clutter.
/// They run on the lines of one plane, for a picture, or of several planes, for a volume. Each plane has its own pose.
///
/// Their results have one row per line, plane by plane, in one buffer. A near-square texture of the same capacity is
/// slower to store to (see TexelBuffer), and no device needs it where work groups are laid out in rows.
///
/// They read the block of parameters (sim/shaders/shared/simulation_parameters.h). The caller binds it as uniform block
/// 0 before each stage, with the number of planes. Each stage builds its shaders when it runs, for the settings that it
/// is given, and throws std::runtime_error if one does not compile.
class LineStages {
public:
  LineStages(const ShaderSources& sources, const WorkDivision& division);

  /// Allocates the buffers. Throws DeviceRefused.
  /// @param of_plane     in the plane's own frame, the same for all planes
  /// @param most_planes  traversed together, 1 or more
  void lay_out(const ScanLines& of_plane, int most_planes, const Settings& settings);
  /// Takes other lines of the same number and samples, such as steered ones.
  void turn(const ScanLines& of_plane);
  /// Samples a scattering volume (sim/model/stored_speckle.h) instead of the scatterers' lattice, or the lattice again.
  /// Throws TextureRefused.
  void store_speckle(const StoredSpeckle* speckle);
  /// Notes that something changed on which the beam's windows depend; lay_out() implies it.
  void change_beam() { beam_changed_ = true; }

  /// Sets the counts of samples to 0.
  void restart_counts() { counters_.clear(); }
  /// Places the lines and traverses them.
  /// @param patient_from_plane  1 to most_planes poses
  void traverse(const DeviceVolume& volume, std::span<const Pose> patient_from_plane, const Settings& settings);
  /// Runs the beam's stages. Call it after traverse(), with settings that differ at most in what the traversal ignores.
  void beam(const Settings& settings);

  const ScanLines& lines() const { return lines_; }  ///< per plane
  /// By sample: I, R, scatterers' echo (re, im); with waves I, scattered power, e (re, im), see sim/model/stages.h.
  const TexelBuffer& scan() const { return scan_; }
  /// By sample: R, T, S, V; with waves f (re, im), I^2, V.
  const TexelBuffer& echoes() const { return echoes_; }
  /// By plane and depth: mean of T S, with waves of the scattered power, with its tail; H and H/J (noise.h), 0 without
  /// waves. Only with clutter.
  const TexelBuffer& mean_echo() const { return mean_echo_; }
  /// Returns the counts since restart_counts(). Blocks until the device has finished.
  SampleCounts sample_counts() const;

  /// For Program::reload().
  std::vector<Program*> programs();

private:
  void prepare_lattice(const Settings& settings);
  void prepare_beam(const Settings& settings);
  std::size_t set_lines() const;
  bool group_per_line() const;
  std::size_t most_samples() const;
  void walk(std::size_t lines, const std::vector<PlacedLine>& placed, StreamedBuffer& line_buffer,
            const TexelBuffer& scan, const Buffer& counters);
  std::size_t groups_of(std::size_t lines) const;  // where one invocation takes one line, or part of one
  void dispatch(const Program& program, std::size_t groups) const;

  WorkDivision division_;
  Program traverse_, mirror_image_, reverberation_, beam_, pulse_, wave_beam_, clutter_, clutter_tail_, wall_clutter_;
  ScattererStage scatterers_;

  ScanLines lines_;
  int most_planes_ = 1, planes_ = 1;  // planes_: of the last traversal
  bool is_stored(const Settings& settings) const { return stored_ && settings.speckle && !settings.waves; }

  Texture lattice_, stored_;
  glm::dmat4 stored_from_patient_{1.0};  // in the texture's coordinates
  std::uint32_t lattice_seed_ = 0;       // of lattice_
  StreamedBuffer line_buffer_, air_line_buffer_;
  Buffer beam_window_;
  TexelBuffer beam_at_depth_;
  bool beam_changed_ = true;

  TexelBuffer in_air_;  // by sample, as scan(): of a line that does not meet the body
  TexelBuffer scan_, middle_, repeats_, pulsed_, echoes_, mean_echo_, layer_echo_;
  Buffer counters_{sizeof(SampleCounts), nullptr}, uncounted_{sizeof(SampleCounts), nullptr};
};

}  // namespace insonate::gl
