#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include "sim/phantom/shapes.h"
#include "sim/phantom/texture.h"

namespace insonate {

glm::vec3 Frame::part_from_patient(const glm::vec3& p) const {
  const glm::vec3 q = (p - origin) * rotation;  // row vector times matrix: the transpose, which is the inverse
  return {flipped ? -q.x : q.x, q.y, q.z};
}

namespace {

// Returns the smaller of two distances, with the seam between them filled over `blend` (Quilez's quadratic polynomial
// form).
float smooth_min(float a, float b, float blend) {
  if (blend <= 0) return std::min(a, b);
  const float h = std::max(blend - std::abs(a - b), 0.0f) / blend;
  return std::min(a, b) - h * h * blend * 0.25f;
}

// Further cuts only move these points farther outside.
bool out_of_reach(const Points& points, const float* distances) {
  return *std::min_element(distances, distances + points.count()) > kRange_mm;
}

class Union : public Shape {
public:
  Union(std::vector<ShapePtr> parts, float blend)
      : Shape(bounds_of(parts).grown(blend * 0.25f)), parts_(std::move(parts)), blend_(blend) {}

  void distances(Points& points, float* out) const override {
    std::fill_n(out, points.count(), 1e6f);
    for (const ShapePtr& part : parts_) {
      const std::vector<float>& d = points.distances_to(*part);
      for (std::size_t n = 0; n < d.size(); ++n) out[n] = smooth_min(out[n], d[n], blend_);
    }
  }

private:
  static Bounds bounds_of(const std::vector<ShapePtr>& parts) {
    Bounds bounds;
    for (const ShapePtr& part : parts) bounds = bounds.united(part->bounds());
    return bounds;
  }
  std::vector<ShapePtr> parts_;
  float blend_;
};

class Apart : public Shape {
public:
  Apart(std::vector<ShapePtr> parts, float gap) : Shape(bounds_of(parts)), parts_(std::move(parts)), gap_(gap) {}

  void distances(Points& points, float* out) const override {
    std::vector<float> second(points.count(), 1e6f);
    std::fill_n(out, points.count(), 1e6f);
    for (const ShapePtr& part : parts_) {
      const std::vector<float>& d = points.distances_to(*part);
      for (std::size_t n = 0; n < d.size(); ++n) {
        second[n] = std::min(second[n], std::max(out[n], d[n]));
        out[n] = std::min(out[n], d[n]);
      }
    }
    // Midway between two parts their distances are equal, and the difference grows by 2 per mm away from there.
    for (std::size_t n = 0; n < points.count(); ++n) out[n] = std::max(out[n], 0.5f * (gap_ - (second[n] - out[n])));
  }

private:
  static Bounds bounds_of(const std::vector<ShapePtr>& parts) {
    Bounds bounds;
    for (const ShapePtr& part : parts) bounds = bounds.united(part->bounds());
    return bounds;
  }
  std::vector<ShapePtr> parts_;
  float gap_;
};

class Intersection : public Shape {
public:
  Intersection(std::vector<ShapePtr> parts, float blend)
      : Shape(bounds_of(parts)), parts_(std::move(parts)), blend_(blend) {}

  void distances(Points& points, float* out) const override {
    std::fill_n(out, points.count(), -1e6f);
    for (const ShapePtr& part : parts_) {
      const std::vector<float>& d = points.distances_to(*part);
      for (std::size_t n = 0; n < d.size(); ++n) out[n] = -smooth_min(-out[n], -d[n], blend_);
      if (out_of_reach(points, out)) return;
    }
  }

private:
  static Bounds bounds_of(const std::vector<ShapePtr>& parts) {
    Bounds bounds = kEverywhere;
    for (const ShapePtr& part : parts) bounds = bounds.intersected(part->bounds());
    return bounds;
  }
  std::vector<ShapePtr> parts_;
  float blend_;
};

class Difference : public Shape {
public:
  Difference(ShapePtr from, std::vector<ShapePtr> cuts, float gap, float blend)
      : Shape(from->bounds()), from_(std::move(from)), cuts_(std::move(cuts)), gap_(gap), blend_(blend) {}

  void distances(Points& points, float* out) const override {
    const std::vector<float>& whole = points.distances_to(*from_);
    std::copy(whole.begin(), whole.end(), out);
    if (out_of_reach(points, out)) return;
    for (const ShapePtr& cut : cuts_) {
      const std::vector<float>& d = points.distances_to(*cut);
      for (std::size_t n = 0; n < d.size(); ++n) out[n] = -smooth_min(-out[n], d[n] - gap_, blend_);
    }
  }

private:
  ShapePtr from_;
  std::vector<ShapePtr> cuts_;
  float gap_, blend_;
};

class Shell : public Shape {
public:
  Shell(ShapePtr of, float inner, float outer)
      : Shape(of->bounds().grown(outer)), of_(std::move(of)), inner_(inner), outer_(outer) {}

  void distances(Points& points, float* out) const override {
    const std::vector<float>& d = points.distances_to(*of_);
    for (std::size_t n = 0; n < d.size(); ++n) out[n] = std::max(d[n] - outer_, inner_ - d[n]);
  }

private:
  ShapePtr of_;
  float inner_, outer_;
};

class Placed : public Shape {
public:
  Placed(ShapePtr part, const Frame& frame) : Shape(bounds_of(*part, frame)), part_(std::move(part)), frame_(frame) {}

  void distances(Points& points, float* out) const override {
    std::vector<float> x(points.count()), y(points.count()), z(points.count());
    for (std::size_t n = 0; n < points.count(); ++n) {
      const glm::vec3 p = frame_.part_from_patient({points.x[n], points.y[n], points.z[n]});
      x[n] = p.x;
      y[n] = p.y;
      z[n] = p.z;
    }
    Points local(std::move(x), std::move(y), std::move(z));
    const std::vector<float>& d = local.distances_to(*part_);
    std::copy(d.begin(), d.end(), out);
  }

private:
  static Bounds bounds_of(const Shape& part, const Frame& frame) {
    const Bounds& own = part.bounds();
    if (own.empty() || own.high.x >= kEverywhere.high.x) return own;
    Bounds bounds;
    for (int corner = 0; corner < 8; ++corner)
      bounds.include(frame.patient_from_part({(corner & 1) != 0 ? own.high.x : own.low.x,
                                              (corner & 2) != 0 ? own.high.y : own.low.y,
                                              (corner & 4) != 0 ? own.high.z : own.low.z}));
    return bounds;
  }

  ShapePtr part_;
  Frame frame_;
};

class Uneven : public Shape {
public:
  Uneven(ShapePtr shape, float amplitude, float grain, std::uint32_t seed)
      : Shape(shape->bounds().grown(kLimit * amplitude)),
        shape_(std::move(shape)),
        amplitude_(amplitude),
        texture_(seed, grain) {}

  void distances(Points& points, float* out) const override {
    const std::vector<float>& d = points.distances_to(*shape_);
    const float near = kLimit * amplitude_ + 2.0f;  // bumps farther from the surface would be invisible
    std::vector<std::size_t> bumpy;
    for (std::size_t n = 0; n < d.size(); ++n) {
      out[n] = d[n];
      if (std::abs(d[n]) <= near) bumpy.push_back(n);
    }
    const std::vector<float> bumps = texture_.at(points, bumpy);
    for (std::size_t n = 0; n < bumpy.size(); ++n) out[bumpy[n]] += amplitude_ * std::clamp(bumps[n], -kLimit, kLimit);
  }

private:
  static constexpr float kLimit = 2.5f;  // standard deviations
  ShapePtr shape_;
  float amplitude_;
  Texture texture_;
};

}  // namespace

ShapePtr make_union(std::vector<ShapePtr> parts, float blend_mm) {
  return std::make_shared<Union>(std::move(parts), blend_mm);
}

ShapePtr make_apart(std::vector<ShapePtr> parts, float gap_mm) {
  return std::make_shared<Apart>(std::move(parts), gap_mm);
}

ShapePtr make_intersection(std::vector<ShapePtr> parts, float blend_mm) {
  return std::make_shared<Intersection>(std::move(parts), blend_mm);
}

ShapePtr make_difference(ShapePtr from, std::vector<ShapePtr> cuts, float gap_mm, float blend_mm) {
  return std::make_shared<Difference>(std::move(from), std::move(cuts), gap_mm, blend_mm);
}

ShapePtr make_shell(ShapePtr of, float inner_mm, float outer_mm) {
  return std::make_shared<Shell>(std::move(of), inner_mm, outer_mm);
}

ShapePtr make_offset(ShapePtr of, float by_mm) {
  return std::make_shared<Shell>(std::move(of), -1e6f, by_mm);
}

ShapePtr make_placed(ShapePtr part, const Frame& frame) {
  return std::make_shared<Placed>(std::move(part), frame);
}

ShapePtr make_uneven(ShapePtr shape, float amplitude_mm, float grain_mm, std::uint32_t seed) {
  return std::make_shared<Uneven>(std::move(shape), amplitude_mm, grain_mm, seed);
}

}  // namespace insonate
