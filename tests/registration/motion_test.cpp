// Tests what the parameters of a registration mean.

#include "sim/registration/motion.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <vector>

#include "sim/registration/minimise.h"

using namespace insonate;

namespace {

const std::vector<glm::dvec3> kPoints{{10, 0, 0}, {-10, 0, 0}, {0, 30, 0}, {0, -30, 0}, {0, 0, 20}, {0, 0, -20}};

Motion moved() {
  return motion_about(kPoints, glm::translate(glm::dmat4(1.0), glm::dvec3(100, 50, -20)));
}

glm::dvec3 apply(const glm::dmat4& matrix, const glm::dvec3& point) {
  return glm::dvec3(matrix * glm::dvec4(point, 1));
}

}  // namespace

TEST_CASE("a motion without parameters is the start, and turns about the middle of the points") {
  const Motion motion = moved();
  CHECK(motion.at(Parameters(6, 0.0)) == motion.ct_from_sweep);
  CHECK(glm::distance(motion.centre_in_ct, glm::dvec3(100, 50, -20)) < 1e-12);
  CHECK(motion.radius_mm == Approx(std::sqrt((2 * 100 + 2 * 900 + 2 * 400) / 6.0)));
  const Parameters turned{0, 0, 0, 0, 0, motion.radius_mm * glm::radians(90.0)};
  CHECK(glm::distance(apply(motion.at(turned), {0, 0, 0}), motion.centre_in_ct) < 1e-12);
  CHECK(glm::distance(apply(motion.at(turned), {10, 0, 0}), motion.centre_in_ct + glm::dvec3(0, 10, 0)) < 1e-12);
  const Parameters shifted{1, 2, 3, 0, 0, 0};
  CHECK(glm::distance(apply(motion.at(shifted), {0, 0, 0}), motion.centre_in_ct + glm::dvec3(1, 2, 3)) < 1e-12);
}

TEST_CASE("an affine motion stretches and shears without turning") {
  const Motion motion = moved();
  Parameters x(12, 0.0);
  x[6] = motion.radius_mm * std::log(1.1);
  CHECK(glm::distance(apply(motion.at(x), {10, 30, 0}), motion.centre_in_ct + glm::dvec3(11, 30, 0)) < 1e-9);
  x[6] = 0;
  x[11] = 0.05 * motion.radius_mm;  // the entry xy
  const glm::dmat3 sheared(motion.at(x));
  CHECK(sheared[0][1] == Approx(std::sinh(0.05)));
  CHECK(sheared[1][0] == Approx(sheared[0][1]));
  CHECK(sheared[2][2] == Approx(1));
  CHECK(glm::determinant(sheared) == Approx(1));  // a shear keeps the volume
  CHECK_THROWS_AS(motion.at(Parameters(7, 0.0)), std::invalid_argument);
}
