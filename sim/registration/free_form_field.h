#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace insonate {

/// A smooth displacement of points by control points on a regular grid: tensor products of uniform cubic B-splines
/// (D. Rueckert, L. I. Sonoda, C. Hayes, D. L. G. Hill, M. O. Leach, D. J. Hawkes, "Nonrigid registration using
/// free-form deformations: application to breast MR images", IEEE Transactions on Medical Imaging 18, 1999). With
/// u = (p - origin_mm) / spacing_mm and B the cubic B-spline with support (-2, 2)
///     d(p) = sum over i, j, k of c_ijk B(u.x - i) B(u.y - j) B(u.z - k)
/// Beyond the grid all c are 0. So the field has continuous second derivatives everywhere, and is 0 from 2 spacings
/// beyond the outermost control points on.
struct FreeFormField {
  glm::dvec3 origin_mm{0.0};           ///< of control point (0, 0, 0)
  double spacing_mm = 25;              ///< along all three axes, above 0
  glm::ivec3 size{0};                  ///< control points along the axes
  std::vector<glm::dvec3> control_mm;  ///< c, i fastest: size.x * size.y * size.z of them

  /// Returns d(p), mm.
  glm::dvec3 displacement(const glm::dvec3& p) const;
  /// Returns the derivative of p + d(p): column c holds the derivative along axis c.
  glm::dmat3 jacobian(const glm::dvec3& p) const;
  /// Returns p + d(p).
  glm::dvec3 at(const glm::dvec3& p) const { return p + displacement(p); }
  /// Returns the point that at() maps to `q`, within 1e-6 mm, by Newton's method. Throws std::runtime_error if it finds
  /// none, which a field whose least_jacobian() is well above 0 excludes.
  glm::dvec3 inverse(const glm::dvec3& q) const;

  /// Returns the least determinant of jacobian() where the field is not 0, over points that lie spacing_mm /
  /// kJacobianSteps apart along each axis. The field folds where it is negative. It is 1 where nothing is deformed.
  double least_jacobian() const;
  static constexpr int kJacobianSteps = 6;

  /// Returns the mean bending energy, mm^-2: the integral over all space of the squared second derivatives,
  /// |d_xx|^2 + |d_yy|^2 + |d_zz|^2 + 2 |d_xy|^2 + 2 |d_xz|^2 + 2 |d_yz|^2, divided by covered_mm3() (Rueckert 1999).
  double bending_energy() const;
  /// Returns the volume of the box in which every point has all of its 64 control points in the grid, mm^3.
  double covered_mm3() const;

  bool operator==(const FreeFormField&) const = default;
};

/// Returns a field of displacement 0 that covers the box around points.
/// @param points  at least one, mm
FreeFormField field_over(const std::vector<glm::dvec3>& points, double spacing_mm);

/// Integrals over the line of products of two cubic B-splines, of their first and of their second derivatives, whose
/// centres are 0 to 3 apart in units of the spacing. They are those of the B-spline of degree 7 and its derivatives at
/// whole numbers (M. Unser, "Splines: a perfect fit for signal and image processing", IEEE Signal Processing Magazine
/// 16, 1999).
struct SplineProducts {
  static constexpr std::array<double, 4> kValue{2416.0 / 5040, 1191.0 / 5040, 120.0 / 5040, 1.0 / 5040},
      kFirst{2.0 / 3, -1.0 / 8, -1.0 / 5, -1.0 / 120}, kSecond{8.0 / 3, -3.0 / 2, 0, 1.0 / 6};

  /// Returns the integral of the product of the splines of two control points over space, in units of spacing_mm^3.
  static double value(const glm::ivec3& apart);
  /// Returns what two control points of 1 mm along one axis contribute to the integral of bending_energy(), in units of
  /// 1 / spacing_mm. Both are 0 where the control points are more than 3 apart along an axis.
  static double bending(const glm::ivec3& apart);
};

/// The 64 control points that move a point, and their shares in its displacement.
struct SplineWeights {
  std::array<float, 64> weight{};
  /// Index of the control point; -1 beyond the grid. Entry n has the control point whose indices i, j, k have the
  /// remainders n % 4, n / 4 % 4 and n / 16 by 4. Control points of one entry are so far apart that they move no point
  /// together.
  std::array<int, 64> control{};
};
SplineWeights weights_at(const FreeFormField& field, const glm::dvec3& p);

}  // namespace insonate
