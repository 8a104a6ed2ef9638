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

/// The tables that model S's stages read and no stage writes, computed on the processor.
namespace insonate::gl {

/// A scan line in the volume's texture and in the scatterers' lattice, laid out as `Line` in shared/line_sample.glsl.
struct PlacedLine {
  glm::vec4 start, along;
  glm::vec4 lateral, elevation;
  glm::vec4 lattice_start, lattice_along;
  glm::vec4 beside, lattice_beside;
};

/// Returns the lines of all slice planes for a pose of the probe, slice plane by slice plane.
/// @param stored_from_patient  to the coordinates of a scattering volume that stands for the lattice; null for none
std::vector<PlacedLine> placed_lines(const DeviceVolume& volume, const Pose& patient_from_probe, const ScanLines& lines,
                                     const Settings& settings, const glm::dmat4* stored_from_patient = nullptr);

/// True if neither the line's samples nor the points used for their gradients touch the body. Such a line is skipped.
bool meets_no_body(const PlacedLine& line);

/// Returns one line in air per slice plane, before weighting. Its results are those of all lines that meet no body.
std::vector<PlacedLine> line_in_air(const Settings& settings);

/// Returns the beam's window from the middle line outwards, 128 weights, as beam.comp reads it.
Buffer half_beam_window(const Settings& settings);

/// Returns what beam.comp reads per sample depth: the factor that makes the envelope's mean 1 and, for a focused beam,
/// its radius in lines and the Gaussian's exponent.
TexelBuffer beam_by_depth(const ScanLines& lines, const Settings& settings);

/// A smoothing window, cut off at three sigma or at the picture's size, in pixels.
struct Gaussian {
  int radius = 0;       ///< 0 for none
  double exponent = 0;  ///< -1/(2 sigma^2)

  Gaussian() = default;
  Gaussian(double sigma_px, int limit_px);
  bool operator==(const Gaussian&) const = default;
};

/// True if the settings ask for reverberation (sim/model/reverberation.h), for mirror images
/// (sim/model/mirror_image.h), for noise or clutter (sim/model/noise.h), and for time gain other than 0.
bool reverberates(const Settings& settings);
bool mirrors(const Settings& settings);
bool is_noisy(const Settings& settings);
bool has_time_gain(const Settings& settings);
/// True if the traversal must keep the slice's middle plane beside the sum of all planes: reverberation and mirror
/// images need it.
bool keeps_middle_plane(const Settings& settings);

/// Returns the alpha of (1) below which an interface's tilt is not computed, because its echo is not visible.
double least_alpha_with_normal(const Settings& settings);

/// Returns the block of parameters that all shaders of model S read.
SimulationParameters parameters_of(const Settings& settings, const ScanLines& lines, const Gaussian& reflection,
                                   const Gaussian& transmission);

/// Returns what fuse.comp reads per pixel: its sample + 1, or 0 outside the fan; then 1 / the part of its windows of R
/// and of T that lies inside the fan. RG32F if there is no window of T, else RGBA32F.
TexelBuffer weights_of_pixels(const FanLayout& fan, const Gaussian& reflection, const Gaussian& transmission);

/// Returns the receiver's noise, mean 1, one row per line.
TexelBuffer noise_of_lines(const ScanLines& lines, const Settings& settings);

/// Returns the receiver's noise, mean 1, scan-converted to each pixel of the fan; 0 outside.
TexelBuffer noise_of_pixels(const FanLayout& fan, const ScanLines& lines, const Settings& settings);

/// Return the same with waves: complex, mean square 1; for a picture at every pixel (noise_shift()).
TexelBuffer noise_waves_of_lines(const ScanLines& lines, const Settings& settings);
TexelBuffer noise_waves_of_pixels(const ImageGeometry& geometry, const ScanLines& lines, const Settings& settings);

}  // namespace insonate::gl
