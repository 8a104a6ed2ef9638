#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/imaging/stage.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/settings.h"
#include "sim/model/tissue.h"
#include "sim/probe/sweep.h"

namespace insonate::gl {

/// Model S of a 3D probe, or of a 2D probe moved by hand, on the graphics card: a volume, the planes of a sweep and
/// settings in, a volume of grey levels out.
///
/// The lines of all planes are one set: each stage runs once on all of them. Planes are worked through in parts only
/// where a buffer cannot hold them all (WorkDivision::most_texels); then what comes before scan conversion is not kept.
/// Of the settings, the picture's size and its smoothing (reflection_sigma_mm, transmission_sigma_mm) are not used.
///
/// Setters only note what changed; volume() runs the first stage that a change reaches and those behind it, and nothing
/// when nothing changed. Needs an OpenGL 4.5 context, current whenever it is used, from construction to destruction.
/// Throws std::runtime_error when shaders do not build, DeviceRefused when the device cannot hold what it is asked to.
class SweepSimulator {
public:
  explicit SweepSimulator(const ShaderSources& sources = {}, const WorkDivision& division = WorkDivision::of_device());
  ~SweepSimulator();
  SweepSimulator(SweepSimulator&&) noexcept;
  SweepSimulator& operator=(SweepSimulator&&) noexcept;

  void set_volume(const AcousticVolume& volume, const TissueTable& table);
  /// Throws std::invalid_argument on fewer than two planes, and on poses, a probe or a depth that check_pose() and
  /// check_probe() (sim/imaging/view_limits.h) find fault with; the sweep before stays.
  void set_sweep(const Sweep& sweep);
  /// @param grid  where the voxels lie in the patient, such as sweep_grid() (sim/probe/sweep.h) gives: sizes of 1 or
  ///              more and spacings above 0, which are not checked; too many voxels are refused by volume()
  void set_grid(const Grid& grid);
  /// Throws std::invalid_argument on settings that why_not_valid() (sim/model/settings_file.h) finds fault with.
  void set_settings(const Settings& settings);

  /// RG8, as large as the grid: grey and 1, or 0 and 0 outside the sweep. This and what is read back is there once
  /// volume, sweep and grid are set.
  const Texture& volume();

  /// The same read back: 0 to 255, -1 outside the sweep. Runs what is due first.
  Volume<std::int16_t> read_grey();
  /// U (6) before gain, read back: NaN outside the sweep. Runs what is due first.
  Volume<float> read_fused();

  /// How often each stage has run since the simulator was made, in the order of SweepStage.
  const std::array<long, kSweepStageCount>& runs() const;
  /// Evaluated and possible in samples (traverse, beam, fuse) or voxels. Waits for the device where the stage is the
  /// traversal.
  StageCount count(SweepStage stage) const;

  /// Builds all shaders from other sources; when one does not build all go on as they were, and it is told of.
  std::optional<std::string> reload(const ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::gl
