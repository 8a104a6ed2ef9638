#include "sim/registration/free_form_field.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace insonate {
namespace {

// The splines of the four control points around a place on an axis, and their derivatives, in units of the spacing.
struct Four {
  int first = 0;
  std::array<double, 4> value{}, slope{};
};

Four four_at(double u) {
  const double floor = std::floor(u), t = u - floor, s = 1 - t;
  return {int(floor) - 1,
          {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6},
          {-s * s / 2, (3 * t * t - 4 * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2}};
}

struct Around {
  Four x, y, z;
};

// False if the point lies where the field is 0.
bool find_around(const FreeFormField& field, const glm::dvec3& p, Around& around) {
  const glm::dvec3 u = (p - field.origin_mm) / field.spacing_mm;
  // Far from the grid, whole numbers do not fit an int.
  if (glm::any(glm::lessThan(u, glm::dvec3(-2))) || glm::any(glm::greaterThan(u, glm::dvec3(field.size + 1))))
    return false;
  around = {four_at(u.x), four_at(u.y), four_at(u.z)};
  return true;
}

// Calls work(control, a, b, c) for each control point around a point; a, b and c count from 0 to 3 along the axes.
template <typename Work>
void for_each_control(const FreeFormField& field, const Around& around, Work&& work) {
  for (int c = 0; c < 4; ++c)
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a < 4; ++a) {
        const glm::ivec3 i(around.x.first + a, around.y.first + b, around.z.first + c);
        if (glm::any(glm::lessThan(i, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(i, field.size))) continue;
        work(field.control_mm[std::size_t((i.z * field.size.y + i.y) * field.size.x + i.x)], std::size_t(a),
             std::size_t(b), std::size_t(c));
      }
}

}  // namespace

glm::dvec3 FreeFormField::displacement(const glm::dvec3& p) const {
  glm::dvec3 sum(0.0);
  Around around;
  if (find_around(*this, p, around))
    for_each_control(*this, around, [&](const glm::dvec3& control, std::size_t a, std::size_t b, std::size_t c) {
      sum += around.x.value[a] * around.y.value[b] * around.z.value[c] * control;
    });
  return sum;
}

glm::dmat3 FreeFormField::jacobian(const glm::dvec3& p) const {
  glm::dmat3 sum(0.0);
  Around around;
  if (find_around(*this, p, around))
    for_each_control(*this, around, [&](const glm::dvec3& control, std::size_t a, std::size_t b, std::size_t c) {
      const auto &x = around.x, &y = around.y, &z = around.z;
      sum[0] += x.slope[a] * y.value[b] * z.value[c] * control;
      sum[1] += x.value[a] * y.slope[b] * z.value[c] * control;
      sum[2] += x.value[a] * y.value[b] * z.slope[c] * control;
    });
  return glm::dmat3(1.0) + sum / spacing_mm;
}

glm::dvec3 FreeFormField::inverse(const glm::dvec3& q) const {
  constexpr double kWithin_mm = 1e-6;
  constexpr int kSteps = 100, kHalvings = 12;
  glm::dvec3 p = q - displacement(q);
  glm::dvec3 off = at(p) - q;
  for (int i = 0; i < kSteps && glm::length(off) > kWithin_mm; ++i) {
    const glm::dvec3 step = glm::inverse(jacobian(p)) * off;
    // A whole step may lead farther away where the field bends strongly.
    for (int halved = 0; halved < kHalvings; ++halved) {
      const glm::dvec3 next = p - step * std::pow(0.5, halved), next_off = at(next) - q;
      if (halved + 1 < kHalvings && !(glm::length(next_off) < glm::length(off))) continue;
      p = next;
      off = next_off;
      break;
    }
  }
  if (!(glm::length(off) <= kWithin_mm)) throw std::runtime_error("the deformation has no inverse at a point");
  return p;
}

double FreeFormField::least_jacobian() const {
  // The field is 0 from 2 spacings beyond the grid on.
  const glm::ivec3 steps = (size + 3) * kJacobianSteps + 1;
  const double step_mm = spacing_mm / kJacobianSteps;
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, steps.z), 1.0,
      [&](const tbb::blocked_range<int>& range, double least) {
        for (int k = range.begin(); k < range.end(); ++k)
          for (int j = 0; j < steps.y; ++j)
            for (int i = 0; i < steps.x; ++i)
              least = std::min(least,
                               glm::determinant(jacobian(origin_mm - 2 * spacing_mm + step_mm * glm::dvec3(i, j, k))));
        return least;
      },
      [](double a, double b) { return std::min(a, b); });
}

double FreeFormField::bending_energy() const {
  double sum = 0;
  const auto index = [&](const glm::ivec3& i) { return std::size_t((i.z * size.y + i.y) * size.x + i.x); };
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) {
        const glm::dvec3& here = control_mm[index({i, j, k})];
        glm::dvec3 around(0.0);
        for (int c = std::max(k - 3, 0); c <= std::min(k + 3, size.z - 1); ++c)
          for (int b = std::max(j - 3, 0); b <= std::min(j + 3, size.y - 1); ++b)
            for (int a = std::max(i - 3, 0); a <= std::min(i + 3, size.x - 1); ++a)
              around += SplineProducts::bending({a - i, b - j, c - k}) * control_mm[index({a, b, c})];
        sum += glm::dot(here, around);
      }
  return sum / (spacing_mm * covered_mm3());
}

double FreeFormField::covered_mm3() const {
  const glm::dvec3 box = glm::dvec3(size - 3) * spacing_mm;
  return box.x * box.y * box.z;
}

FreeFormField field_over(const std::vector<glm::dvec3>& points, double spacing_mm) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::dvec3& point : points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  FreeFormField field;
  field.spacing_mm = spacing_mm;
  // A point has two control points on either side along each axis.
  const glm::ivec3 cells = glm::max(glm::ivec3(glm::ceil((high - low) / spacing_mm)), 1);
  field.size = cells + 3;
  field.origin_mm = (low + high) / 2.0 - spacing_mm * (glm::dvec3(cells) / 2.0 + 1.0);
  field.control_mm.resize(std::size_t(field.size.x) * std::size_t(field.size.y) * std::size_t(field.size.z));
  return field;
}

double SplineProducts::value(const glm::ivec3& apart) {
  const glm::ivec3 n = glm::abs(apart);
  if (std::max({n.x, n.y, n.z}) > 3) return 0;
  return kValue[std::size_t(n.x)] * kValue[std::size_t(n.y)] * kValue[std::size_t(n.z)];
}

double SplineProducts::bending(const glm::ivec3& apart) {
  const glm::ivec3 n = glm::abs(apart);
  if (std::max({n.x, n.y, n.z}) > 3) return 0;
  const auto x = std::size_t(n.x), y = std::size_t(n.y), z = std::size_t(n.z);
  return kSecond[x] * kValue[y] * kValue[z] + kValue[x] * kSecond[y] * kValue[z] + kValue[x] * kValue[y] * kSecond[z] +
         2 * (kFirst[x] * kFirst[y] * kValue[z] + kFirst[x] * kValue[y] * kFirst[z] +
              kValue[x] * kFirst[y] * kFirst[z]);
}

SplineWeights weights_at(const FreeFormField& field, const glm::dvec3& p) {
  SplineWeights result;
  result.control.fill(-1);
  Around around;
  if (!find_around(field, p, around)) return result;
  for_each_control(field, around, [&](const glm::dvec3& control, std::size_t a, std::size_t b, std::size_t c) {
    const int x = around.x.first + int(a), y = around.y.first + int(b), z = around.z.first + int(c);
    const auto entry = std::size_t(x % 4 + 4 * (y % 4) + 16 * (z % 4));
    result.weight[entry] = float(around.x.value[a] * around.y.value[b] * around.z.value[c]);
    result.control[entry] = int(&control - field.control_mm.data());
  });
  return result;
}

}  // namespace insonate
