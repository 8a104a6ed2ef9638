#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace insonate {

/// A box along the axes, mm. Empty when low > high somewhere.
struct Bounds {
  glm::vec3 low{1e9f};
  glm::vec3 high{-1e9f};

  bool empty() const { return low.x > high.x || low.y > high.y || low.z > high.z; }
  void include(const glm::vec3& p);
  Bounds grown(float mm) const;
  Bounds united(const Bounds& other) const;
  Bounds intersected(const Bounds& other) const;
  /// The shortest way between the boxes, 0 where they overlap; large for an empty one.
  float distance_to(const Bounds& other) const;
};

inline constexpr Bounds kEverywhere{glm::vec3(-1e6f), glm::vec3(1e6f)};

/// No blend, gap or offset reaches further than this, so where a surface is more than that away, any distance between
/// this one and the true one will do.
inline constexpr float kReach_mm = 30.0f;

class Points;

/// A solid, known by its signed distance in mm: negative inside, exact to first order near the surface (which is all
/// that partial volume, gaps and shells need), no more than an ordering further off.
class Shape {
public:
  explicit Shape(const Bounds& bounds) : bounds_(bounds) {}
  virtual ~Shape() = default;
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;

  /// Outside of it the distance is positive.
  const Bounds& bounds() const { return bounds_; }

  /// Fills `out`, of points.count() values.
  virtual void distances(Points& points, float* out) const = 0;

private:
  Bounds bounds_;
};

using ShapePtr = std::shared_ptr<const Shape>;

/// Between what two numbers a shape's distances lie at all points of a block.
struct DistanceRange {
  float least = 0, most = 0;
};

/// A block of points at which shapes are measured together, and what was measured already: a shape that five others
/// keep clear of is measured once a block. Used by one thread.
class Points {
public:
  Points(std::vector<float> x_mm, std::vector<float> y_mm, std::vector<float> z_mm);

  std::size_t count() const { return x.size(); }
  const Bounds& bounds() const { return bounds_; }

  /// From the distance at the block's middle alone: most blocks lie wholly in or out of most shapes.
  DistanceRange range_of(const Shape& shape);

  /// The shape's signed distances at the points. Where all of the block is further than kReach_mm from the surface, a
  /// value between that and the distance. Good until the points go.
  const std::vector<float>& distances_to(const Shape& shape);

  const std::vector<float> x, y, z;

private:
  Bounds bounds_;
  float slack_mm_ = 0;  // by how much a distance may differ from the one at the block's middle
  std::unique_ptr<Points> middle_;
  std::unordered_map<const Shape*, std::vector<float>> measured_;
};

// --- Solids of their own ---------------------------------------------------------------------------------------------

ShapePtr make_empty();
ShapePtr make_ellipsoid(const glm::vec3& centre, const glm::vec3& radii);
ShapePtr make_box(const glm::vec3& centre, const glm::vec3& half_sizes, float rounding_mm);

/// Everything on the side of the plane that `normal` points away from.
ShapePtr make_half_space(const glm::vec3& point, const glm::vec3& normal);

/// A bead of a tube's centre line.
struct TubePoint {
  glm::vec3 position{0.0f};
  float radius = 1.0f;
};

struct TubeForm {
  bool smooth = true;        ///< a Catmull-Rom spline through the points, else straight from one to the next
  float flatness = 1.0f;     ///< the section's extent towards `flat_towards` as a share of its radius, 0.1 to 1
  glm::vec3 flat_towards{};  ///< a point that the flattened sides look at
  float bead_mm = 0.0f;      ///< the length of a haustrum or fold along the tube; 0 for a plain tube
  float bead_depth = 0.0f;   ///< how much narrower the tube is between two of them, as a share of its radius, 0 to 0.5
};

/// A round tube through at least two points, its radius running from one to the next, with round ends.
ShapePtr make_tube(const std::vector<TubePoint>& points, const TubeForm& form);

/// An ellipse-like section of a loft: an outline in the axial plane.
struct LoftSection {
  float z = 0;
  float x = 0, y = 0;         ///< centre
  float half_width = 1;       ///< along x
  float front = 1, back = 1;  ///< from the centre towards -y and +y
};

/// A body through outlines stacked along z, smoothly joined and cut flat at both ends.
struct LoftForm {
  std::vector<LoftSection> sections;  ///< at least two, z rising
  float squareness = 2.0f;            ///< the superellipse's exponent: 2 an ellipse, higher squarer

  LoftSection section_at(float z) const;

  /// The point of the outline at height z, seen from the section's centre under an angle (0 towards +x, 90 towards +y),
  /// and brought `inset_mm` towards the centre.
  glm::vec3 outline_point(float angle_deg, float z, float inset_mm) const;
};

ShapePtr make_loft(const LoftForm& form);

// --- Solids made of others -------------------------------------------------------------------------------------------

/// blend_mm rounds the seam over that length; 0 leaves it sharp.
ShapePtr make_union(std::vector<ShapePtr> parts, float blend_mm);
ShapePtr make_intersection(std::vector<ShapePtr> parts, float blend_mm);
ShapePtr make_difference(ShapePtr from, std::vector<ShapePtr> cuts, float gap_mm, float blend_mm);

/// What lies between two distances to a shape: make_shell(s, -2, 0) is a skin of 2 mm on its inside.
ShapePtr make_shell(ShapePtr of, float inner_mm, float outer_mm);
ShapePtr make_offset(ShapePtr of, float by_mm);

/// Where a part's own coordinates lie in the patient.
struct Frame {
  glm::mat3 rotation{1.0f};  ///< column c is the patient direction of the part's axis c
  glm::vec3 origin{0.0f};
  bool flipped = false;  ///< x mirrored in the part's own coordinates, before it is turned

  glm::vec3 patient_from_part(const glm::vec3& p) const {
    return rotation * glm::vec3(flipped ? -p.x : p.x, p.y, p.z) + origin;
  }
  glm::vec3 part_from_patient(const glm::vec3& p) const;
};

ShapePtr make_placed(ShapePtr part, const Frame& frame);

/// The surface moved in and out by about `amplitude_mm` (a standard deviation) with bumps of `grain_mm`.
ShapePtr make_uneven(ShapePtr shape, float amplitude_mm, float grain_mm, std::uint32_t seed);

}  // namespace insonate
