#pragma once

#include <glm/vec2.hpp>

#include <cstddef>

namespace insonate::gl {

/// How work is shared out to the device. What it is changes no picture, but for how sums along a line are rounded;
/// tests take others to see that.
///
/// A scan line is walked along in one of two ways, because the intensity at each sample depends on all before it. By an
/// invocation, sample after sample: it fetches and adds no more than it must, and waits for nobody. Or by a work group,
/// whose invocations take neighbouring samples, a stretch of the line at a time, and find what hangs on those before by
/// scans over the stretch: each sample fetches up to three times as much, and a stretch waits at a dozen barriers, but
/// a line is work for as many lanes as the group has, and done in as many times fewer steps.
///
/// Devices run invocations side by side in lanes of a vector, 8 of llvmpipe's with AVX, 32 or 64 of a graphics card's,
/// and lanes beyond a work group's size stay idle: groups of 8 would leave three quarters of a card unused. Groups
/// wider than the vector, on the other hand, leave a card's other processors without lines, of which a picture has only
/// some hundred. So a group has as many invocations as the vector has lanes, and those that walk along a line together
/// wait for none but each other at a barrier. The stages of pixels have groups of 64 on every device.
struct WorkDivision {
  /// Invocations of a work group that walks along lines, or through an image's pixels: 4 to 128.
  int group = 8;

  /// From so many lines on, which are walked along at once, an invocation takes a line; fewer take a work group each. 0
  /// where an invocation always does.
  std::size_t lines_that_fill = 0;

  /// Images of model W that an invocation works through one after the other, where a call asks for many: a software
  /// renderer pays for each work group and for each look at where a pixel lies, a card wants all at once. From
  /// ScanStages::kInterleaved on, so many lie abreast.
  int images_per_invocation = 1;

  /// Work groups along a dimension: so many at least every device takes (GL_MAX_COMPUTE_WORK_GROUP_COUNT).
  int most_groups = 65535;

  /// Of 16 bytes, that a shader has in a buffer: 128 MiB, which every device of OpenGL 4.5 takes as a storage block.
  /// What may be more, as the lines of a sweep, is worked through in parts.
  std::size_t most_texels = std::size_t(1) << 23;

  /// The current context's. `group` is GL_KHR_shader_subgroup's size where the driver has it, else 8 for a software
  /// renderer and 32. `lines_that_fill` is 0 for a software renderer: a picture's lines fill the few vectors that there
  /// are, and a group a line takes 1.4 to 2.7 times as long (docs/benchmarks, `work division`). For a graphics card it
  /// is 8192: no card has been measured, and this is reckoned. To hide how long a fetch takes, a processor of a card
  /// needs some 8 vectors of 32 lines under way, and cards have 16 to 130 processors: 4000 to 33,000 lines fill one. A
  /// picture has 4096 at most and takes groups; a sweep of 64 planes with 128 lines and more takes invocations.
  /// `insonate-bench work division` tells which of the two ways is faster for how many lines.
  static WorkDivision of_device();

  /// `groups` of them, 1 at least, in rows that the device takes: at least as many in all, by less than a row's share.
  glm::ivec2 in_rows(std::size_t groups) const;
};

}  // namespace insonate::gl
