#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/imaging/line_stages.h"
#include "sim/imaging/stage.h"
#include "sim/model/acoustic_volume.h"
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/model/tissue.h"
#include "sim/probe/probe.h"

namespace insonate::gl {

/// Model S on the graphics card: a volume, a probe, a pose and settings in, a picture out.
///
/// Setters only note what changed; image() runs the first stage that a change reaches and those behind it, and nothing
/// when nothing changed. Needs an OpenGL 4.5 context, current whenever it is used, from construction to destruction.
/// Throws std::runtime_error when shaders do not build or the device cannot hold the volume.
class Simulator {
public:
  explicit Simulator(const ShaderSources& sources = {}, const WorkDivision& division = WorkDivision::of_device());
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  void set_volume(const AcousticVolume& volume, const TissueTable& table);
  /// Throws std::invalid_argument on a probe or a depth that check_probe() (sim/imaging/view_limits.h) finds fault
  /// with.
  /// @param depth_mm  0.1 to 1000
  void set_probe(const Probe& probe, double depth_mm);
  /// What shaders are compiled for (effects that are on or off, numbers of lines and planes, a smoothing's radius in
  /// pixels) is compiled when the next picture is due: 50 to 200 ms a stage with llvmpipe, 0.7 s if it is all of them,
  /// and nothing for what one of the last sixteen pictures of other settings had.
  /// Throws std::invalid_argument on settings that why_not_valid() (sim/model/settings_file.h) finds fault with.
  void set_settings(const Settings& settings);
  /// Throws std::invalid_argument on a pose that check_pose() (sim/imaging/view_limits.h) finds fault with: not rigid,
  /// not finite, or further than 10 km away; that before stays.
  void set_pose(const Pose& patient_from_probe);

  /// Runs what is due up to and including a stage, for those who measure.
  void run_through(Stage last);

  /// The picture: RGBA8, grey in red, green and blue, alpha 255 inside the fan; row 0 is the top.
  const Texture& image();
  /// Another number whenever the picture has changed.
  long image_version() const;
  /// How its pixels lie in the probe's plane.
  const ImageGeometry& geometry() const;

  /// The volume as uploaded, (HU, echogenicity in hundredths of a dB) / 32767 with a voxel of air on every side, for
  /// views of the same patient.
  const Texture& volume_texture() const;
  /// Patient mm -> that texture's coordinates.
  const glm::dmat4& texture_from_patient() const;
  /// What the patient takes of the device's memory, a stored gradient included.
  std::size_t volume_bytes() const;

  /// Everything that crosses the stages, read back. Runs what is due first.
  Stages<float> read_stages();

  /// How often each stage has run, in the order of Stage.
  const std::array<long, kStageCount>& runs() const;
  /// Waits for the device.
  SampleCounts sample_counts() const;
  /// Waits for the device where the stage is the traversal.
  StageCount count(Stage stage) const;

  /// Builds all shaders from other sources; when one does not build all go on as they were, and it is told of.
  std::optional<std::string> reload(const ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::gl
