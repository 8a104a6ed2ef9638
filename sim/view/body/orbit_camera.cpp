#include "sim/view/body/orbit_camera.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace insonate::view {
namespace {

constexpr double kSteepest_deg = 89;
constexpr double kHandle_mm = 150, kPictureDepth_mm = 180;  // how far the probe and its picture reach from the face
constexpr double kRoundness = 0.75;                         // of a body in its box, as the corners are free
constexpr double kFilled = 0.86;                            // of a picture; the rest has buttons
constexpr double kNearest_mm = 50, kFarthest_mm = 5000;

}  // namespace

OrbitCamera OrbitCamera::framing(const Grid& volume) {
  OrbitCamera camera;
  camera.centre = volume.centre();
  camera.yaw_deg = 20;
  camera.pitch_deg = -12;
  // The sphere around the box, minus a quarter.
  const double radius = kRoundness * glm::length(glm::dvec3(volume.size) * volume.spacing) / 2;
  camera.distance_mm =
      std::clamp(radius / std::sin(glm::radians(camera.field_of_view_deg / 2)), kNearest_mm, kFarthest_mm);
  return camera;
}

namespace {

/// Moves the camera along its axes and to the distance at which the points fill its picture.
void fit(OrbitCamera& camera, const std::vector<glm::dvec3>& points, double aspect) {
  const double up = kFilled * std::tan(glm::radians(camera.field_of_view_deg / 2)), aside = up * aspect;
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    const Pose eye = camera.patient_from_camera();
    glm::dvec2 least(1e9), most(-1e9);
    for (const glm::dvec3& point : points) {
      const glm::dvec3 seen = eye.inverse().point(point);
      const glm::dvec2 slope = glm::dvec2(seen) / std::max(seen.z, kNearest_mm);
      least = glm::min(least, slope);
      most = glm::max(most, slope);
    }
    const glm::dvec2 middle = (least + most) / 2.0, half = (most - least) / 2.0;
    camera.centre += eye.direction(glm::dvec3(middle * camera.distance_mm, 0));
    camera.zoom(1 / std::max(half.x / aside, half.y / up));
  }
}

}  // namespace

OrbitCamera OrbitCamera::facing(const Grid& volume, const Pose& patient_from_probe, double aspect) {
  // The direction to a teacher at the bed: in front of the patient, nearer to the feet.
  const glm::dvec3 teacher = glm::normalize(glm::dvec3(0.15, -1, -0.45));
  const glm::dvec3 normal =
      patient_from_probe.rotation[2] * (glm::dot(patient_from_probe.rotation[2], teacher) < 0 ? -1.0 : 1.0);
  const glm::dvec3 aside = teacher - glm::dot(teacher, normal) * normal;
  const double tilt = std::min(glm::radians(35.0), std::asin(std::min(glm::length(aside), 1.0)));
  glm::dvec3 to_camera = normal;
  if (glm::length(aside) > 1e-6) to_camera = std::cos(tilt) * normal + std::sin(tilt) * glm::normalize(aside);
  OrbitCamera camera = framing(volume);
  camera.yaw_deg = glm::degrees(std::atan2(to_camera.x, -to_camera.y));
  camera.pitch_deg =
      std::clamp(glm::degrees(std::asin(std::clamp(to_camera.z, -1.0, 1.0))), -kSteepest_deg, kSteepest_deg);
  const glm::dvec3 half = kRoundness * glm::dvec3(volume.size) * volume.spacing / 2.0;
  std::vector<glm::dvec3> points{patient_from_probe.point({0, -kHandle_mm, 0}),
                                 patient_from_probe.point({0, kPictureDepth_mm, 0})};
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0})
        points.push_back(volume.centre() + volume.direction * (half * glm::dvec3(x, y, z)));
  fit(camera, points, aspect);
  return camera;
}

OrbitCamera OrbitCamera::from(Side side, const Grid& volume) {
  OrbitCamera camera = framing(volume);
  camera.yaw_deg = side == Side::back ? 180 : side == Side::left ? 90 : side == Side::right ? -90 : 0;
  camera.pitch_deg = side == Side::head ? kSteepest_deg : side == Side::feet ? -kSteepest_deg : 0;
  return camera;
}

Pose OrbitCamera::patient_from_camera() const {
  const double yaw = glm::radians(yaw_deg), pitch = glm::radians(pitch_deg);
  const glm::dvec3 to_camera(std::sin(yaw) * std::cos(pitch), -std::cos(yaw) * std::cos(pitch), std::sin(pitch));
  const glm::dvec3 right(std::cos(yaw), std::sin(yaw), 0);
  const glm::dvec3 into = -to_camera;
  return {glm::dmat3(right, glm::cross(into, right), into), centre + distance_mm * to_camera};
}

glm::dvec2 OrbitCamera::project(const glm::dvec3& patient_mm, int width, int height) const {
  const glm::dvec3 p = patient_from_camera().inverse().point(patient_mm);
  const double px_per_slope = height / 2.0 / std::tan(glm::radians(field_of_view_deg / 2));
  return glm::dvec2(width, height) / 2.0 + px_per_slope * glm::dvec2(p) / p.z;
}

void OrbitCamera::orbit(double yaw_by_deg, double pitch_by_deg) {
  yaw_deg = std::remainder(yaw_deg + yaw_by_deg, 360.0);
  pitch_deg = std::clamp(pitch_deg + pitch_by_deg, -kSteepest_deg, kSteepest_deg);
}

void OrbitCamera::pan(const glm::dvec2& by_px, int height) {
  const double mm_per_px = 2 * distance_mm * std::tan(glm::radians(field_of_view_deg / 2)) / height;
  centre -= patient_from_camera().direction(glm::dvec3(by_px * mm_per_px, 0));
}

void OrbitCamera::zoom(double factor) {
  distance_mm = std::clamp(distance_mm / factor, kNearest_mm, kFarthest_mm);
}

}  // namespace insonate::view
