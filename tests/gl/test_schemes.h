#pragma once

#include <limits>

#include "sim/gl/scheme.h"

/// Both ways to walk along a line, whichever the device would take.
namespace insonate::test {

inline gl::Scheme line_an_invocation(int group = 8) {
  gl::Scheme scheme;
  scheme.group = group;
  return scheme;
}

inline gl::Scheme line_a_group(int group = 8) {
  gl::Scheme scheme = line_an_invocation(group);
  scheme.lines_that_fill = std::numeric_limits<std::size_t>::max();
  return scheme;
}

}  // namespace insonate::test
