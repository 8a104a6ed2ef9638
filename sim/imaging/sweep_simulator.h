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
#include "sim/model/settings.h"
#include "sim/probe/sweep.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate::gl {

/// Runs model S for a 3D probe, or for a 2D probe moved by hand, on the graphics card: from a volume, the planes of a
/// sweep and settings it computes a volume of grey levels.
///
/// The lines of all planes are one set: each stage runs once on all of them. Planes are processed in parts only where
/// one buffer cannot hold them all (WorkDivision::most_texels). Then results before scan conversion are not kept. The
/// settings of the picture's size and smoothing (reflection_sigma_mm, transmission_sigma_mm) are not used.
///
/// Setters only note what changed. volume() runs the first stage that a change affects and all behind it, and nothing
/// if nothing changed. Needs an OpenGL 4.5 context that is current at every use, from construction to destruction.
/// Throws std::runtime_error if shaders do not compile, DeviceRefused if the device cannot hold what is asked for.
class SweepSimulator {
public:
  explicit SweepSimulator(const ShaderSources& sources = {}, const WorkDivision& division = WorkDivision::of_device());
  ~SweepSimulator();
  SweepSimulator(SweepSimulator&&) noexcept;
  SweepSimulator& operator=(SweepSimulator&&) noexcept;

  /// Uploads a patient. Throws TextureRefused if the device cannot hold the volume.
  void set_volume(const AcousticVolume& volume, const TissueTable& table);
  /// Throws std::invalid_argument for fewer than two planes, and for poses, a probe or a depth that check_pose() and
  /// check_probe() (sim/imaging/view_limits.h) refuse. The previous sweep then stays.
  void set_sweep(const Sweep& sweep);
  /// Places the volume.
  /// @param grid  where the voxels lie in the patient, for example sweep_grid() (sim/probe/sweep.h): sizes of 1 or more
  ///              and spacings above 0, which are not checked; volume() refuses too many voxels
  void set_grid(const Grid& grid);
  /// Throws std::invalid_argument for settings that why_not_valid() (sim/model/settings_file.h) refuses.
  void set_settings(const Settings& settings);

  /// Returns the volume: RG8, as large as the grid; grey and 1, or 0 and 0 outside the sweep. This and the results read
  /// back exist once volume, sweep and grid are set.
  const Texture& volume();

  /// Runs the outdated stages and reads the volume back: 0 to 255, -1 outside the sweep.
  Volume<std::int16_t> read_grey();
  /// Runs the outdated stages and reads back U (6) before gain; NaN outside the sweep.
  Volume<float> read_fused();

  /// Returns how often each stage has run since the simulator was created, in the order of SweepStage.
  const std::array<long, kSweepStageCount>& runs() const;
  /// Returns what a stage did, in samples (traverse, beam, fuse) or voxels. For the traversal, blocks until the device
  /// has finished.
  StageCount count(SweepStage stage) const;

  /// Rebuilds all shaders from `sources`. If one fails to compile, all keep their current programs and its log is
  /// returned.
  std::optional<std::string> reload(const ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::gl
