#pragma once

#include <cstdint>
#include <memory>

#include "sim/core/grid.h"
#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"

namespace insonate::view {

/// A reconstructed ultrasound volume on the graphics card, 2 bytes per voxel.
class SweptTexture {
public:
  /// @param grey, known  on one grid; `known` is 0 unseen, 1 filled, 2 measured
  /// Throws gl::TextureRefused.
  SweptTexture(const Volume<std::uint8_t>& grey, const Volume<std::uint8_t>& known);

  const Grid& grid() const { return grid_; }
  const gl::Texture& texture() const { return texture_; }

private:
  Grid grid_;
  gl::Texture texture_;
};

/// Where a reformatted picture lies and how it looks.
struct MprPicture {
  Pose patient_from_picture;  ///< origin at the picture's middle, x to the right, y down
  double mm_per_pixel = 0.5;  ///< above 0
  int width = 1, height = 1;  ///< pixels, above 0
  bool tints_filled = true;   ///< whether filled voxels are bluish
  bool unseen_clear = false;  ///< whether alpha is 0 where nothing is known, instead of 255
  bool operator==(const MprPicture&) const = default;
};

/// Draws a volume's grey levels in any plane, trilinear among known voxels and dark where nothing is known.
class MprView {
public:
  /// Throws std::runtime_error if the shader does not compile. Needs a current OpenGL context.
  explicit MprView(const gl::ShaderSources& sources = {});
  ~MprView();
  MprView(MprView&&) noexcept;
  MprView& operator=(MprView&&) noexcept;

  /// Returns the picture: RGBA8, alpha 255 unless the picture says otherwise, row 0 is the top. It is redrawn only if
  /// something changed, and valid until the next call. Leaves the framebuffer binding, viewport and switches as they
  /// were.
  /// @param volume  compared by its texture's name: call forget() when another volume has been made
  const gl::Texture& render(const SweptTexture& volume, const MprPicture& picture);
  /// Redraws at the next render().
  void forget();

  /// Returns how often it has drawn.
  long renders() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace insonate::view
