#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "sim/acoustics/beam_profile.h"
#include "sim/acoustics/echo_lines.h"

namespace insonate {

/// A box of the probe's frame, mm.
struct SceneBox {
  glm::dvec3 low{0.0}, high{0.0};

  double volume_mm3() const;
};

/// A cylinder along the elevation.
struct Cylinder {
  double x_mm = 0, y_mm = 0;  ///< its axis
  double radius_mm = 1;
  double gain = 0;  ///< factor on the amplitudes within; 0 removes the scatterers
};

/// Returns scatterers at random places of a box: amplitude 1 or -1 by chance, so that the box's faces do not echo.
/// @param per_mm3  density, above 0
std::vector<PointScatterer> uniform_block(const SceneBox& box, double per_mm3, std::uint32_t seed);

/// Returns uniform_block() with cylinders in it. Where cylinders overlap, their gains multiply.
std::vector<PointScatterer> cyst_phantom(const SceneBox& box, double per_mm3, const std::vector<Cylinder>& cylinders,
                                         std::uint32_t seed);

/// Returns one scatterer of amplitude 1 on the central beam at each depth.
std::vector<PointScatterer> point_targets(const std::vector<double>& depths_mm);

/// Returns wires along the elevation that cross the central beam at the depths: scatterers `spacing_mm` apart with
/// amplitudes of `spacing_mm`, so that a wire's echo does not depend on the spacing.
/// @param half_length_mm  how far a wire reaches to either side of the imaging plane
std::vector<PointScatterer> wire_targets(const std::vector<double>& depths_mm, double half_length_mm,
                                         double spacing_mm);

/// Returns the volume of the resolution cell, mm^3: the product of a profile's three widths.
double cell_volume_mm3(const BeamProfile& profile);

/// The kinds of scenes that scene_of() makes.
enum class SceneKind { block, cyst, points, wires };
const std::vector<std::string>& scene_names();  ///< "block", "cyst", "points", "wires", in the order of SceneKind

/// How scene_of() fills the space in front of a transducer.
struct SceneRequest {
  SceneKind kind = SceneKind::block;
  double depth_mm = 80;  ///< the scene reaches from a quarter of it to it, 10 to 400
  double width_mm = 20;  ///< lateral extent of block and cysts, 1 to 200
  double per_cell = 20;  ///< scatterers per resolution cell at the middle of the scene, 0.01 to 1000
  std::uint32_t seed = 1;
};

/// Returns a scene for a transducer. Block and wires are as thick as the beam in elevation where it is thickest within
/// the scene, at a tenth of the amplitude. Points and wires lie at 8 depths. The cysts are 3 echo-free cylinders on the
/// left and 3 of 3.16 times the amplitude (10 dB) on the right. Throws InputError if the scene would have more than 5
/// million scatterers.
std::vector<PointScatterer> scene_of(const Transducer& transducer, const Beamforming& beamforming,
                                     const SceneRequest& request);

}  // namespace insonate
