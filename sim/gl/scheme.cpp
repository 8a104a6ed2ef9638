#include "sim/gl/scheme.h"

#include <algorithm>

namespace insonate::gl {

glm::ivec2 Scheme::in_rows(std::size_t groups) const {
  const std::size_t count = std::max<std::size_t>(groups, 1), most = std::size_t(most_groups);
  const std::size_t rows = (count + most - 1) / most;
  return {int((count + rows - 1) / rows), int(rows)};
}

}  // namespace insonate::gl
