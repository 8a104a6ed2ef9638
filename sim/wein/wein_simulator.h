#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/image_range.h"
#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/work_division.h"
#include "sim/imaging/stage.h"
#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/wein/wein_settings.h"
#include "sim/wein/wein_stages.h"

namespace insonate::gl {

/// Runs model W (sim/wein/wein_settings.h) on the graphics card for registration. It computes many images per
/// call, and the similarity of each to a given ultrasound image.
///
/// A call processes its poses in chunks whose scan lines stay below 24 MiB, so that memory is bounded. Nothing is read
/// back between chunks. Needs an OpenGL 4.5 context that is current at every use. A call with a pose that check_pose()
/// (sim/imaging/view_limits.h) refuses throws std::invalid_argument and draws nothing.
class WeinSimulator {
public:
  /// Throws std::runtime_error if shaders do not compile, TextureRefused if the device cannot hold the volume, and
  /// std::invalid_argument for settings that why_not_valid() (sim/wein/wein_settings_file.h) refuses, or a
  /// probe or depth that check_probe() (sim/imaging/view_limits.h) refuses.
  /// @param depth_mm  0.1 to 1000
  WeinSimulator(const AcousticVolume& volume, const Probe& probe, double depth_mm, const WeinSettings& settings,
                const ShaderSources& sources = {}, const WorkDivision& division = WorkDivision::of_device());
  ~WeinSimulator();
  WeinSimulator(WeinSimulator&&) noexcept;
  WeinSimulator& operator=(WeinSimulator&&) noexcept;

  /// Returns how an image's pixels lie in the probe's plane; the same for all images.
  const ImageGeometry& geometry() const;
  /// Returns 1 inside the fan. Elsewhere images are 0, without meaning.
  const Image<std::uint8_t>& inside() const;

  /// Draws one image per pose, each in its tile of a nearly square grid: R8, row 0 on top. The result is valid until
  /// the next call; the device may still be drawing it. Throws std::runtime_error if the device does not accept a grid
  /// of that many images.
  const Texture& simulate(std::span<const Pose> patient_from_probe);
  /// The same for affine maps, which stretch and shear what the probe sees; distances along a line are the probe's.
  /// Throws std::invalid_argument for a map whose axes are not kMinStretch to kMaxStretch long.
  const Texture& simulate(std::span<const glm::dmat4> patient_from_probe);
  static constexpr double kMinStretch = 0.5, kMaxStretch = 2;
  /// Returns the top left pixel of an image in the last grid.
  glm::ivec2 tile(int image) const;

  /// Sets the images that similarity() compares with: grey values, linear or compressed, of any finite range, on
  /// geometry()'s pixels. NaN excludes a pixel; pixels outside the fan never count. Throws std::invalid_argument for
  /// another size.
  void set_ultrasound(std::span<const Image<float>> images);
  void set_ultrasound(const Image<float>& image) { set_ultrasound({&image, 1}); }

  /// Returns, per ultrasound image, the sum of (u - mean u)^2 over the pixels that count: its weight where the LC2 of
  /// several images are averaged.
  const std::vector<double>& ultrasound_variation() const;

  /// Returns LC2 of the image at each pose with the ultrasound image, 0 to 1, as sim/wein/wein_reference.h
  /// defines it, with patches if the settings ask for them. With n ultrasound images, pose i is compared with image
  /// i modulo n, so that one call can evaluate a sweep at many places. The simulated images stay on the device; one
  /// number per image is read back. Returns 0 without an ultrasound image. Blocks until the device has finished.
  /// @param used  only these ultrasound images count, as if there were no others
  std::vector<float> similarity(std::span<const Pose> patient_from_probe, ImageRange used = {});
  /// The same for affine maps, as simulate() takes them.
  std::vector<float> similarity(std::span<const glm::dmat4> patient_from_probe, ImageRange used = {});

  /// Returns the points at which a deformation of the patient may bend scan lines, in the probe's frame, mm. Between
  /// them, displacements are linear along the lines and from line to line. The points are about 32 by 32, at least 2
  /// samples apart.
  const std::vector<glm::dvec3>& bend_nodes() const;
  /// Compares as similarity() does, with scan lines that a deformation of the patient bends. Returns what each patch
  /// contributes to its image's LC2: per pose, patches_across() x patches_down() numbers, row by row, whose sum is the
  /// LC2. Distances along a line remain the probe's. Throws std::invalid_argument without patches in the settings, for
  /// another number of bends, or for one that is not finite.
  /// @param bends  per pose, how far each of bend_nodes() is moved behind the pose, in the patient's frame, mm
  std::vector<float> patch_similarity(std::span<const glm::dmat4> patient_from_probe, std::span<const glm::vec3> bends);
  /// Returns how many patches lie side by side in an image, and one below the other; 1 without patches.
  int patches_across() const;
  int patches_down() const;

  /// Returns what a stage did in all images of the last call. A call with at least one pose is one run of its stages; a
  /// call with the same poses as the call before runs nothing. Evaluated samples are modulo 2^32; a line counts until
  /// the last of the lines traversed together with it has ended. Images of read_stages() count too. For the traversal,
  /// blocks until the device has finished.
  StageCount count(WeinStage stage) const;

  /// Reads back what the stages of one image write, except its terms after scan conversion. For checks.
  WeinStages<float> read_stages(const Pose& patient_from_probe);

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::gl
