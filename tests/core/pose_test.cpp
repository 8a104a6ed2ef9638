#include "sim/core/pose.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <limits>

using namespace insonate;

namespace {

Pose turned(double degrees, const glm::dvec3& axis, const glm::dvec3& translation) {
  return {glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis)), translation};
}

}  // namespace

TEST_CASE("a pose's inverse undoes it, and poses chain right to left") {
  const Pose a = turned(50, glm::normalize(glm::dvec3(1, 2, 3)), {10, -20, 30});
  const Pose b = turned(-110, glm::normalize(glm::dvec3(-1, 0.5, 2)), {5, 6, 7});
  const glm::dvec3 p(3, -1, 4);
  CHECK(glm::distance(a.inverse().point(a.point(p)), p) < 1e-12);
  CHECK(glm::distance((a * b).point(p), a.point(b.point(p))) < 1e-12);
  CHECK(glm::distance(glm::dvec3((a * b).matrix() * glm::dvec4(p, 1)), (a * b).point(p)) < 1e-12);
}

TEST_CASE("a matrix is taken as a pose only when it is rigid") {
  const glm::dmat4 good = turned(77, glm::normalize(glm::dvec3(1, -2, 0.3)), {100, 200, -300}).matrix();
  REQUIRE_FALSE(why_not_rigid(good));

  const auto rejected = [&](auto&& spoil, const char* word) {
    glm::dmat4 matrix = good;
    spoil(matrix);
    const auto why = why_not_rigid(matrix);
    INFO(word);
    REQUIRE(why);
    CHECK(why->find(word) != std::string::npos);
  };
  rejected([](glm::dmat4& m) { m[1][2] = std::numeric_limits<double>::quiet_NaN(); }, "finite");
  rejected([](glm::dmat4& m) { m[3][0] = std::numeric_limits<double>::infinity(); }, "finite");
  rejected([](glm::dmat4& m) { m[0] = -m[0]; }, "mirrors");
  rejected([](glm::dmat4& m) { m[0] = m[1]; }, "singular");
  rejected([](glm::dmat4& m) { m[0] *= 1.01; }, "orthonormal");
  rejected([](glm::dmat4& m) { m[0][3] = 1; }, "last row");
  rejected([](glm::dmat4& m) { m[3][0] = 1e9; }, "reach");
}

TEST_CASE("what rounding to six decimals leaves in a matrix is removed") {
  const Pose exact = turned(33, glm::normalize(glm::dvec3(3, 1, -2)), {1, 2, 3});
  glm::dmat4 rounded = exact.matrix();
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) rounded[c][r] = std::round(rounded[c][r] * 1e6) / 1e6;
  REQUIRE_FALSE(why_not_rigid(rounded));
  const Pose pose = pose_from_matrix(rounded);
  const glm::dmat3 excess = glm::transpose(pose.rotation) * pose.rotation - glm::dmat3(1.0);
  for (int c = 0; c < 3; ++c) CHECK(glm::length(excess[c]) < 1e-14);
  CHECK(angle_between_deg(pose, exact) < 1e-4);
}

TEST_CASE("the rotation that is taken for a matrix is the nearest one") {
  const glm::dmat3 exact = turned(33, glm::normalize(glm::dvec3(3, 1, -2)), {}).rotation;
  glm::dmat3 stretch(1.0);
  stretch[0] = {1 + 6e-4, 3e-4, -2e-4};
  stretch[1] = {3e-4, 1 - 5e-4, 4e-4};
  stretch[2] = {-2e-4, 4e-4, 1 + 2e-4};
  // The polar decomposition: of a rotation times a symmetric positive stretch the rotation is nearest.
  const glm::dmat4 matrix(exact * stretch);
  REQUIRE(why_not_rigid(matrix));
  REQUIRE_FALSE(why_not_rigid(matrix, kTrackerRange_mm, 2e-3));
  const glm::dmat3 nearest = pose_from_matrix(matrix).rotation;
  for (int c = 0; c < 3; ++c) CHECK(glm::length(nearest[c] - exact[c]) < 1e-15);
}

TEST_CASE("the angle between poses is the rotation's, down to small angles and up to a half turn") {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 1, 0.2));
  const Pose a = turned(20, axis, {1, 2, 3});
  for (double degrees : {0.0, 1e-6, 0.1, 45.0, 90.0, 135.0, 179.9})
    CHECK(angle_between_deg(a, turned(20 + degrees, axis, {})) == Approx(degrees).margin(1e-9));
}

TEST_CASE("interpolation takes the shorter way round and meets both ends") {
  const glm::dvec3 axis(0, 0, 1);
  const Pose a = turned(170, axis, {0, 0, 0});
  const Pose b = turned(-170, axis, {10, 0, 0});
  CHECK(angle_between_deg(interpolate(a, b, 0), a) < 1e-9);
  CHECK(angle_between_deg(interpolate(a, b, 1), b) < 1e-9);
  const Pose half = interpolate(a, b, 0.5);
  CHECK(half.translation.x == Approx(5));
  CHECK(angle_between_deg(half, turned(180, axis, {})) < 1e-9);
}
