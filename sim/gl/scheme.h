#pragma once

#include <glm/vec2.hpp>

#include <cstddef>

namespace insonate::gl {

/// How work is shared out to the device. What it is changes no picture; tests take others to see that.
///
/// A scan line is walked by one invocation, sample after sample: the intensity at each depends on all before it.
/// Devices run invocations side by side in lanes of a vector, 8 of llvmpipe's with AVX, 32 or 64 of a graphics card's,
/// and lanes beyond a work group's size stay idle: groups of 8 would leave three quarters of a card unused. Groups
/// wider than the vector, on the other hand, leave a card's other processors without lines, of which a picture has only
/// some hundred. So a group has as many invocations as the vector has lanes. The stages of pixels have groups of 64 on
/// every device.
struct Scheme {
  /// Invocations of a work group that walks along lines, or through an image's pixels: 4 to 128.
  int group = 8;

  /// Images of model W that an invocation works through one after the other, where a call asks for many: a software
  /// renderer pays for each work group and for each look at where a pixel lies, a card wants all at once.
  int images_in_turn = 1;

  /// Work groups along a dimension: so many at least every device takes (GL_MAX_COMPUTE_WORK_GROUP_COUNT).
  int most_groups = 65535;

  /// Of 16 bytes, that a shader has in a buffer: 128 MiB, which every device of OpenGL 4.5 takes as a storage block.
  /// What may be more, as the lines of a sweep, is worked through in parts.
  std::size_t most_texels = std::size_t(1) << 23;

  /// The current context's: GL_KHR_shader_subgroup's size where the driver has it, else 8 for a software renderer
  /// and 32.
  static Scheme of_device();

  /// `groups` of them, 1 at least, in rows that the device takes: at least as many in all, by less than a row's share.
  glm::ivec2 in_rows(std::size_t groups) const;
};

}  // namespace insonate::gl
