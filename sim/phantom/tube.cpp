#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/phantom/shapes.h"

namespace insonate {
namespace {

struct Segment {
  glm::vec3 from{0.0f}, along{0.0f};
  float per_length_squared = 0;
  float radius_from = 0, radius_to = 0;
  float flatness_from = 1, flatness_to = 1;
  Bounds bounds;
};

glm::vec3 catmull_rom(const glm::vec3& before, const glm::vec3& from, const glm::vec3& to, const glm::vec3& after,
                      float t) {
  return from + 0.5f * t *
                    ((to - before) + t * ((2.0f * before - 5.0f * from + 4.0f * to - after) +
                                          t * (3.0f * (from - to) + after - before)));
}

}  // namespace

Strand centre_line(const std::vector<TubePoint>& points, const TubeForm& form) {
  if (!form.smooth && form.bead_mm == 0) return points;
  Strand beads{points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const TubePoint &from = points[i], &to = points[i + 1];
    const glm::vec3 before = i == 0 ? 2.0f * from.position - to.position : points[i - 1].position;
    const glm::vec3 after = i + 2 < points.size() ? points[i + 2].position : 2.0f * to.position - from.position;
    constexpr float kStep_mm = 3.0f;
    const int steps = std::max(1, int(std::ceil(glm::length(to.position - from.position) / kStep_mm)));
    for (int step = 1; step <= steps; ++step) {
      const float t = float(step) / float(steps);
      // The section eases in and out, so that it has no kink at a point.
      const float eased = t * t * (3.0f - 2.0f * t);
      beads.push_back({form.smooth ? catmull_rom(before, from.position, to.position, after, t)
                                   : glm::mix(from.position, to.position, t),
                       glm::mix(from.radius, to.radius, eased), glm::mix(from.flatness, to.flatness, eased)});
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

namespace {

void add_segments(const Strand& beads, const TubeForm& form, std::vector<Segment>& segments) {
  for (std::size_t i = 0; i + 1 < beads.size(); ++i) {
    Segment segment;
    segment.from = beads[i].position;
    segment.along = beads[i + 1].position - beads[i].position;
    segment.per_length_squared = 1.0f / std::max(glm::dot(segment.along, segment.along), 1e-9f);
    segment.radius_from = beads[i].radius;
    segment.radius_to = beads[i + 1].radius;
    segment.flatness_from = beads[i].flatness * form.flatness;
    segment.flatness_to = beads[i + 1].flatness * form.flatness;
    for (const TubePoint& bead : {beads[i], beads[i + 1]}) {
      segment.bounds.include(bead.position - bead.radius);
      segment.bounds.include(bead.position + bead.radius);
    }
    segments.push_back(segment);
  }
}

Bounds bounds_of(const std::vector<Segment>& segments) {
  Bounds bounds;
  for (const Segment& segment : segments) bounds = bounds.united(segment.bounds);
  return bounds;
}

class Tube : public Shape {
public:
  Tube(std::vector<Segment> segments, const TubeForm& form)
      : Shape(bounds_of(segments)), segments_(std::move(segments)), flat_towards_(form.flat_towards) {
    for (const Segment& segment : segments_)
      is_flat_ = is_flat_ || std::min(segment.flatness_from, segment.flatness_to) < 1.0f;
    constexpr std::size_t kTogether = 8;
    for (std::size_t begin = 0; begin < segments_.size(); begin += kTogether) {
      Stretch stretch{begin, std::min(begin + kTogether, segments_.size()), {}};
      for (std::size_t i = begin; i < stretch.end; ++i) stretch.bounds = stretch.bounds.united(segments_[i].bounds);
      stretches_.push_back(stretch);
    }
  }

  void distances(Points& points, float* out) const override {
    const std::vector<const Segment*> near = segments_near(points.bounds());
    if (near.empty()) {
      std::fill_n(out, points.count(), kRange_mm);
      return;
    }
    std::fill_n(out, points.count(), 1e6f);
    for (const Segment* segment : near)
      lower_to(*segment, points.x.data(), points.y.data(), points.z.data(), points.count(), out);
  }

private:
  // Returns the pieces of a long tube that matter for a block. Between the block's middle and any of its points a
  // distance changes by at most the half diagonal. A piece that is two half diagonals farther away than the nearest one
  // is therefore nowhere the nearest. Returns nothing if the whole tube is out of range.
  std::vector<const Segment*> segments_near(const Bounds& block) const {
    const glm::vec3 middle = 0.5f * (block.low + block.high);
    const float half_diagonal = glm::length(block.high - middle);
    const Bounds point{middle, middle};
    float nearest = kRange_mm + half_diagonal;
    std::vector<std::pair<float, const Segment*>> candidates;
    for (const Stretch& stretch : stretches_) {
      if (stretch.bounds.distance_to(point) > nearest + 2.0f * half_diagonal) continue;
      for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
        const float distance = distance_to(segments_[i], middle);
        nearest = std::min(nearest, distance);
        candidates.emplace_back(distance, &segments_[i]);
      }
    }
    std::vector<const Segment*> near;
    if (nearest >= kRange_mm + half_diagonal) return near;
    for (const auto& [distance, segment] : candidates)
      if (distance <= nearest + 2.0f * half_diagonal) near.push_back(segment);
    return near;
  }

  float distance_to(const Segment& segment, const glm::vec3& p) const {
    float distance = 1e6f;
    lower_to(segment, &p.x, &p.y, &p.z, 1, &distance);
    return distance;
  }

  // Lowers `out` to the segment's distances where these are smaller.
  void lower_to(const Segment& segment, const float* x, const float* y, const float* z, std::size_t count,
                float* out) const {
    if (is_flat_)
      lower_to<true>(segment, flat_towards_, x, y, z, count, out);
    else
      lower_to<false>(segment, flat_towards_, x, y, z, count, out);
  }

  // Everything is by value and without branches, so that the compiler vectorizes the loop.
  template <bool kFlat>
  [[gnu::flatten]] static void lower_to(const Segment segment, const glm::vec3 flat_towards, const float* x,
                                        const float* y, const float* z, std::size_t count, float* out) {
    for (std::size_t n = 0; n < count; ++n) {
      const glm::vec3 p(x[n], y[n], z[n]);
      const float distance = kFlat ? flat_distance(segment, flat_towards, p) : round_distance(segment, p);
      out[n] = distance < out[n] ? distance : out[n];
    }
  }

  // The nearest point of the segment's axis, and the tube's section there.
  struct Foot {
    glm::vec3 at;
    float radius, flatness;
  };

  static Foot foot_of(const Segment& segment, const glm::vec3& p) {
    const float t = std::clamp(glm::dot(p - segment.from, segment.along) * segment.per_length_squared, 0.0f, 1.0f);
    return {segment.from + t * segment.along, glm::mix(segment.radius_from, segment.radius_to, t),
            glm::mix(segment.flatness_from, segment.flatness_to, t)};
  }

  static float round_distance(const Segment& segment, const glm::vec3& p) {
    const Foot foot = foot_of(segment, p);
    return glm::length(p - foot.at) - foot.radius;
  }

  // The section is an ellipse of half axes radius and flatness * radius; its distance is exact to first order, as for
  // the ellipsoid.
  static float flat_distance(const Segment& segment, const glm::vec3& flat_towards, const glm::vec3& p) {
    const Foot foot = foot_of(segment, p);
    const glm::vec3 off = p - foot.at, look = flat_towards - foot.at;
    const glm::vec3 narrow = look / std::max(glm::length(look), 1e-3f);
    const float stretch = 1.0f / foot.flatness - 1.0f;
    const glm::vec3 stretched = off + narrow * (glm::dot(off, narrow) * stretch);
    const glm::vec3 twice = stretched + narrow * (glm::dot(stretched, narrow) * stretch);
    const float f = glm::length(stretched);
    const float beside = (f - foot.radius) * f / glm::length(twice), on_axis = -foot.radius * foot.flatness;
    return f < 1e-3f ? on_axis : beside;
  }

  // Neighbouring segments, tested one by one only if their common bounds are near.
  struct Stretch {
    std::size_t begin, end;
    Bounds bounds;
  };

  std::vector<Segment> segments_;
  std::vector<Stretch> stretches_;
  glm::vec3 flat_towards_;
  bool is_flat_ = false;
};

}  // namespace

ShapePtr make_tube(const std::vector<TubePoint>& points, const TubeForm& form) {
  return make_tubes({centre_line(points, form)}, form);
}

ShapePtr make_tubes(const std::vector<Strand>& strands, const TubeForm& form) {
  std::vector<Segment> segments;
  for (const Strand& strand : strands) add_segments(strand, form, segments);
  if (segments.empty()) return make_empty();
  return std::make_shared<Tube>(std::move(segments), form);
}

}  // namespace insonate
