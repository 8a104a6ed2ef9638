#include "sim/registration/motion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace insonate {
namespace {

glm::dmat4 rotation(const glm::dvec3& radians) {
  const double angle = glm::length(radians);
  return angle > 0 ? glm::rotate(glm::dmat4(1.0), angle, radians / angle) : glm::dmat4(1.0);
}

// Returns exp(S) by its series, which for the small stretches of a body converges within double precision.
glm::dmat4 exponential(const glm::dmat3& s) {
  glm::dmat3 sum(1.0), term(1.0);
  for (int n = 1; n <= 20; ++n) {
    term = term * s / double(n);
    sum += term;
  }
  return glm::dmat4(sum);
}

}  // namespace

glm::dmat4 Motion::at(std::span<const double> x) const {
  const bool is_affine = x.size() == parameters_of(Freedom::affine);
  if (!is_affine && x.size() != parameters_of(Freedom::rigid))
    throw std::invalid_argument("a motion has 6 or 12 parameters");
  glm::dmat4 turned = rotation(glm::dvec3(x[3], x[4], x[5]) / radius_mm);
  if (is_affine) {
    const glm::dvec3 stretch = glm::dvec3(x[6], x[7], x[8]) / radius_mm,
                     shear = glm::dvec3(x[9], x[10], x[11]) / radius_mm;
    turned *=
        exponential(glm::dmat3(stretch.x, shear.z, shear.y, shear.z, stretch.y, shear.x, shear.y, shear.x, stretch.z));
  }
  const glm::dmat4 back = glm::translate(glm::dmat4(1.0), -centre_in_ct);
  const glm::dmat4 there = glm::translate(glm::dmat4(1.0), centre_in_ct + glm::dvec3(x[0], x[1], x[2]));
  return there * turned * back * ct_from_sweep;
}

Motion motion_about(const std::vector<glm::dvec3>& points, const glm::dmat4& ct_from_sweep) {
  Motion motion;
  motion.ct_from_sweep = ct_from_sweep;
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& point : points) sum += point;
  const glm::dvec3 middle = sum / double(points.size());
  motion.centre_in_ct = glm::dvec3(ct_from_sweep * glm::dvec4(middle, 1));
  double squares = 0;
  for (const glm::dvec3& point : points) squares += glm::dot(point - middle, point - middle);
  motion.radius_mm = std::max(std::sqrt(squares / double(points.size())), 1.0);
  return motion;
}

}  // namespace insonate
