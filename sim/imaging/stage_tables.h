#pragma once

#include <glm/vec4.hpp>

#include <vector>

#include "sim/core/pose.h"
#include "sim/gl/objects.h"
#include "sim/imaging/device_volume.h"
#include "sim/imaging/fan_layout.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/shaders/shared/simulation_parameters.h"

/// What model S's stages read that no stage writes, worked out on the processor.
namespace insonate::gl {

/// A scan line as `Line` in shared/line_sample.glsl: in the volume's texture and in the scatterers' lattice.
struct PlacedLine {
  glm::vec4 start, along;
  glm::vec4 lateral, elevation;
  glm::vec4 lattice_start, lattice_along;
  glm::vec4 beside, lattice_beside;
};

/// The lines of all slice planes where the probe now is, plane by plane.
std::vector<PlacedLine> placed_lines(const DeviceVolume& volume, const Pose& patient_from_probe, const ScanLines& lines,
                                     const Settings& settings);

/// That none of its samples, nor what they look at beside it, lies in the body: it is not walked along.
bool meets_no_body(const PlacedLine& line);

/// What such lines carry is that of one line in each plane which is, before it is weighed.
std::vector<PlacedLine> line_in_air(const Settings& settings);

/// The beam's window from the middle line outwards, 128 weights, as beam.comp takes it.
Buffer half_beam_window(const Settings& settings);

/// What beam.comp asks of each sample's depth: the factor that makes the envelope's mean 1, and of a focused beam
/// the margin in lines and the Gaussian's exponent.
TexelBuffer beam_by_depth(const ScanLines& lines, const Settings& settings);

/// A smoothing window out to three sigma or the picture's size, in pixels.
struct Gaussian {
  int radius = 0;       ///< 0 for none
  double exponent = 0;  ///< -1/(2 sigma^2)

  Gaussian() = default;
  Gaussian(double sigma_px, int limit_px);
  bool operator==(const Gaussian&) const = default;
};

/// Whether anything repeats (sim/model/reverberation.h), and whether anything adds noise (sim/model/noise.h).
bool reverberates(const Settings& settings);
bool is_noisy(const Settings& settings);
bool has_time_gain(const Settings& settings);
/// Reverberation is of the slice's middle plane, which the traversal then keeps beside the sum of all.
bool keeps_middle_plane(const Settings& settings);

/// The alpha of (1) below which an interface's tilt is not looked at, because its echo is not seen.
double least_alpha_with_normal(const Settings& settings);

/// The block of parameters that all shaders read.
SimulationParameters parameters_of(const Settings& settings, const ScanLines& lines, const Gaussian& reflection,
                                   const Gaussian& transmission);

/// What fuse.comp asks of each pixel: its sample + 1, or 0 outside the fan, and 1 over what of its windows of R and of
/// T lies inside the fan; RG32F when there is no window of T, else RGBA32F.
TexelBuffer weights_of_pixels(const FanLayout& fan, const Gaussian& reflection, const Gaussian& transmission);

/// The receiver's noise, mean 1, a row a line.
TexelBuffer noise_of_lines(const ScanLines& lines, const Settings& settings);

/// The receiver's noise, mean 1, as scan conversion brings it to each pixel of the fan; 0 outside.
TexelBuffer noise_of_pixels(const FanLayout& fan, const ScanLines& lines, const Settings& settings);

}  // namespace insonate::gl
