#pragma once

#include <imgui.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/core/image.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"

namespace insonate::ui {

/// Pixels [x, end_x) of rows [y, end_y), counted from the top left.
struct PixelBox {
  int x, y, end_x, end_y;
  bool operator==(const PixelBox&) const = default;
};

/// Holds the window's picture, and redraws only what a new frame changes in it. A software renderer takes as long for
/// the whole window as for the simulation, and most frames change little of the window. Needs an OpenGL context from
/// construction to destruction, and ImGui's.
///
/// The picture is divided into square tiles. A tile is redrawn if anything in it differs from the frame before: a
/// triangle's corners, colours or texture, or what the texture contains.
class Canvas {
public:
  /// Returns a number that changes whenever the pixels of a texture do; 0 for letters.
  using TextureVersion = std::function<long(ImTextureID)>;

  Canvas();

  /// Makes the texture of ImGui's fonts. To be called before the first frame, and when the fonts have changed.
  void make_fonts();
  /// Draws a frame. Returns whether the picture has changed.
  bool draw(const ImDrawData& frame, ImU32 background, const TextureVersion& version_of);
  /// Copies the picture into the framebuffer that is bound, which must be of the same size; or a part of it.
  void show() const { show({0, 0, width_, height_}); }
  void show(const PixelBox& box) const;

  /// Returns a part of the picture, which must lie within it.
  Image<Rgba8> read(const PixelBox& box) const;
  Image<Rgba8> read() const { return read({0, 0, width_, height_}); }

  int width() const { return width_; }
  int height() const { return height_; }
  /// Returns what the last draw() has drawn; the boxes do not overlap.
  const std::vector<PixelBox>& drawn() const { return drawn_; }
  /// Returns how many pixels that is.
  long pixels_drawn() const;

private:
  /// How triangles are drawn. Those that read no texture, or that cover everything below them, are drawn much faster.
  enum class Kind { plain, covering, picture, toned, tinted };  // toned: a picture in another colour
  /// A corner as the shaders read it; its place in the window is in clip space.
  using Corner = ImDrawVert;
  /// Triangles that follow each other and are drawn in the same way.
  struct Batch {
    Kind kind;
    ImTextureID texture;
    PixelBox clip, bounds;
    int first, count;  ///< corners
  };

  void resize(int width, int height);
  void take(const ImDrawData& frame, const TextureVersion& version_of);
  void add(Kind kind, ImTextureID texture, const PixelBox& clip, const PixelBox& bounds,
           const std::array<ImDrawVert, 3>& corners);
  std::vector<PixelBox> changed_boxes(const std::vector<std::uint64_t>& before) const;
  const gl::Program& program_of(Kind kind) const;
  void draw_batches() const;

  int width_ = 0, height_ = 0, columns_ = 0, rows_ = 0;
  gl::Texture picture_, fonts_;
  gl::Framebuffer framebuffer_;
  gl::Program plain_, picture_program_, toned_, tinted_;
  gl::Object<gl::VertexArrayKind> corner_layout_;
  std::vector<std::uint64_t> hashes_;  ///< of the tiles of the picture, row by row; empty if it shows no frame yet
  std::vector<Corner> corners_;
  std::vector<Batch> batches_;
  std::vector<PixelBox> drawn_;
};

}  // namespace insonate::ui
