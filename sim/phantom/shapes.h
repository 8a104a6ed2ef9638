#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace insonate {

/// An axis-aligned box, mm. Empty if low > high along any axis.
struct Bounds {
  glm::vec3 low{1e9f};
  glm::vec3 high{-1e9f};

  bool empty() const { return low.x > high.x || low.y > high.y || low.z > high.z; }
  void include(const glm::vec3& p);
  Bounds grown(float mm) const;
  Bounds united(const Bounds& other) const;
  Bounds intersected(const Bounds& other) const;
  /// Returns the shortest distance between the boxes, mm: 0 where they overlap, 1e6 if either is empty.
  float distance_to(const Bounds& other) const;
};

inline constexpr Bounds kEverywhere{glm::vec3(-1e6f), glm::vec3(1e6f)};

/// The largest range of any blend, gap or offset, mm. Where a surface is farther away than that, any distance between
/// this one and the true one is good enough.
inline constexpr float kRange_mm = 30.0f;

class Points;

/// A solid, defined by its signed distance in mm, negative inside. The distance is exact to first order near the
/// surface, which is all that partial volume, gaps and shells need. Farther away only the ordering of distances holds.
class Shape {
public:
  explicit Shape(const Bounds& bounds) : bounds_(bounds) {}
  virtual ~Shape() = default;
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;

  /// The distance is positive outside these bounds.
  const Bounds& bounds() const { return bounds_; }

  /// Writes points.count() distances to `out`, mm.
  virtual void distances(Points& points, float* out) const = 0;

private:
  Bounds bounds_;
};

using ShapePtr = std::shared_ptr<const Shape>;

/// The range of a shape's distances over all points of a block, mm.
struct DistanceRange {
  float least = 0, most = 0;
};

/// A block of points at which shapes are measured together. It caches the results: a shape that five others keep clear
/// of is measured once per block. Used by one thread.
class Points {
public:
  /// Takes one coordinate per point from each vector; at least one point.
  Points(std::vector<float> x_mm, std::vector<float> y_mm, std::vector<float> z_mm);

  std::size_t count() const { return x.size(); }
  const Bounds& bounds() const { return bounds_; }

  /// Returns a range computed from the distance at the block's middle alone: most blocks lie wholly inside or outside
  /// most shapes.
  DistanceRange range_of(const Shape& shape);

  /// Returns the shape's signed distances at the points, mm. Where the whole block is farther than kRange_mm from the
  /// surface, it returns a value between that and the true distance. The reference is valid as long as this object.
  const std::vector<float>& distances_to(const Shape& shape);

  const std::vector<float> x, y, z;

private:
  Bounds bounds_;
  float slack_mm_ = 0;  // largest difference between a distance and the one at the block's middle
  std::unique_ptr<Points> middle_;
  std::unordered_map<const Shape*, std::vector<float>> measured_;
};

// --- Solids of their own ---------------------------------------------------------------------------------------------

/// Returns a shape without points.
ShapePtr make_empty();
/// @param centre, radii  mm
ShapePtr make_ellipsoid(const glm::vec3& centre, const glm::vec3& radii);
/// @param centre, half_sizes  mm
/// @param rounding_mm         radius of the edges; 0: sharp
ShapePtr make_box(const glm::vec3& centre, const glm::vec3& half_sizes, float rounding_mm);

/// Returns the half space on the side of the plane opposite to `normal`, which may have any length.
ShapePtr make_half_space(const glm::vec3& point, const glm::vec3& normal);

/// A point of a tube's centre line, with the tube's section there, mm.
struct TubePoint {
  glm::vec3 position{0.0f};
  float radius = 1.0f;
  float flatness = 1.0f;  ///< multiplies that of the form, 0.1 to 1
};

/// The centre line of a vessel between its ends.
using Strand = std::vector<TubePoint>;

/// The form of a tube around its centre line.
struct TubeForm {
  bool smooth = true;        ///< Catmull-Rom spline through the points, else straight pieces between them
  float flatness = 1.0f;     ///< extent of the section towards `flat_towards` as a share of its radius, 0.1 to 1
  glm::vec3 flat_towards{};  ///< patient point that the flattened sides face, mm
  float bead_mm = 0.0f;      ///< length of a haustrum or fold along the tube; 0 for a plain tube
  float bead_depth = 0.0f;   ///< narrowing between two of these, as a share of the radius, 0 to 0.5
};

/// Returns the centre line of a tube with at least two points: its spline in steps so short that straight pieces
/// between them are indistinguishable from it.
Strand centre_line(const std::vector<TubePoint>& points, const TubeForm& form);

/// Returns a tube with round ends through at least two points; its section is interpolated between them.
ShapePtr make_tube(const std::vector<TubePoint>& points, const TubeForm& form);

/// Returns one solid of many tubes, whose centre lines consist of straight pieces; empty without strands.
ShapePtr make_tubes(const std::vector<Strand>& strands, const TubeForm& form = {});

/// An ellipse-like section of a loft: an outline in the axial plane, mm.
struct LoftSection {
  float z = 0;
  float x = 0, y = 0;         ///< centre
  float half_width = 1;       ///< along x
  float front = 1, back = 1;  ///< from the centre towards -y and +y
};

/// A body through outlines stacked along z, joined smoothly and cut flat at both ends.
struct LoftForm {
  std::vector<LoftSection> sections;  ///< at least two, z rising
  float squareness = 2.0f;            ///< exponent of the superellipse: 2 is an ellipse, higher is squarer

  /// Returns the interpolated section at height z; the end sections beyond the ends.
  LoftSection section_at(float z) const;

  /// Returns the point of the outline at height z, in the direction `angle_deg` from the section's centre (0 towards
  /// +x, 90 towards +y), moved by `inset_mm` towards the centre.
  glm::vec3 outline_point(float angle_deg, float z, float inset_mm) const;
};

/// Returns the body. The caller has checked the form.
ShapePtr make_loft(const LoftForm& form);

// --- Solids made of others -------------------------------------------------------------------------------------------

/// `blend_mm` rounds the seam over that length; 0 leaves it sharp. `gap_mm` is the distance kept from the cuts.
ShapePtr make_union(std::vector<ShapePtr> parts, float blend_mm);
/// Returns the union of parts that overlap, with a gap of about `gap_mm` midway between any two of them.
ShapePtr make_apart(std::vector<ShapePtr> parts, float gap_mm);
ShapePtr make_intersection(std::vector<ShapePtr> parts, float blend_mm);
ShapePtr make_difference(ShapePtr from, std::vector<ShapePtr> cuts, float gap_mm, float blend_mm);

/// Returns the points between two distances to a shape: make_shell(s, -2, 0) is a skin of 2 mm on its inside.
ShapePtr make_shell(ShapePtr of, float inner_mm, float outer_mm);
/// Returns the shape grown by `by_mm`; a negative value shrinks it.
ShapePtr make_offset(ShapePtr of, float by_mm);

/// Places a part's own coordinates in the patient.
struct Frame {
  glm::mat3 rotation{1.0f};  ///< column c is the patient direction of the part's axis c
  glm::vec3 origin{0.0f};
  bool flipped = false;  ///< x is mirrored in the part's own coordinates, before the rotation

  glm::vec3 patient_from_part(const glm::vec3& p) const {
    return rotation * glm::vec3(flipped ? -p.x : p.x, p.y, p.z) + origin;
  }
  glm::vec3 part_from_patient(const glm::vec3& p) const;
};

/// Returns the part at its place in the patient.
ShapePtr make_placed(ShapePtr part, const Frame& frame);

/// Returns the shape with its surface moved in and out by about `amplitude_mm` (a standard deviation), in bumps of
/// `grain_mm`.
ShapePtr make_uneven(ShapePtr shape, float amplitude_mm, float grain_mm, std::uint32_t seed);

}  // namespace insonate
