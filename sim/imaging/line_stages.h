#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/imaging/device_volume.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate::gl {

struct PlacedLine;

/// What the traversal did, modulo 2^32. A line ends where it has lost its energy; one that meets no body does not
/// start. Where a work group walks along a line, it ends with the stretch of it in which the energy is lost, and the
/// samples of that stretch behind count too: they were worked out.
struct SampleCounts {
  std::uint32_t walked = 0;   ///< samples, of planes x lines x samples
  std::uint32_t normals = 0;  ///< of these, with the normal worked out; edge shadows look around all of them
};

/// The stages of model S that know scan lines and neither pictures nor volumes: traversal, and the beam with all that
/// hangs on it, reverberation and clutter. They run on the lines of one plane, for a picture, or of a set of planes,
/// for a volume, each of them where its own pose says.
///
/// What they hand on has a row a line, plane by plane, in one buffer: a texture near square, which would hold as many,
/// is slower to store to (see TexelBuffer), and no device needs it where work groups go in rows.
///
/// They read the block of parameters (sim/shaders/shared/simulation_parameters.h), which whoever runs them binds as
/// uniform block 0 before, with the number of planes. Each builds its shaders when it runs, for the settings it is
/// given; throws std::runtime_error when one does not build.
class LineStages {
public:
  LineStages(const ShaderSources& sources, const WorkDivision& division);

  /// Allocates. Throws DeviceRefused.
  /// @param of_plane     in the plane's own frame, the same for all
  /// @param most_planes  together, 1 or more
  void lay_out(const ScanLines& of_plane, int most_planes, const Settings& settings);
  /// Notes that something changed that the beam's windows hang on; a new layout does so by itself.
  void change_beam() { beam_changed_ = true; }

  /// Counts samples anew.
  void restart_counts() { counters_.clear(); }
  /// Places the lines and walks along them.
  /// @param patient_from_plane  1 to most_planes
  void traverse(const DeviceVolume& volume, std::span<const Pose> patient_from_plane, const Settings& settings);
  /// Behind traverse() with the same settings, but for those that reach no further back than here.
  void beam(const Settings& settings);

  const ScanLines& lines() const { return lines_; }      ///< of a plane
  const TexelBuffer& scan() const { return scan_; }      ///< by sample: I, R, scatterers' echo (re, im)
  const TexelBuffer& echoes() const { return echoes_; }  ///< by sample: R, T, S, V
  /// By plane and depth: mean of T S with its tail, with clutter.
  const TexelBuffer& mean_echo() const { return mean_echo_; }
  /// Waits for the device.
  SampleCounts sample_counts() const;

  /// For Program::reload().
  std::vector<Program*> programs();

private:
  void prepare_scatterers(const Settings& settings);
  void prepare_beam(const Settings& settings);
  std::size_t set_lines() const;
  bool group_a_line() const;
  std::size_t most_samples() const;
  void walk(std::size_t lines, const std::vector<PlacedLine>& placed, Buffer& line_buffer, const TexelBuffer& scan,
            const Buffer& counters);
  std::size_t groups_of(std::size_t lines) const;  // where an invocation takes a line
  void dispatch(const Program& program, std::size_t groups) const;

  WorkDivision division_;
  Program traverse_, reverberation_, beam_, clutter_, clutter_tail_;

  ScanLines lines_;
  int most_planes_ = 1, planes_ = 1;  // of the last traversal
  Texture scatterers_;
  std::uint32_t scatterers_seed_ = 0;  // of those there are
  Buffer line_buffer_, air_line_buffer_, beam_window_;
  TexelBuffer beam_at_depth_;
  bool beam_changed_ = true;

  TexelBuffer in_air_;  // by sample, as scan(): of a line that meets no body
  TexelBuffer scan_, middle_, repeats_, echoes_, mean_echo_;
  Buffer counters_{sizeof(SampleCounts), nullptr}, uncounted_{sizeof(SampleCounts), nullptr};
};

}  // namespace insonate::gl
