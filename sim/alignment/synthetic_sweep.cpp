#include "sim/alignment/synthetic_sweep.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <limits>

#include "sim/core/image.h"
#include "sim/imaging/simulator.h"

namespace insonate {
namespace {

constexpr int kFiner = 3;  // pixels of the simulated picture per pixel of the sweep's

}  // namespace

std::vector<Pose> hand_sweep(const Pose& patient_from_probe, int images, double tilt_deg, double slide_mm) {
  std::vector<Pose> poses;
  for (int i = 0; i < images; ++i) {
    const double share = images > 1 ? 2.0 * i / (images - 1) - 1 : 0, tilt = glm::radians(share * tilt_deg);
    const Pose moved{glm::dmat3(1, 0, 0, 0, std::cos(tilt), std::sin(tilt), 0, -std::sin(tilt), std::cos(tilt)),
                     glm::dvec3(0, 0, share * slide_mm / 2)};
    poses.push_back(patient_from_probe * moved);
  }
  return poses;
}

TrackedSweep synthetic_sweep(const AcousticVolume& volume, const TissueTable& table, const Probe& probe,
                             double depth_mm, const Settings& settings, const std::vector<Pose>& patient_from_probe,
                             int width, int height) {
  Settings large = settings;
  large.image_width = kFiner * width;
  large.image_height = kFiner * height;
  gl::Simulator simulator;
  simulator.set_volume(volume, table);
  simulator.set_probe(probe, depth_mm);
  simulator.set_settings(large);
  const ImageGeometry to = image_geometry(probe, depth_mm, width, height);
  TrackedSweep sweep{Probe(probe), depth_mm, {}};
  std::vector<Rgba8> pixels(std::size_t(large.image_width) * std::size_t(large.image_height));
  for (const Pose& pose : patient_from_probe) {
    simulator.set_pose(pose);
    simulator.image().read(GL_RGBA, GL_UNSIGNED_BYTE, pixels.data(), pixels.size() * sizeof(Rgba8));
    Image<float> picture(large.image_width, large.image_height);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      picture.pixels[i] = pixels[i][3] > 0 ? float(pixels[i][0]) : std::numeric_limits<float>::quiet_NaN();
    const ImageGeometry& from = simulator.geometry();
    glm::dmat3 pixel_from_plane(1 / from.mm_per_pixel);
    pixel_from_plane[2] = glm::dvec3(-from.top_left_mm / from.mm_per_pixel, 1);
    sweep.images.push_back({pose, resampled(picture, pixel_from_plane, to)});
  }
  return sweep;
}

}  // namespace insonate
