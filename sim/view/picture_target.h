#pragma once

#include "sim/gl/objects.h"

namespace insonate::view {

/// A picture to draw into: RGBA8, sampled with linear filtering.
struct PictureTarget {
  gl::Texture texture;
  gl::Framebuffer framebuffer;

  /// Makes new textures if the size differs.
  void resize(int width, int height);
  bool has_size(int width, int height) const {
    return texture && texture.width() == width && texture.height() == height;
  }
};

/// Directs drawing, while it exists, into rows [first, end) of a target, without blending or tests. The destructor
/// restores the framebuffer binding, viewport and switches, so that a view can be drawn within another program's frame.
class ScopedDrawTarget {
public:
  ScopedDrawTarget(const gl::Framebuffer& target, int first_row, int end_row);
  ~ScopedDrawTarget();
  ScopedDrawTarget(const ScopedDrawTarget&) = delete;
  ScopedDrawTarget& operator=(const ScopedDrawTarget&) = delete;

private:
  GLint framebuffer_ = 0, viewport_[4] = {}, scissor_[4] = {};
  bool blend_, depth_test_, cull_face_, scissor_test_;
};

}  // namespace insonate::view
