#include "sim/view/edge_letters.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

using namespace insonate::view;

TEST_CASE("a direction along one of the patient's axes has that axis' letter") {
  CHECK(letters_of({1, 0, 0}) == "L");
  CHECK(letters_of({-3, 0, 0}) == "R");
  CHECK(letters_of({0, 1, 0}) == "P");
  CHECK(letters_of({0, -1, 0}) == "A");
  CHECK(letters_of({0, 0, 0.2}) == "S");
  CHECK(letters_of({0, 0, -1}) == "I");
  CHECK(letters_of({0, 0, 0}).empty());
}

TEST_CASE("a direction more than 20 degrees off the nearest axis has the next axis' letter too") {
  const auto between = [](double degrees) {
    const double angle = glm::radians(degrees);
    return letters_of({-std::cos(angle), -std::sin(angle), 0});
  };
  CHECK(between(19) == "R");
  CHECK(between(21) == "RA");
  CHECK(between(44) == "RA");
  CHECK(between(46) == "AR");
  CHECK(between(69) == "AR");
  CHECK(between(71) == "A");
  // The third axis is never named.
  CHECK(letters_of({0.5, 0.6, -0.7}) == "IP");
}

TEST_CASE("the letters of opposite edges are opposite") {
  CHECK(edge_letters({1, 0, 0}, {0, 1, 0}) == EdgeLetters{"R", "L", "A", "P"});
  const EdgeLetters oblique = edge_letters(glm::normalize(glm::dvec3(1, 0, 1)), glm::normalize(glm::dvec3(0, 1, 0.2)));
  CHECK(oblique == EdgeLetters{"RI", "LS", "A", "P"});
}
