#include "sim/registration/synthetic_sweep.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <tbb/parallel_for.h>

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

AcousticVolume deformed(const AcousticVolume& volume, const std::function<glm::dvec3(const glm::dvec3&)>& moved) {
  AcousticVolume result{volume.grid, std::vector<AcousticVoxel>(volume.grid.count())};
  const glm::ivec3& size = volume.grid.size;
  tbb::parallel_for(0, size.z, [&](int k) {
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) {
        const glm::dvec3 index =
            volume.grid.index_from_patient(moved(volume.grid.patient_from_index(glm::dvec3(i, j, k))));
        const glm::ivec3 low(glm::floor(index));
        const glm::dvec3 f = index - glm::dvec3(low);
        double hu = 0, echogenicity = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
          const AcousticVoxel voxel = volume.grid.contains(low + step) ? volume.at(low + step) : AcousticVoxel{};
          const double weight = (step.x ? f.x : 1 - f.x) * (step.y ? f.y : 1 - f.y) * (step.z ? f.z : 1 - f.z);
          hu += weight * voxel.hu;
          echogenicity += weight * voxel.echogenicity_cdb;
        }
        result.at({i, j, k}) = {std::int16_t(std::lround(hu)), std::int16_t(std::lround(echogenicity))};
      }
  });
  return result;
}

std::function<glm::dvec3(const glm::dvec3&)> breath(const glm::dvec3& centre, double most_mm) {
  return [=](const glm::dvec3& p) {
    constexpr double kWidth_mm = 30;
    const glm::dvec3 apart = (p - centre) / kWidth_mm;
    return p + most_mm * std::exp(-glm::dot(apart, apart) / 2) * glm::dvec3(0, 1.0 / 3, 1);
  };
}

}  // namespace insonate
