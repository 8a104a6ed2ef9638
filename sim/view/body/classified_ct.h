#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/view/body/ct_volume_style.h"
#include "sim/view/body/patient_textures.h"
#include "sim/view/body/ray_shader.h"

namespace insonate::view {

/// Holds on the graphics card what a style makes of a CT: the transfer function's table, the surfaces of structures,
/// and the distances to what is shown.
class ClassifiedCt {
public:
  /// @param shader  computes the distances too if it is a compute shader; else the processor does
  ClassifiedCt(const gl::ShaderSources& sources, RayShader shader);

  /// Updates what depends on a part of the style, or the patient, that differs from the last call's.
  /// @param patient  compared by address: call forget() after changing the object there
  void update(const PatientTextures& patient, const CtVolumeStyle& style);
  void forget() { patient_ = nullptr; }
  /// Returns whether there are surfaces of structures to draw.
  bool shows_structures() const { return !with_structures_.empty(); }

  /// Binds the textures that view/ct_march.glsl reads.
  void bind() const;
  /// Returns the distances from cell to cell, R8UI.
  const gl::Texture& distances() const { return distances_; }

  /// Returns the programs in use, to reload them.
  std::vector<gl::Program*> programs();

private:
  void measure_distances(const glm::ivec3& cells, const std::vector<std::uint8_t>& occupied);

  std::optional<gl::Program> passes_;  ///< compute the distances
  const PatientTextures* patient_ = nullptr;
  std::optional<TransferFunction> function_;
  bool body_only_ = false;
  std::vector<std::uint8_t> structures_;
  std::vector<std::uint8_t> with_structures_;  ///< per cell: 1 if it shows a part of their surfaces
  gl::TexelBuffer table_;
  gl::Texture distances_, between_passes_, surfaces_;
};

}  // namespace insonate::view
