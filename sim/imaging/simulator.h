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
#include "sim/model/settings.h"
#include "sim/model/stages.h"
#include "sim/model/stored_speckle.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate::gl {

/// Runs model S on the graphics card: from a volume, a probe, a pose and settings it computes a picture.
///
/// Setters only note what changed. image() runs the first stage that a change affects and all behind it, and nothing if
/// nothing changed. Call set_volume() and set_probe() before it. Needs an OpenGL 4.5 context that is current at every
/// use, from construction to destruction. The constructor and all functions that draw throw std::runtime_error if a
/// shader does not compile.
class Simulator {
public:
  explicit Simulator(const ShaderSources& sources = {}, const WorkDivision& division = WorkDivision::of_device());
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Uploads a patient. Throws TextureRefused if the device cannot hold the volume.
  void set_volume(const AcousticVolume& volume, const TissueTable& table);
  /// Takes S from a scattering volume instead of drawing scatterers, where settings have `speckle` and no `waves`; null
  /// draws them again. Throws TextureRefused.
  void set_stored_speckle(const StoredSpeckle* speckle);
  /// Throws std::invalid_argument for a probe or a depth that check_probe() (sim/imaging/view_limits.h) refuses.
  /// @param depth_mm  0.1 to 1000
  void set_probe(const Probe& probe, double depth_mm);
  /// image() recompiles the shaders that depend on changed settings: effects on or off, numbers of lines and planes,
  /// the smoothing's radius in pixels. This takes 50 to 200 ms per stage with llvmpipe, and 0.7 s for all stages. The
  /// variants of the last 16 settings are kept, so going back to one of them costs nothing.
  ///
  /// Throws std::invalid_argument for settings that why_not_valid() (sim/model/settings_file.h) refuses.
  void set_settings(const Settings& settings);
  /// Throws std::invalid_argument for a pose that check_pose() (sim/imaging/view_limits.h) refuses: not rigid, not
  /// finite, or more than 10 km away. The previous pose then stays.
  void set_pose(const Pose& patient_from_probe);

  /// Runs the outdated stages up to and including `last`, for measurements. Stages before scan conversion run for the
  /// straight look alone.
  void run_through(Stage last);

  /// Returns the picture: RGBA8, grey in red, green and blue, alpha 255 inside the fan; row 0 is the top.
  const Texture& image();
  /// Returns the picture while the probe moves. If only the pose has changed since the last picture, each call computes
  /// the next look of those that are compounded (sim/model/compounding.h). The other looks stay as the last picture had
  /// them. A share Settings::persistence of the frame before is mixed in, before filter and grey map. After any other
  /// change, the picture is that of image(). At the same pose, each call computes one more look. Once all looks are of
  /// this pose, nothing of a frame before is left: the picture is that of image(). So the picture of a probe at rest
  /// depends on its pose alone, and is complete after as many calls as there are looks.
  const Texture& image_in_motion();
  /// Returns a number that differs whenever the picture has changed.
  long image_version() const;
  /// Returns how the picture's pixels lie in the probe's plane.
  const ImageGeometry& geometry() const;

  /// Returns the volume as uploaded, (HU, echogenicity in hundredths of a dB) / 32767 with a voxel of air on every
  /// side, for views of the same patient.
  const Texture& volume_texture() const;
  /// Maps patient mm to that texture's coordinates.
  const glm::dmat4& texture_from_patient() const;
  /// Returns the device memory that the volume's texture takes, bytes.
  std::size_t volume_bytes() const;

  /// Runs the outdated stages and reads back what all stages write.
  Stages<float> read_stages();

  /// Returns how often each stage has run, in the order of Stage.
  const std::array<long, kStageCount>& runs() const;
  /// Returns the samples of the last traversal. Blocks until the device has finished.
  SampleCounts sample_counts() const;
  /// Returns what a stage did. For the traversal, blocks until the device has finished.
  StageCount count(Stage stage) const;

  /// Rebuilds all shaders from `sources`. If one fails to compile, all keep their current programs and its log is
  /// returned.
  std::optional<std::string> reload(const ShaderSources& sources);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::gl
