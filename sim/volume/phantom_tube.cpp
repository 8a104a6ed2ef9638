#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/volume/phantom_shapes.h"

namespace insonate {
namespace {

struct Segment {
  glm::vec3 from{0.0f}, along{0.0f};
  float per_length_squared = 0;
  float radius_from = 0, radius_to = 0;
  Bounds bounds;
};

glm::vec3 catmull_rom(const glm::vec3& before, const glm::vec3& from, const glm::vec3& to, const glm::vec3& after,
                      float t) {
  return from + 0.5f * t *
                    ((to - before) + t * ((2.0f * before - 5.0f * from + 4.0f * to - after) +
                                          t * (3.0f * (from - to) + after - before)));
}

// The spline as beads close enough that the straight pieces between them cannot be told from it.
std::vector<TubePoint> beads_along(const std::vector<TubePoint>& points, const TubeForm& form) {
  if (!form.smooth && form.bead_mm == 0) return points;
  std::vector<TubePoint> beads{points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const TubePoint &from = points[i], &to = points[i + 1];
    const glm::vec3 before = i == 0 ? 2.0f * from.position - to.position : points[i - 1].position;
    const glm::vec3 after = i + 2 < points.size() ? points[i + 2].position : 2.0f * to.position - from.position;
    constexpr float kStep_mm = 3.0f;
    const int steps = std::max(1, int(std::ceil(glm::length(to.position - from.position) / kStep_mm)));
    for (int step = 1; step <= steps; ++step) {
      const float t = float(step) / float(steps);
      // The radius eases in and out, so that it has no kink at a point either.
      const float eased = t * t * (3.0f - 2.0f * t);
      beads.push_back({form.smooth ? catmull_rom(before, from.position, to.position, after, t)
                                   : glm::mix(from.position, to.position, t),
                       glm::mix(from.radius, to.radius, eased)});
    }
  }
  if (form.bead_mm > 0) {
    float length = 0;
    for (std::size_t i = 0; i < beads.size(); ++i) {
      if (i > 0) length += glm::length(beads[i].position - beads[i - 1].position);
      const float phase = std::abs(std::sin(std::numbers::pi_v<float> * length / form.bead_mm));
      beads[i].radius *= 1.0f - form.bead_depth * (1.0f - phase) * (1.0f - phase);
    }
  }
  return beads;
}

std::vector<Segment> segments_between(const std::vector<TubePoint>& beads) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i + 1 < beads.size(); ++i) {
    Segment segment;
    segment.from = beads[i].position;
    segment.along = beads[i + 1].position - beads[i].position;
    segment.per_length_squared = 1.0f / std::max(glm::dot(segment.along, segment.along), 1e-9f);
    segment.radius_from = beads[i].radius;
    segment.radius_to = beads[i + 1].radius;
    for (const TubePoint& bead : {beads[i], beads[i + 1]}) {
      segment.bounds.include(bead.position - bead.radius);
      segment.bounds.include(bead.position + bead.radius);
    }
    segments.push_back(segment);
  }
  return segments;
}

Bounds bounds_of(const std::vector<Segment>& segments) {
  Bounds bounds;
  for (const Segment& segment : segments) bounds = bounds.united(segment.bounds);
  return bounds;
}

class Tube : public Shape {
public:
  Tube(std::vector<Segment> segments, const TubeForm& form)
      : Shape(bounds_of(segments)), segments_(std::move(segments)), form_(form) {}

  void distances(Points& points, float* out) const override {
    // Of a long tube only the pieces near the block matter: a point in the block is at most the block's diagonal
    // further from the nearest piece than that piece's bounds are from the block.
    const Bounds& block = points.bounds();
    float nearest = 1e9f, thickest = 0;
    for (const Segment& segment : segments_) {
      nearest = std::min(nearest, segment.bounds.distance_to(block));
      thickest = std::max({thickest, segment.radius_from, segment.radius_to});
    }
    const float reach = nearest + glm::length(block.high - block.low) + 4.0f * thickest;
    std::vector<const Segment*> near;
    for (const Segment& segment : segments_)
      if (segment.bounds.distance_to(block) <= reach) near.push_back(&segment);

    for (std::size_t n = 0; n < points.count(); ++n) {
      const glm::vec3 p(points.x[n], points.y[n], points.z[n]);
      float distance = 1e6f;
      for (const Segment* segment : near) distance = std::min(distance, distance_to(*segment, p));
      out[n] = distance;
    }
  }

private:
  float distance_to(const Segment& segment, const glm::vec3& p) const {
    const float t = std::clamp(glm::dot(p - segment.from, segment.along) * segment.per_length_squared, 0.0f, 1.0f);
    const glm::vec3 foot = segment.from + t * segment.along;
    const float radius = glm::mix(segment.radius_from, segment.radius_to, t);
    const glm::vec3 off = p - foot;
    if (form_.flatness == 1.0f) return glm::length(off) - radius;
    // An ellipse of half axes radius and flatness * radius, to first order as for the ellipsoid.
    const glm::vec3 look = form_.flat_towards - foot;
    const glm::vec3 narrow = look / std::max(glm::length(look), 1e-3f);
    const float across = glm::dot(off, narrow);
    const glm::vec3 stretched = off + narrow * (across * (1.0f / form_.flatness - 1.0f));
    const float f = glm::length(stretched);
    if (f < 1e-3f) return -radius * form_.flatness;
    const glm::vec3 twice = stretched + narrow * (glm::dot(stretched, narrow) * (1.0f / form_.flatness - 1.0f));
    return (f - radius) * f / glm::length(twice);
  }

  std::vector<Segment> segments_;
  TubeForm form_;
};

}  // namespace

ShapePtr make_tube(const std::vector<TubePoint>& points, const TubeForm& form) {
  return std::make_shared<Tube>(segments_between(beads_along(points, form)), form);
}

}  // namespace insonate
