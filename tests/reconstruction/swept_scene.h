#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "sim/reconstruction/tracked_picture.h"

// Pictures of scenes that are known everywhere.

namespace insonate {

/// Returns a scene's grey level at a patient point, mm.
using Scene = std::function<double(const glm::dvec3&)>;

inline TrackedPicture picture_of(const Scene& scene, const Pose& patient_from_probe, const ImageGeometry& geometry,
                                 const std::shared_ptr<const PictureRegion>& region, double time_s = 0) {
  TrackedPicture picture;
  picture.grey = Image<std::uint8_t>(geometry.width, geometry.height);
  picture.region = region;
  picture.patient_from_pixel = patient_from_pixel(patient_from_probe, geometry);
  picture.time_s = time_s;
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x) {
      const glm::dvec3 at(picture.patient_from_pixel * glm::dvec4(x, y, 0, 1));
      picture.grey.at(x, y) = std::uint8_t(std::lround(std::clamp(scene(at), 0.0, 255.0)));
    }
  return picture;
}

/// A probe's pose that is parallel to no axis of the patient.
inline Pose oblique_pose() {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.8, glm::normalize(glm::dvec3(2, -1, 0.5)));
  return {glm::dmat3(turn), {40, -90, 15}};
}

/// Pictures of a probe that slides along its elevation by equal steps, and trembles.
struct HandSweep {
  int pictures = 60;
  double step_mm = 0.5;
  double tremor_deg = 1;
  double rate_hz = 20;
  int width = 96, height = 80;
  double mm_per_pixel = 0.5;

  std::vector<Pose> poses() const {
    std::vector<Pose> poses;
    const Pose start = oblique_pose();
    for (int n = 0; n < pictures; ++n) {
      const double turn = glm::radians(tremor_deg) * std::sin(0.37 * n);
      const glm::dmat4 tremor = glm::rotate(glm::dmat4(1.0), turn, glm::normalize(glm::dvec3(0.3, 1, 0.2)));
      poses.push_back(start * Pose{glm::dmat3(tremor), {0.2 * std::sin(0.9 * n), 0.1 * std::cos(n), step_mm * n}});
    }
    return poses;
  }
  /// Rows begin at the face.
  ImageGeometry geometry() const { return {width, height, mm_per_pixel, {-mm_per_pixel * (width - 1) / 2.0, 0}}; }
  /// The middle of what is swept.
  glm::dvec3 middle() const {
    return oblique_pose().point({0, mm_per_pixel * height / 2.0, step_mm * (pictures - 1) / 2.0});
  }

  std::vector<TrackedPicture> pictures_of(const Scene& scene) const {
    const auto region = rectangle_region(width, height, {0, 0, width, height});
    std::vector<TrackedPicture> taken;
    double time_s = 100;
    for (const Pose& pose : poses()) {
      taken.push_back(picture_of(scene, pose, geometry(), region, time_s));
      time_s += 1 / rate_hz;
    }
    return taken;
  }
};

}  // namespace insonate
