#pragma once

#include <Eigen/Core>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

// Converts between the project's vectors and Eigen's. Only for the .cpp files of this folder.

namespace insonate {

inline Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

inline Eigen::Matrix3d eigen(const glm::dmat3& m) {
  Eigen::Matrix3d out;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out(r, c) = m[c][r];
  return out;
}

inline glm::dvec3 from_eigen(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

inline glm::dmat3 from_eigen(const Eigen::Matrix3d& m) {
  glm::dmat3 out;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out[c][r] = m(r, c);
  return out;
}

}  // namespace insonate
