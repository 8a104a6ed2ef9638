#include "scenarios/caliper.h"

#include <glm/geometric.hpp>

#include <cmath>

#include "scenarios/words.h"

namespace insonate {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Axes {
  glm::dvec2 middle;
  glm::dvec2 first{1, 0}, other{0, 1};  ///< unit vectors
};

Axes axes_of(const Action& ellipse) {
  Axes axes;
  axes.middle = (ellipse.point(1) + ellipse.point(3)) / 2.0;
  if (const double length = caliper_length_mm(ellipse); length > 0) {
    axes.first = (ellipse.point(3) - ellipse.point(1)) / length;
    axes.other = {-axes.first.y, axes.first.x};
  }
  return axes;
}

}  // namespace

double caliper_length_mm(const Action& placed) {
  return glm::distance(placed.point(1), placed.point(3));
}

double ellipse_area_mm2(const Action& ellipse) {
  return kPi * caliper_length_mm(ellipse) / 2 * std::abs(ellipse.numbers[5]);
}

double ellipsoid_volume_ml(double first_mm, double second_mm, double third_mm) {
  return kPi / 6 * first_mm * second_mm * third_mm / 1000;
}

std::vector<glm::dvec2> handles(const Action& placed) {
  std::vector<glm::dvec2> found{placed.point(1), placed.point(3)};
  if (placed.kind == ActionKind::ellipse) {
    const Axes axes = axes_of(placed);
    for (const double side : {-1.0, 1.0}) found.push_back(axes.middle + side * placed.numbers[5] * axes.other);
  }
  return found;
}

Action with_handle_at(Action placed, std::size_t handle, const glm::dvec2& to) {
  if (handle < 2) {
    placed.numbers[1 + 2 * handle] = to.x;
    placed.numbers[2 + 2 * handle] = to.y;
  } else {
    const Axes axes = axes_of(placed);
    placed.numbers[5] = std::abs(glm::dot(to - axes.middle, axes.other));
  }
  return placed;
}

std::vector<glm::dvec2> outline(const Action& ellipse, std::size_t points) {
  const Axes axes = axes_of(ellipse);
  std::vector<glm::dvec2> found;
  for (std::size_t i = 0; i < points; ++i) {
    const double turn = 2 * kPi * double(i) / double(points);
    found.push_back(axes.middle + std::cos(turn) * caliper_length_mm(ellipse) / 2 * axes.first +
                    std::sin(turn) * ellipse.numbers[5] * axes.other);
  }
  return found;
}

std::string length_text(double mm) {
  return mm < 100 ? fixed(mm, 1) + " mm" : fixed(mm / 10, 2) + " cm";
}

std::string area_text(double mm2) {
  return fixed(mm2 / 100, 2) + " cm\u00b2";
}

std::string volume_text(double ml) {
  return fixed(ml, 0) + " ml";
}

std::string value_text(const Action& placed) {
  return placed.kind == ActionKind::ellipse ? area_text(ellipse_area_mm2(placed))
                                            : length_text(caliper_length_mm(placed));
}

}  // namespace insonate
