#include "sim/view/edge_letters.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace insonate::view {

std::string letters_of(const glm::dvec3& direction) {
  const double length = glm::length(direction);
  if (!(length > 0)) return "";
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  const auto letter = [&](int axis) { return (direction[axis] > 0 ? "LPS" : "RAI")[axis]; };
  std::string letters(1, letter(axes[0]));
  if (std::abs(direction[axes[0]]) / length < std::cos(glm::radians(kOblique_deg))) letters += letter(axes[1]);
  return letters;
}

EdgeLetters edge_letters(const glm::dvec3& to_the_right, const glm::dvec3& down) {
  return {letters_of(-to_the_right), letters_of(to_the_right), letters_of(-down), letters_of(down)};
}

}  // namespace insonate::view
