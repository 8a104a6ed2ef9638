#pragma once

#include <limits>

#include "sim/gl/work_division.h"

/// Both ways to traverse a line, regardless of the device's own choice.
namespace insonate::test {

inline gl::WorkDivision line_an_invocation(int group = 8) {
  gl::WorkDivision division;
  division.group = group;
  return division;
}

inline gl::WorkDivision line_per_group(int group = 8) {
  gl::WorkDivision division = line_an_invocation(group);
  division.lines_that_fill = std::numeric_limits<std::size_t>::max();
  return division;
}

}  // namespace insonate::test
