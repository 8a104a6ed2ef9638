#include "tests/accuracy/stressed.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "sim/model/display_filter.h"
#include "sim/model/settings_file.h"
#include "sim/probe/probe.h"
#include "sim/reference/display_reference.h"
#include "tests/accuracy/spread.h"
#include "tests/accuracy/stress_bounds.h"
#include "tests/accuracy/stressed_waves.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/wave_tolerance.h"

namespace insonate::test {
namespace {

using S = Stages<double>;

/// Returns what is wrong in a picture; "" if nothing is.
template <typename Real>
std::string out_of_bounds(const Stages<Real>& stages) {
  constexpr double kFinite = std::numeric_limits<Real>::max();
  // Interpolated values and sums over a beam or a slice may be rounded up, by a few units of the last place.
  constexpr double kOne = 1 + 16 * std::numeric_limits<Real>::epsilon();
  if (const auto fault = outside("I", stages.intensity, kOne)) return *fault;
  if (const auto fault = outside("R", stages.reflection, kOne)) return *fault;
  if (const auto fault = outside("R behind the beam", stages.reflection_beam, kOne)) return *fault;
  if (const auto fault = outside("V", stages.repeated, kFinite)) return *fault;
  if (const auto fault = outside("T", stages.transmission, 2 * kOne - 1)) return *fault;
  if (const auto fault = outside("S", stages.speckle, kFinite)) return *fault;
  if (const auto fault = outside("the scattered power", stages.scattered, kFinite)) return *fault;
  for (const auto wave :
       {&Stages<Real>::echo_re, &Stages<Real>::echo_im, &Stages<Real>::wave_re, &Stages<Real>::wave_im})
    for (std::size_t i = 0; i < (stages.*wave).pixels.size(); ++i)
      if (!std::isfinite((stages.*wave).pixels[i])) return at("e or f", stages.*wave, i);
  if (const auto fault = outside("U", stages.fused, kFinite)) return *fault;
  const std::size_t lines = std::size_t(stages.intensity.width);
  for (std::size_t i = lines; i < stages.intensity.pixels.size(); ++i)
    if (stages.intensity.pixels[i] > stages.intensity.pixels[i - lines]) return at("rising I", stages.intensity, i);
  for (std::size_t i = 0; i < stages.grey.pixels.size(); ++i)
    if (stages.grey.pixels[i] && !stages.inside.pixels[i]) return at("grey outside the fan", stages.grey, i);
  return "";
}

double largest(const Image<double>& image) {
  return image.pixels.empty() ? 0 : *std::max_element(image.pixels.begin(), image.pixels.end());
}

/// Returns the largest value within `reach` pixels of each pixel, along x and along y.
Image<double> loudest_around(const Image<double>& image, int reach) {
  Image<double> across = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, image.width - 1); ++u)
        across.at(x, y) = std::max(across.at(x, y), image.at(u, y));
  Image<double> found = across;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int v = std::max(y - reach, 0); v <= std::min(y + reach, image.height - 1); ++v)
        found.at(x, y) = std::max(found.at(x, y), across.at(x, v));
  return found;
}

/// Of the samples beside each pixel: the largest R + b T, and the largest U that they could make. The place of a pixel
/// among them is known in single precision, so it may be wrong by a small share of these.
struct Beside {
  Image<double> echo, fused;
};
Beside loudest_samples_around(const Scene& scene, const Stages<double>& of) {
  const int lines = of.intensity.width, samples = of.intensity.height;
  const ScanLines placed = scan_lines(scene.probe, scene.depth_mm, samples);
  const ImageGeometry picture = image_geometry(scene.probe, scene.depth_mm, of.fused.width, of.fused.height);
  Beside found{Image<double>(of.fused.width, of.fused.height), Image<double>(of.fused.width, of.fused.height)};
  for (int y = 0; y < found.fused.height; ++y)
    for (int x = 0; x < found.fused.width; ++x)
      if (const auto at = line_position(scene.probe, scene.depth_mm, picture.plane_mm(x, y))) {
        const int line = int(at->line), k = int((at->r_mm - placed.r_min_mm) / placed.dr_mm());
        double echo = 0, scattered = 0, repeated = 0;
        for (int j = std::max(line - 1, 0); j <= std::min(line + 2, lines - 1); ++j)
          for (int i = std::max(k - 2, 0); i <= std::min(k + 2, samples - 1); ++i) {
            echo = std::max(echo, of.reflection_beam.at(j, i) + scene.settings.blend * of.transmission.at(j, i));
            scattered = std::max(scattered, of.speckle.at(j, i));
            repeated = std::max(repeated, of.repeated.at(j, i));
          }
        found.echo.at(x, y) = echo;
        found.fused.at(x, y) = echo * scattered + repeated;
      }
  return found;
}

/// The amplitude that single precision may give to a silent scatterer: 10^-6 minus 10^-6, each from hundredths of a dB
/// around 6000, which are known to 2.4e-4.
constexpr double kSilentRounding = 2e-12;

/// Compares the stages of echoes that add up as amplitudes. Returns where they differ by more than allowed; "" if
/// nowhere. Otherwise sets the tolerance of U.
std::string disagreement_of_amplitudes(const Scene& scene, const Stages<double>& expected, const Stages<float>& got,
                                       const Spread& spread, Image<double>& fused_tolerance) {
  // A homogeneous medium is only homogeneous to the last place: 1e-12.
  const double brightest = std::max(largest(expected.reflection), 1e-8);
  const Worst reflection = worst(expected.reflection, got.reflection,
                                 spread.tolerated(expected, &S::reflection, [&](double) { return 1e-4 * brightest; }));
  if (!(reflection.error < 1)) return described("R", reflection);

  const Worst beam =
      worst(expected.reflection_beam, got.reflection_beam,
            spread.tolerated(expected, &S::reflection_beam, [&](double r) { return 1e-4 * r + 1e-6 * brightest; }));
  if (!(beam.error < 1)) return described("R behind the beam", beam);
  const Worst transmission =
      worst(expected.transmission, got.transmission,
            spread.tolerated(expected, &S::transmission, [](double t) { return 2e-4 * std::max(t, 1e-12); }));
  if (!(transmission.error < 1)) return described("T", transmission);

  // A place in the lattice is known to the last place of the number of periods in a line's length; a period has 128
  // cells.
  const double periods = 1 + scene.depth_mm / (128 * scene.settings.speckle_cell_mm);
  const double of_loudest = 1e-3 + (scene.settings.speckle ? 4 * 128 * 1.2e-7 * periods : 0);
  const double loudest = largest(expected.speckle);
  const Worst speckle = worst(expected.speckle, got.speckle,
                              spread.tolerated(expected, &S::speckle, [&](double) { return of_loudest * loudest; }));
  if (!(speckle.error < 1)) return described("S", speckle);

  const Worst repeated = worst(expected.repeated, got.repeated,
                               spread.tolerated(expected, &S::repeated, [&](double) { return 1e-4 * brightest; }));
  if (!(repeated.error < 1)) return described("V", repeated);

  // Near its zero an envelope is as wrong as the envelopes around it are large.
  const Settings& s = scene.settings;
  const Image<double> around = loudest_around(expected.fused, 2);
  const Beside beside = loudest_samples_around(scene, expected);
  const ImageGeometry picture = image_geometry(scene.probe, scene.depth_mm, around.width, around.height);
  const double smoothed_mm = 3 * std::max(s.reflection_sigma_mm, s.transmission_sigma_mm);
  const Image<double> silent = loudest_around(
      beside.echo,
      int(std::min(std::ceil(smoothed_mm / picture.mm_per_pixel), double(std::max(around.width, around.height)))));
  const double place = 2.4e-7 * std::max(expected.intensity.width, expected.intensity.height);
  fused_tolerance = spread.tolerated(expected, &S::fused, [](double) { return kMinEcho; });
  for (std::size_t i = 0; i < around.pixels.size(); ++i)
    fused_tolerance.pixels[i] +=
        1e-3 * around.pixels[i] + place * beside.fused.pixels[i] + kSilentRounding * silent.pixels[i];
  return "";
}

/// Returns where shaders and reference differ by more than allowed; "" if nowhere.
/// @param rounding  with waves: rounding_of_waves()
std::string disagreement(const Scene& scene, const Stages<double>& expected, const Image<double>& rounding,
                         const Stages<float>& got, const Spread& spread, Compared& extent) {
  const Worst intensity =
      worst(expected.intensity, got.intensity,
            spread.tolerated(expected, &S::intensity, [](double i) { return 1e-4 * std::max(i, 1e-6); }));
  if (!(intensity.error < 1)) return described("I", intensity);

  const Settings& s = scene.settings;
  Image<double> fused_tolerance;
  const std::string of_lines = s.waves ? disagreement_of_waves(scene, expected, rounding, got, spread, fused_tolerance)
                                       : disagreement_of_amplitudes(scene, expected, got, spread, fused_tolerance);
  if (!of_lines.empty()) return of_lines;

  // The tolerance of grey follows from that of U, in decibels, plus two levels.
  const Worst fused = worst(expected.fused, got.fused, fused_tolerance);
  if (!(fused.error < 1)) return described("U", fused);

  // The display filter has no error beyond that of what it filters, so grey is compared with what the reference makes
  // of the shaders' own.
  const bool filters = is_filtered(s);
  if (filters) {
    Image<double> shown(got.shown.width, got.shown.height);
    std::ranges::copy(got.shown.pixels, shown.pixels.begin());
    const ImageGeometry picture = image_geometry(scene.probe, scene.depth_mm, shown.width, shown.height);
    const Image<std::uint8_t> grey = filtered_grey(shown, expected.inside, s, picture.mm_per_pixel, 1);
    for (std::size_t i = 0; i < grey.pixels.size(); ++i)
      if (std::abs(int(grey.pixels[i]) - int(got.grey.pixels[i])) > 1)
        return at("filtered grey", got.grey, i) + ", " + at("reference of the shader's echo", grey, i);
  }

  for (std::size_t i = 0; i < expected.grey.pixels.size(); ++i) {
    const double u = expected.fused.pixels[i];
    if (!expected.inside.pixels[i] || u <= kMinEcho) continue;
    ++extent.with_echo;
    if (fused_tolerance.pixels[i] >= 0.5 * u) continue;
    ++extent.in_grey;
    const double db = -10 * std::log10(1 - fused_tolerance.pixels[i] / u);
    const double drawn = s.waves ? 0 : 4 * spread.grey().pixels[i];
    const double allowed = 2 + std::ceil(255 * db / s.dynamic_range_db) + drawn;
    const double off = filters ? 255 * std::abs(double(got.shown.pixels[i]) - expected.shown.pixels[i])
                               : std::abs(int(got.grey.pixels[i]) - int(expected.grey.pixels[i]));
    if (off > allowed)
      return at("grey", got.grey, i) + ", " + at("reference", expected.grey, i) + ", " + at("U", expected.fused, i) +
             ", " + at("shader's U", got.fused, i);
  }
  return "";
}

}  // namespace

Stages<float> Stressed::shaders(const Scene& scene) {
  simulator_.set_volume(scene.volume, table_);
  simulator_.set_probe(scene.probe, scene.depth_mm);
  simulator_.set_settings(exact_as_needed(scene.settings));
  simulator_.set_pose(scene.pose);
  return simulator_.read_stages();
}

Stages<double> Stressed::reference(const Scene& scene, const MediumField& field) const {
  return simulate_reference(field, table_, scene.probe, scene.depth_mm, scene.settings, scene.pose);
}

Stages<float> Stressed::check_shaders(const Scene& scene) {
  const auto refused = why_not_valid(scene.settings);
  REQUIRE(refused.value_or("") == "");
  Stages<float> got = shaders(scene);
  CHECK(out_of_bounds(got) == "");
  return got;
}

Stages<float> Stressed::check(const Scene& scene) {
  Stages<float> got = check_shaders(scene);
  // The graphics card's normalised integers have no -32768.
  AcousticVolume volume = scene.volume;
  for (AcousticVoxel& voxel : volume.voxels) voxel.hu = std::max(voxel.hu, std::int16_t(-32767));
  const MediumField field = trilinear_field(volume);
  const Stages<double> expected = reference(scene, field);
  REQUIRE(out_of_bounds(expected) == "");
  REQUIRE(expected.inside.pixels == got.inside.pixels);

  // As in parity.h, for scenes of any size and density: the uncertainty of a place grows with the largest distance. If
  // a threshold lies within it, one draw in many falls on its other side, so more are drawn before a verdict.
  const Grid& grid = scene.volume.grid;
  const double reach =
      glm::length(grid.spacing * glm::dvec3(grid.size)) + glm::length(scene.pose.translation) + scene.depth_mm;
  const double extent_mm = scene.depth_mm + std::max(scene.probe.radius_mm, scene.probe.width_mm);
  double densest = 1000;
  for (const AcousticVoxel& voxel : volume.voxels) densest = std::max(densest, std::abs(double(voxel.hu)));
  Image<double> rounding;
  if (scene.settings.waves)
    rounding = rounding_of_waves(field, table_, scan_lines(scene.probe, scene.depth_mm, scene.settings.samples),
                                 scene.settings, scene.pose);
  Spread spread(expected);
  std::string problem;
  Compared extent;
  std::uint32_t drawn = 0;
  for (const std::uint32_t draws : {4u, 256u}) {
    for (; drawn < draws; ++drawn) {
      // If the gel's end falls on a sample, the last place decides on which side.
      Scene near = scene;
      near.settings.gel_mm += (drawn % 2 ? 3e-7 : -3e-7) * (scene.depth_mm + scene.settings.reflection_length_mm);
      // Scatterers have their own places. Along a line these are sums of steps in single precision; with waves they are
      // coordinates in the probe's frame, which is as wide as its face at least.
      for (int axis = 0; axis < 3; ++axis)
        near.pose.translation[axis] += 2e-7 * (scene.settings.waves ? extent_mm : scene.depth_mm) *
                                       (2 * unit_float(hash(drawn, std::uint32_t(axis))) - 1);
      spread.include(expected,
                     reference(near, as_single_precision_knows_it(field, drawn, 2e-7 * reach, 2e-7 * densest)));
    }
    extent = {};
    problem = disagreement(scene, expected, rounding, got, spread, extent);
    if (problem.empty()) break;
  }
  CHECK(problem == "");
  compared_ += extent;
  return got;
}

}  // namespace insonate::test
