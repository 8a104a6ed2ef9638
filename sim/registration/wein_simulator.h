#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/imaging/stage.h"
#include "sim/model/acoustic_volume.h"
#include "sim/probe/probe.h"
#include "sim/registration/wein_settings.h"
#include "sim/registration/wein_stages.h"

namespace insonate::gl {

/// Model W (sim/registration/wein_settings.h) on the graphics card: many images a call, as registration needs them, and
/// how much each is like a given ultrasound image.
///
/// A call's poses are worked through in chunks whose scan lines stay below 24 MiB, so that memory is bounded; nothing
/// is read back between chunks. Needs an OpenGL 4.5 context, current whenever it is used. A call with a pose that
/// check_pose() (sim/imaging/view_limits.h) finds fault with throws std::invalid_argument and draws nothing.
class WeinSimulator {
public:
  /// Throws std::runtime_error when shaders do not build, TextureRefused when the device cannot hold the volume,
  /// std::invalid_argument on settings that why_not_valid() (sim/registration/wein_settings_file.h) finds fault with,
  /// and on a probe or a depth that check_probe() (sim/imaging/view_limits.h) does.
  /// @param depth_mm  0.1 to 1000
  WeinSimulator(const AcousticVolume& volume, const Probe& probe, double depth_mm, const WeinSettings& settings,
                const ShaderSources& sources = {}, const WorkDivision& division = WorkDivision::of_device());
  ~WeinSimulator();
  WeinSimulator(WeinSimulator&&) noexcept;
  WeinSimulator& operator=(WeinSimulator&&) noexcept;

  /// How an image's pixels lie in the probe's plane; the same for all.
  const ImageGeometry& geometry() const;
  /// 1 inside the fan: elsewhere images are 0 and mean nothing.
  const Image<std::uint8_t>& inside() const;

  /// An image a pose, each in its tile of a grid: R8, row 0 on top, near to square. Throws std::runtime_error when
  /// the device takes no grid of that many. Valid until the next call. The device may still be at work.
  const Texture& simulate(std::span<const Pose> patient_from_probe);
  /// The top left pixel of an image of the last grid.
  glm::ivec2 tile(int image) const;

  /// What similarity() compares with: grey values, linear or compressed, of any finite range, on geometry()'s pixels;
  /// NaN where a pixel is not to count. Pixels outside the fan never do. Throws std::invalid_argument for another size.
  void set_ultrasound(const Image<float>& image);

  /// LC2 of the image at each pose with the ultrasound image, 0 to 1, as sim/registration/wein_reference.h defines it,
  /// by patches if the settings say so: the images stay on the device, a number each is read back. 0 without an
  /// ultrasound image. Waits for the device.
  std::vector<float> similarity(std::span<const Pose> patient_from_probe);

  /// Of calls with any pose, each of which is one run of its stages, and of all its images; one with the same poses as
  /// the call before runs nothing. Samples evaluated are modulo 2^32; a line counts until the last of those that are
  /// walked along together has ended. Waits for the device where the stage is the traversal. Images that read_stages()
  /// makes count as well.
  StageCount count(WeinStage stage) const;

  /// What crosses the stages of one image but its terms behind scan conversion, read back; for those who check.
  WeinStages<float> read_stages(const Pose& patient_from_probe);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::gl
