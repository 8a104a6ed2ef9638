#pragma once

#include <glm/vec3.hpp>

#include <string>

namespace insonate::view {

/// What lies towards each edge of a picture of the patient, as on films: R right, L left, A anterior, P posterior, S
/// superior, I inferior. The first letter is the nearest of the patient's axes. The next nearest follows where the
/// direction is more than kOblique_deg off the first, such as "RA".
struct EdgeLetters {
  std::string left, right, top, bottom;
  bool operator==(const EdgeLetters&) const = default;
};

inline constexpr double kOblique_deg = 20;

/// Returns the letters of a direction in the patient's frame (LPS); it need not have unit length.
std::string letters_of(const glm::dvec3& direction);

/// Returns the letters of a picture whose right edge and lower edge lie in these directions of the patient.
EdgeLetters edge_letters(const glm::dvec3& to_the_right, const glm::dvec3& down);

}  // namespace insonate::view
