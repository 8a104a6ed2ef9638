#pragma once

#include <optional>

#include "sim/gl/objects.h"
#include "sim/view/body/patient_textures.h"
#include "sim/view/body/transfer_function.h"

namespace insonate::view {

/// Holds on the graphics card what a transfer function makes of a CT: its table, and the distances to what it shows.
class ClassifiedCt {
public:
  /// Updates both if the function or the patient differs from the last call's.
  /// @param patient  compared by address: call forget() after changing the object there
  void update(const PatientTextures& patient, const TransferFunction& function, bool body_only);
  void forget() { patient_ = nullptr; }

  /// Binds the textures that shared/ct_march.glsl reads.
  void bind() const;

private:
  const PatientTextures* patient_ = nullptr;
  std::optional<TransferFunction> function_;
  bool body_only_ = false;
  gl::TexelBuffer table_;
  gl::Texture distance_;
};

}  // namespace insonate::view
