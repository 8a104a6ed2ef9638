#pragma once

#include <optional>
#include <string>

#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/view/axis_slice.h"
#include "sim/view/body/patient_textures.h"
#include "sim/view/slice_painter.h"

namespace insonate::view {

/// Draws the CT along two of the patient's axes, whatever the directions of its voxels. Needs a current OpenGL context.
///
///     AxisSliceView view;
///     const AxisSlice slice = AxisSlice::fitting(SliceAxis::axial, ct.grid, face_mm, 400, 300);
///     const gl::Texture& picture = view.render(patient, slice);
class AxisSliceView {
public:
  /// Throws std::runtime_error if the shader does not compile.
  explicit AxisSliceView(const gl::ShaderSources& sources = {}) : painter_(sources) {}

  /// Returns the picture: RGBA8, alpha 255, row 0 is the top, the size of `slice`. It is redrawn only if something
  /// changed, and valid until the next call. Leaves the framebuffer binding, viewport and switches as they were.
  /// @param patient  compared by address: call forget() after changing the object there
  const gl::Texture& render(const PatientTextures& patient, const AxisSlice& slice, const CtStyle& style = {});

  /// Makes the next render() redraw.
  void forget() { drawn_.reset(); }

  /// Returns how often it has drawn.
  long renders() const { return painter_.renders(); }

  /// Rebuilds the shader from `sources`. If it fails to compile, the view keeps its current one and its log is
  /// returned.
  std::optional<std::string> reload(const gl::ShaderSources& sources);

private:
  struct Inputs {
    const PatientTextures* patient;
    AxisSlice slice;
    CtStyle style;
    bool operator==(const Inputs&) const = default;
  };

  SlicePainter painter_;
  std::optional<Inputs> drawn_;
};

}  // namespace insonate::view
