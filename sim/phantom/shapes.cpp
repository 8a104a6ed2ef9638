#include "sim/phantom/shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace insonate {

void Bounds::include(const glm::vec3& p) {
  low = glm::min(low, p);
  high = glm::max(high, p);
}

Bounds Bounds::grown(float mm) const {
  return empty() ? *this : Bounds{low - mm, high + mm};
}

Bounds Bounds::united(const Bounds& other) const {
  if (empty()) return other;
  if (other.empty()) return *this;
  return {glm::min(low, other.low), glm::max(high, other.high)};
}

Bounds Bounds::intersected(const Bounds& other) const {
  return {glm::max(low, other.low), glm::min(high, other.high)};
}

float Bounds::distance_to(const Bounds& other) const {
  if (empty() || other.empty()) return 1e6f;
  return glm::length(glm::max(glm::max(low - other.high, other.low - high), glm::vec3(0.0f)));
}

Points::Points(std::vector<float> x_mm, std::vector<float> y_mm, std::vector<float> z_mm)
    : x(std::move(x_mm)), y(std::move(y_mm)), z(std::move(z_mm)) {
  const auto [low_x, high_x] = std::minmax_element(x.begin(), x.end());
  const auto [low_y, high_y] = std::minmax_element(y.begin(), y.end());
  const auto [low_z, high_z] = std::minmax_element(z.begin(), z.end());
  bounds_ = {{*low_x, *low_y, *low_z}, {*high_x, *high_y, *high_z}};
  if (count() == 1) return;
  // A true distance changes by at most the distance moved. One that is exact to first order may change a little faster.
  constexpr float kSteepest = 2.0f;
  const glm::vec3 middle = 0.5f * (bounds_.low + bounds_.high);
  slack_mm_ = kSteepest * glm::length(bounds_.high - middle);
  middle_ = std::make_unique<Points>(std::vector{middle.x}, std::vector{middle.y}, std::vector{middle.z});
}

DistanceRange Points::range_of(const Shape& shape) {
  const float way = bounds_.distance_to(shape.bounds());
  if (way > kRange_mm) return {way, way};
  const float distance = middle_ ? middle_->distances_to(shape)[0] : distances_to(shape)[0];
  return {distance - slack_mm_, distance + slack_mm_};
}

const std::vector<float>& Points::distances_to(const Shape& shape) {
  const auto found = measured_.find(&shape);
  if (found != measured_.end()) return found->second;
  std::vector<float> values(count());
  const float way = bounds_.distance_to(shape.bounds());
  DistanceRange range{way, way};
  if (way <= kRange_mm && middle_) range = range_of(shape);
  if (range.least > kRange_mm)
    std::fill(values.begin(), values.end(), range.least);
  else if (middle_ && range.most < -kRange_mm)
    std::fill(values.begin(), values.end(), range.most);
  else
    shape.distances(*this, values.data());
  return measured_[&shape] = std::move(values);
}

namespace {

class Empty : public Shape {
public:
  Empty() : Shape(Bounds{}) {}
  void distances(Points& points, float* out) const override { std::fill_n(out, points.count(), 1e6f); }
};

// To first order in the distance: (f - 1) / |grad f| for the scaled radius f = |p / r|.
float ellipsoid_distance(const glm::vec3& p, const glm::vec3& radii) {
  const glm::vec3 scaled = p / radii;
  const float f = glm::length(scaled);
  const float slope = glm::length(scaled / radii);
  const float shortest = std::min({radii.x, radii.y, radii.z});
  return slope < 1e-6f ? -shortest : std::max(f * (f - 1.0f) / slope, -shortest);
}

class Ellipsoid : public Shape {
public:
  Ellipsoid(const glm::vec3& centre, const glm::vec3& radii)
      : Shape({centre - radii, centre + radii}), centre_(centre), radii_(radii) {}

  void distances(Points& points, float* out) const override {
    for (std::size_t n = 0; n < points.count(); ++n)
      out[n] = ellipsoid_distance(glm::vec3(points.x[n], points.y[n], points.z[n]) - centre_, radii_);
  }

private:
  glm::vec3 centre_, radii_;
};

class Box : public Shape {
public:
  Box(const glm::vec3& centre, const glm::vec3& half_sizes, float rounding)
      : Shape({centre - half_sizes, centre + half_sizes}),
        centre_(centre),
        core_(half_sizes - rounding),
        rounding_(rounding) {}

  void distances(Points& points, float* out) const override {
    for (std::size_t n = 0; n < points.count(); ++n) {
      const glm::vec3 q = glm::abs(glm::vec3(points.x[n], points.y[n], points.z[n]) - centre_) - core_;
      out[n] = glm::length(glm::max(q, glm::vec3(0.0f))) + std::min(std::max({q.x, q.y, q.z}), 0.0f) - rounding_;
    }
  }

private:
  glm::vec3 centre_, core_;
  float rounding_;
};

class HalfSpace : public Shape {
public:
  HalfSpace(const glm::vec3& point, const glm::vec3& normal)
      : Shape(kEverywhere), normal_(glm::normalize(normal)), level_(glm::dot(normal_, point)) {}

  void distances(Points& points, float* out) const override {
    for (std::size_t n = 0; n < points.count(); ++n)
      out[n] = glm::dot(normal_, glm::vec3(points.x[n], points.y[n], points.z[n])) - level_;
  }

private:
  glm::vec3 normal_;
  float level_;
};

class Loft : public Shape {
public:
  explicit Loft(const LoftForm& form)
      : Shape(bounds_of(form)),
        z_low_(form.sections.front().z),
        z_high_(form.sections.back().z),
        squareness_(form.squareness) {
    const int steps = int(std::ceil((z_high_ - z_low_) / kStep_mm));
    for (int step = 0; step <= steps; ++step) outlines_.push_back(form.section_at(z_low_ + kStep_mm * float(step)));
  }

  void distances(Points& points, float* out) const override {
    for (std::size_t n = 0; n < points.count(); ++n) {
      const float z = points.z[n];
      const float step = std::clamp((z - z_low_) / kStep_mm, 0.0f, float(outlines_.size() - 1));
      const std::size_t i = std::min(std::size_t(step), outlines_.size() - 2);
      const float t = step - float(i);
      const LoftSection &a = outlines_[i], &b = outlines_[i + 1];
      const float x = std::abs(points.x[n] - glm::mix(a.x, b.x, t)) / glm::mix(a.half_width, b.half_width, t);
      const float dy = points.y[n] - glm::mix(a.y, b.y, t);
      const float depth = dy < 0 ? glm::mix(a.front, b.front, t) : glm::mix(a.back, b.back, t);
      const float y = std::abs(dy) / depth;
      const float side = outline_distance(x, y, glm::mix(a.half_width, b.half_width, t), depth);
      out[n] = std::max({side, z_low_ - z, z - z_high_});
    }
  }

private:
  static constexpr float kStep_mm = 1.0f;

  // As for the ellipsoid, with f = (x^n + y^n)^(1/n), whose derivatives are (x/f)^(n-1) and (y/f)^(n-1).
  float outline_distance(float x, float y, float width, float depth) const {
    const float n = squareness_;
    const float x_n = n == 2.0f ? x * x : std::pow(x, n), y_n = n == 2.0f ? y * y : std::pow(y, n), sum = x_n + y_n;
    const float f = n == 2.0f ? std::sqrt(sum) : std::pow(sum, 1.0f / n);
    const float shortest = std::min(width, depth);
    if (f < 1e-3f) return -shortest;
    // (x/f)^(n-1) = x^n / f^n * f / x, without another power.
    const float fx = x > 0 ? x_n / sum * f / x : 0.0f, fy = y > 0 ? y_n / sum * f / y : 0.0f;
    return std::max((f - 1.0f) / std::sqrt(fx * fx / (width * width) + fy * fy / (depth * depth)), -shortest);
  }

  static Bounds bounds_of(const LoftForm& form) {
    Bounds bounds;
    const float top = form.sections.back().z;
    const float bottom = form.sections.front().z;
    const int steps = int(std::ceil((top - bottom) / kStep_mm));
    for (int step = 0; step <= steps; ++step) {
      const float z = bottom + kStep_mm * float(step);
      const LoftSection s = form.section_at(z);
      bounds.include({s.x - s.half_width, s.y - s.front, std::min(z, top)});
      bounds.include({s.x + s.half_width, s.y + s.back, std::min(z, top)});
    }
    return bounds.grown(0.5f);
  }

  float z_low_, z_high_, squareness_;
  std::vector<LoftSection> outlines_;  // every kStep_mm from z_low_ up
};

}  // namespace

LoftSection LoftForm::section_at(float z) const {
  std::size_t i = 0;
  while (i + 2 < sections.size() && sections[i + 1].z < z) ++i;
  const LoftSection &from = sections[i], &to = sections[i + 1];
  const LoftSection& before = sections[i == 0 ? 0 : i - 1];
  const LoftSection& after = sections[std::min(i + 2, sections.size() - 1)];
  const float t = std::clamp((z - from.z) / (to.z - from.z), 0.0f, 1.0f);
  // A cubic Hermite spline with slopes for unevenly spaced sections.
  const auto at = [&](float LoftSection::*member) {
    const float width = to.z - from.z;
    const auto slope = [&](const LoftSection& a, const LoftSection& b) {
      return b.z > a.z ? (b.*member - a.*member) / (b.z - a.z) * width : 0.0f;
    };
    const float start = slope(before, to), end = slope(from, after);
    const float rise = to.*member - from.*member;
    return from.*member + t * (start + t * (3.0f * rise - 2.0f * start - end + t * (start + end - 2.0f * rise)));
  };
  const auto length = [&](float LoftSection::*member) { return std::max(at(member), 0.5f); };
  return {z,
          at(&LoftSection::x),
          at(&LoftSection::y),
          length(&LoftSection::half_width),
          length(&LoftSection::front),
          length(&LoftSection::back)};
}

glm::vec3 LoftForm::outline_point(float angle_deg, float z, float inset_mm) const {
  const LoftSection s = section_at(z);
  const float angle = glm::radians(angle_deg), c = std::cos(angle), d = std::sin(angle);
  const float depth = d < 0 ? s.front : s.back;
  const float scale = std::pow(
      std::pow(std::abs(c) / s.half_width, squareness) + std::pow(std::abs(d) / depth, squareness), -1.0f / squareness);
  return {s.x + c * (scale - inset_mm), s.y + d * (scale - inset_mm), z};
}

ShapePtr make_empty() {
  return std::make_shared<Empty>();
}

ShapePtr make_ellipsoid(const glm::vec3& centre, const glm::vec3& radii) {
  return std::make_shared<Ellipsoid>(centre, radii);
}

ShapePtr make_box(const glm::vec3& centre, const glm::vec3& half_sizes, float rounding_mm) {
  return std::make_shared<Box>(centre, half_sizes, rounding_mm);
}

ShapePtr make_half_space(const glm::vec3& point, const glm::vec3& normal) {
  return std::make_shared<HalfSpace>(point, normal);
}

ShapePtr make_loft(const LoftForm& form) {
  return std::make_shared<Loft>(form);
}

}  // namespace insonate
