#pragma once

#include <glm/vec2.hpp>

#include <cstddef>

namespace insonate::gl {

/// How work is divided among GPU threads. It changes a picture only through the rounding of sums along a line; tests
/// use other divisions to check that.
///
/// The intensity at a sample depends on all samples before it. So a scan line is traversed in one of two ways:
/// - By one invocation, sample after sample. It fetches and adds no more than it must, and never waits.
/// - By one work group, whose invocations take neighbouring samples, one stretch of the line at a time. Scans (prefix
///   sums) over the stretch find what depends on earlier samples. Each sample fetches up to three times as much, and a
///   stretch waits at a dozen barriers. But one line occupies as many lanes as the group has, and takes as many times
///   fewer steps.
///
/// Devices run invocations side by side in the lanes of a vector: 8 with llvmpipe and AVX, 32 or 64 on a graphics card.
/// Lanes beyond a work group's size stay idle: groups of 8 would waste three quarters of a card. Groups wider than the
/// vector leave a card's other processors without lines, because a picture has only a few hundred. So a group has as
/// many invocations as the vector has lanes. Invocations that traverse one line together wait only for each other at a
/// barrier. The stages of pixels have groups of 64 on every device.
struct WorkDivision {
  /// Invocations per work group of the stages that traverse lines or go through an image's pixels, 4 to 128.
  int group = 8;

  /// From this number of lines on, traversed at once, one invocation takes one line. Fewer lines take one work group
  /// each. 0: one invocation always takes one line.
  std::size_t lines_that_fill = 0;

  /// Images of model W that one invocation processes one after the other, where a call asks for many. A software
  /// renderer pays for each work group and for each lookup of a pixel's place; a card wants all images at once. From
  /// ScanStages::kInterleaved on, that many images are interleaved.
  int images_per_invocation = 1;

  /// Most work groups along a dimension: every device accepts this many (GL_MAX_COMPUTE_WORK_GROUP_COUNT).
  int most_groups = 65535;

  /// Most texels of 16 bytes in a shader's buffer: 128 MiB, which every OpenGL 4.5 device accepts as a storage block.
  /// Data that may be larger, such as the lines of a sweep, is processed in parts.
  std::size_t most_texels = std::size_t(1) << 23;

  /// Returns the division for the current context. `group` is GL_KHR_shader_subgroup's size if the driver has it, else
  /// 8 for a software renderer and 32 for a card.
  ///
  /// `lines_that_fill` is 0 for a software renderer: a picture's lines fill its few vectors, and one group per line
  /// takes 1.4 to 2.7 times as long (docs/benchmarks, `work-division`). For a graphics card it is 8192. To hide the
  /// latency of a fetch, a card's processor needs some 8 vectors of 32 lines in flight. Cards have 16 to 130
  /// processors, so 4000 to 33,000 lines fill one; with the 132 of an H100, both ways take the same time at 32,768. A
  /// picture has at most 4096 and takes groups; a sweep of 64 planes with 128 lines and more takes invocations.
  /// `insonate-bench work-division` reports which way is faster for how many lines.
  static WorkDivision of_device();

  /// Divides `groups` work groups (0 counts as 1) into rows that the device accepts. Returns (groups per row, rows);
  /// their product is at least `groups`, and larger by less than one group per row.
  glm::ivec2 in_rows(std::size_t groups) const;
};

}  // namespace insonate::gl
