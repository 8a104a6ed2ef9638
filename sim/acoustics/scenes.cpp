#include "sim/acoustics/scenes.h"

#include <algorithm>
#include <cmath>

#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

constexpr double kMaxScatterers = 5e6;
constexpr int kDepths = 8;
constexpr double kTenthOfAmplitude = 0.1;

// A random number from 0 to 1 with 48 bits, so that many scatterers do not share a coordinate.
double random_at(std::uint32_t seed, std::uint32_t index, std::uint32_t which) {
  const double coarse = hash(seed, index, which, 0) >> 8, fine = hash(seed, index, which, 1) >> 8;
  return (coarse + fine / 16777216.0) / 16777216.0;
}

std::vector<double> depths_of(const SceneRequest& request) {
  std::vector<double> depths;
  const double from = request.depth_mm / 4;
  for (int i = 0; i < kDepths; ++i) depths.push_back(from + (request.depth_mm - from) * i / (kDepths - 1));
  return depths;
}

// Returns half the thickness of the beam, mm: the widest of the first, the middle and the last depth.
double half_thickness_mm(const Transducer& transducer, const Beamforming& beamforming, const SceneRequest& request) {
  double widest = 0;
  for (const double share : {0.25, 0.625, 1.0})
    widest = std::max(widest, beam_profile(transducer, beamforming, line_at(transducer, 0), share * request.depth_mm,
                                           kTenthOfAmplitude)
                                  .elevation_mm);
  return widest / 2;
}

std::vector<Cylinder> cysts_of(const SceneRequest& request) {
  constexpr double kTenDecibels = 3.16227766;
  std::vector<Cylinder> cylinders;
  for (int i = 0; i < 3; ++i) {
    const double depth = request.depth_mm * (0.25 + 0.75 * (i + 0.5) / 3), radius = request.width_mm / 10;
    cylinders.push_back({-request.width_mm / 4, depth, radius, 0});
    cylinders.push_back({request.width_mm / 4, depth, radius, kTenDecibels});
  }
  return cylinders;
}

}  // namespace

double SceneBox::volume_mm3() const {
  const glm::dvec3 size = high - low;
  return size.x * size.y * size.z;
}

std::vector<PointScatterer> uniform_block(const SceneBox& box, double per_mm3, std::uint32_t seed) {
  std::vector<PointScatterer> scatterers(std::size_t(std::lround(per_mm3 * box.volume_mm3())));
  for (std::uint32_t i = 0; i < scatterers.size(); ++i) {
    const glm::dvec3 share(random_at(seed, i, 0), random_at(seed, i, 1), random_at(seed, i, 2));
    scatterers[i].position_mm = box.low + share * (box.high - box.low);
    scatterers[i].amplitude = hash(seed, i, 3, 0) & 1 ? 1 : -1;
  }
  return scatterers;
}

std::vector<PointScatterer> cyst_phantom(const SceneBox& box, double per_mm3, const std::vector<Cylinder>& cylinders,
                                         std::uint32_t seed) {
  std::vector<PointScatterer> scatterers = uniform_block(box, per_mm3, seed);
  for (PointScatterer& scatterer : scatterers)
    for (const Cylinder& cylinder : cylinders)
      if (std::hypot(scatterer.position_mm.x - cylinder.x_mm, scatterer.position_mm.y - cylinder.y_mm) <
          cylinder.radius_mm)
        scatterer.amplitude *= cylinder.gain;
  std::erase_if(scatterers, [](const PointScatterer& scatterer) { return scatterer.amplitude == 0; });
  return scatterers;
}

std::vector<PointScatterer> point_targets(const std::vector<double>& depths_mm) {
  std::vector<PointScatterer> scatterers;
  for (const double depth : depths_mm) scatterers.push_back({glm::dvec3(0, depth, 0), 1});
  return scatterers;
}

std::vector<PointScatterer> wire_targets(const std::vector<double>& depths_mm, double half_length_mm,
                                         double spacing_mm) {
  std::vector<PointScatterer> scatterers;
  const int half = int(half_length_mm / spacing_mm);
  for (const double depth : depths_mm)
    for (int i = -half; i <= half; ++i) scatterers.push_back({glm::dvec3(0, depth, i * spacing_mm), spacing_mm});
  return scatterers;
}

double cell_volume_mm3(const BeamProfile& profile) {
  return profile.axial_mm * profile.lateral_mm * profile.elevation_mm;
}

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names{"block", "cyst", "points", "wires"};
  return names;
}

std::vector<PointScatterer> scene_of(const Transducer& transducer, const Beamforming& beamforming,
                                     const SceneRequest& request) {
  if (request.kind == SceneKind::points) return point_targets(depths_of(request));
  const double half_thickness = half_thickness_mm(transducer, beamforming, request);
  if (request.kind == SceneKind::wires)
    return wire_targets(depths_of(request), half_thickness, transducer.wavelength_mm() / 4);

  const SceneBox box{glm::dvec3(-request.width_mm / 2, request.depth_mm / 4, -half_thickness),
                     glm::dvec3(request.width_mm / 2, request.depth_mm, half_thickness)};
  const BeamProfile middle = beam_profile(transducer, beamforming, line_at(transducer, 0), 0.625 * request.depth_mm);
  const double per_mm3 = request.per_cell / cell_volume_mm3(middle), count = per_mm3 * box.volume_mm3();
  if (count > kMaxScatterers)
    throw InputError("scene", "", "it would have " + number_text(count) + " scatterers, and at most 5 million fit",
                     "give fewer per cell, less depth or less width");
  return request.kind == SceneKind::block ? uniform_block(box, per_mm3, request.seed)
                                          : cyst_phantom(box, per_mm3, cysts_of(request), request.seed);
}

}  // namespace insonate
