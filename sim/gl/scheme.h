#pragma once

#include <glm/vec2.hpp>

#include <cstddef>

namespace insonate::gl {

/// How work is shared out to the device. What it is changes no picture; tests take others to see that.
struct Scheme {
  /// Work groups along a dimension: so many at least every device takes (GL_MAX_COMPUTE_WORK_GROUP_COUNT).
  int most_groups = 65535;

  /// `groups` of them, 1 at least, in rows that the device takes: at least as many in all, by less than a row's share.
  glm::ivec2 in_rows(std::size_t groups) const;
};

}  // namespace insonate::gl
