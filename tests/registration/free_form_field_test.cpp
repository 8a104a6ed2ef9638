// Tests the field of control points by its definition: sums, derivatives, energies and inverses.

#include "sim/registration/free_form_field.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/core/hash.h"

using namespace insonate;

namespace {

double random_number(std::size_t i, int which) {
  return 2 * unit_float(hash(std::uint32_t(i), std::uint32_t(which))) - 1;
}

// Returns a field of control points that move up to `most_mm` along each axis.
FreeFormField random_field(double most_mm, double spacing_mm = 20) {
  FreeFormField field = field_over({{-10, 5, 100}, {41, 33, 88}}, spacing_mm);
  for (std::size_t i = 0; i < field.control_mm.size(); ++i)
    field.control_mm[i] = most_mm * glm::dvec3(random_number(i, 0), random_number(i, 1), random_number(i, 2));
  return field;
}

// Returns the cubic B-spline by its usual definition.
double spline(double t) {
  t = std::abs(t);
  return t < 1 ? 2.0 / 3 - t * t + t * t * t / 2 : t < 2 ? std::pow(2 - t, 3) / 6 : 0;
}

glm::dvec3 by_definition(const FreeFormField& field, const glm::dvec3& p) {
  const glm::dvec3 u = (p - field.origin_mm) / field.spacing_mm;
  glm::dvec3 sum(0.0);
  std::size_t n = 0;
  for (int k = 0; k < field.size.z; ++k)
    for (int j = 0; j < field.size.y; ++j)
      for (int i = 0; i < field.size.x; ++i)
        sum += spline(u.x - i) * spline(u.y - j) * spline(u.z - k) * field.control_mm[n++];
  return sum;
}

const std::vector<glm::dvec3> kPoints{{0, 10, 95},   {-10, 5, 88},  {41, 33, 100}, {20.5, 19.3, 91.7},
                                      {-43, 20, 95}, {70, 60, 130}, {15, -30, 60}};

}  // namespace

TEST_CASE("a field is the sum of its control points' splines, everywhere") {
  const FreeFormField field = random_field(4);
  for (const glm::dvec3& p : kPoints) {
    INFO(p.x << " " << p.y << " " << p.z);
    CHECK(glm::distance(field.displacement(p), by_definition(field, p)) < 1e-12);
  }
  CHECK(glm::length(field.displacement({-10, 5, 88})) > 0.1);
  CHECK(field.displacement({1e30, 0, 0}) == glm::dvec3(0.0));
  // 2 spacings beyond the outermost control point.
  CHECK(field.displacement(field.origin_mm - 2 * field.spacing_mm) == glm::dvec3(0.0));
  CHECK(field.displacement(field.origin_mm - 1.5 * field.spacing_mm) != glm::dvec3(0.0));
}

TEST_CASE("control points that move alike move all of the covered box alike") {
  FreeFormField field = random_field(0);
  for (glm::dvec3& control : field.control_mm) control = {1, -2, 3};
  for (const glm::dvec3& p : {glm::dvec3(-10, 5, 88), glm::dvec3(41, 33, 100), glm::dvec3(3, 21, 93)})
    CHECK(glm::distance(field.displacement(p), {1, -2, 3}) < 1e-12);
  CHECK(glm::distance(field.displacement({-60, 5, 88}), {1, -2, 3}) > 0.1);
}

TEST_CASE("the derivative of a field is that of its displacements") {
  const FreeFormField field = random_field(4);
  constexpr double h = 1e-4;
  for (const glm::dvec3& p : kPoints)
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = h;
      const glm::dvec3 difference = (field.at(p + step) - field.at(p - step)) / (2 * h);
      CHECK(glm::distance(difference, field.jacobian(p)[axis]) < 1e-7);
    }
}

TEST_CASE("the bending energy is the integral of the squared second derivatives") {
  const FreeFormField field = random_field(4, 30);
  // Second derivatives of a cubic spline are continuous and linear between control points. The midpoint rule over an
  // eighth of the spacing is then right within some 1 / 8^2 of the differences between control points.
  constexpr double kStep_mm = 30.0 / 8, h = 0.01;
  double sum = 0;
  const glm::ivec3 steps = (field.size + 3) * 8;
  for (int k = 0; k < steps.z; ++k)
    for (int j = 0; j < steps.y; ++j)
      for (int i = 0; i < steps.x; ++i) {
        const glm::dvec3 p = field.origin_mm - 60.0 + kStep_mm * (glm::dvec3(i, j, k) + 0.5);
        for (int axis = 0; axis < 3; ++axis) {
          glm::dvec3 step(0.0);
          step[axis] = h;
          const glm::dmat3 second = (field.jacobian(p + step) - field.jacobian(p - step)) / (2 * h);
          for (int column = 0; column < 3; ++column) sum += glm::dot(second[column], second[column]);
        }
      }
  const double integral = sum * kStep_mm * kStep_mm * kStep_mm;
  CHECK(field.bending_energy() == Approx(integral / field.covered_mm3()).epsilon(0.02));
  CHECK(field.covered_mm3() == Approx(60.0 * 30 * 30));
  CHECK(random_field(0).bending_energy() == 0);
}

TEST_CASE("a field that does not fold has an inverse, and one that folds is known by its determinant") {
  const FreeFormField field = random_field(4);
  CHECK(field.least_jacobian() > 0.1);
  CHECK(field.least_jacobian() < 1);
  for (const glm::dvec3& p : kPoints) CHECK(glm::distance(field.inverse(field.at(p)), p) < 1e-5);
  CHECK(random_field(0).least_jacobian() == 1);
  FreeFormField folded = random_field(0);
  folded.control_mm[folded.control_mm.size() / 2] = {120, 0, 0};
  CHECK(folded.least_jacobian() < 0);
  folded.control_mm[folded.control_mm.size() / 2] = {10, 0, 0};
  // A spline is steepest 2/3 of the spacing from its middle, where its slope is 2/3. The checked points include that.
  CHECK(folded.least_jacobian() == Approx(1 - 10.0 / 20 * 2 / 3 * 4 / 9));
}

TEST_CASE("a field whose least checked Jacobian is 0.2 does not fold between the checked points") {
  for (const double spacing_mm : {8.0, 20.0}) {
    double most_mm = 0;
    for (double step_mm = spacing_mm; step_mm > 1e-3 * spacing_mm; step_mm /= 2)
      if (random_field(most_mm + step_mm, spacing_mm).least_jacobian() >= 0.2) most_mm += step_mm;
    const FreeFormField field = random_field(most_mm, spacing_mm);
    CHECK(field.least_jacobian() == Approx(0.2).margin(0.01));
    constexpr int kFiner = 4;
    const glm::ivec3 steps = (field.size + 3) * FreeFormField::kJacobianSteps * kFiner;
    double least = 1;
    for (int k = 0; k <= steps.z; ++k)
      for (int j = 0; j <= steps.y; ++j)
        for (int i = 0; i <= steps.x; ++i)
          least = std::min(least, glm::determinant(field.jacobian(
                                      field.origin_mm - 2 * spacing_mm +
                                      spacing_mm / (FreeFormField::kJacobianSteps * kFiner) * glm::dvec3(i, j, k))));
    INFO("spacing " << spacing_mm << " mm, control points move " << most_mm << " mm, least " << least);
    CHECK(least > 0.1);
    CHECK(least <= field.least_jacobian());
  }
}

TEST_CASE("the weights of a point give its displacement, with entries that no other point shares") {
  const FreeFormField field = random_field(4);
  for (const glm::dvec3& p : kPoints) {
    const SplineWeights weights = weights_at(field, p);
    glm::dvec3 sum(0.0);
    for (std::size_t n = 0; n < 64; ++n) {
      const int control = weights.control[n];
      if (control < 0) continue;
      sum += double(weights.weight[n]) * field.control_mm[std::size_t(control)];
      const int x = control % field.size.x, y = control / field.size.x % field.size.y,
                z = control / field.size.x / field.size.y;
      CHECK(std::size_t(x % 4 + 4 * (y % 4) + 16 * (z % 4)) == n);
    }
    CHECK(glm::distance(sum, field.displacement(p)) < 1e-5);  // weights of single precision
  }
}
