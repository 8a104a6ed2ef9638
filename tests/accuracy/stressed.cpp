#include "tests/accuracy/stressed.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include "sim/model/settings_file.h"
#include "tests/accuracy/stress_bounds.h"
#include "tests/gl/parity.h"

namespace insonate::test {
namespace {

/// What no picture may hold; "" where all is well.
template <typename Real>
std::string out_of_bounds(const Stages<Real>& stages) {
  constexpr double kFinite = std::numeric_limits<Real>::max();
  // What is interpolated, or summed over a beam or a slice, may round up: by a few units of the last place.
  constexpr double kOne = 1 + 16 * std::numeric_limits<Real>::epsilon();
  if (const auto fault = outside("I", stages.intensity, kOne)) return *fault;
  if (const auto fault = outside("R", stages.reflection, kOne)) return *fault;
  if (const auto fault = outside("R behind the beam", stages.reflection_beam, kOne)) return *fault;
  if (const auto fault = outside("V", stages.repeated, kFinite)) return *fault;
  if (const auto fault = outside("T", stages.transmission, 2 * kOne - 1)) return *fault;
  if (const auto fault = outside("S", stages.speckle, kFinite)) return *fault;
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

/// How far references that know place and density as single precision does are from the one that knows them exactly.
struct Spread {
  Image<double> intensity, reflection, repeated, speckle, fused, grey;

  explicit Spread(const Stages<double>& of)
      : intensity(of.intensity.width, of.intensity.height),
        reflection(intensity),
        repeated(intensity),
        speckle(intensity),
        fused(of.fused.width, of.fused.height),
        grey(fused) {}

  void include(const Stages<double>& expected, const Stages<double>& other) {
    widen(intensity, expected.intensity, other.intensity);
    widen(reflection, expected.reflection, other.reflection);
    widen(repeated, expected.repeated, other.repeated);
    widen(speckle, expected.speckle, other.speckle);
    widen(fused, expected.fused, other.fused);
    widen(grey, expected.grey, other.grey);
  }

private:
  template <typename Pixel>
  static void widen(Image<double>& spread, const Image<Pixel>& expected, const Image<Pixel>& other) {
    for (std::size_t i = 0; i < spread.pixels.size(); ++i)
      spread.pixels[i] = std::max(spread.pixels[i], std::abs(double(other.pixels[i]) - double(expected.pixels[i])));
  }
};

/// What is tolerated at each place: `basic` of the reference's value, and `spread` four times over, because the draws
/// that made it are few.
template <typename Basic>
Image<double> tolerated(const Image<double>& expected, const Image<double>& spread, Basic&& basic) {
  Image<double> result = expected;
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] = basic(expected.pixels[i]) + 4 * spread.pixels[i];
  return result;
}

/// Where shaders and reference are further apart than they may be; "" where they are not.
std::string disagreement(const Scene& scene, const Stages<double>& expected, const Stages<float>& got,
                         const Spread& spread) {
  const Worst intensity =
      worst(expected.intensity, got.intensity,
            tolerated(expected.intensity, spread.intensity, [](double i) { return 1e-4 * std::max(i, 1e-6); }));
  if (!(intensity.error < 1)) return told("I", intensity);

  // A medium that is the same everywhere is so to the last place only: 1e-12.
  const double brightest = std::max(largest(expected.reflection), 1e-8);
  const Worst reflection =
      worst(expected.reflection, got.reflection,
            tolerated(expected.reflection, spread.reflection, [&](double) { return 1e-4 * brightest; }));
  if (!(reflection.error < 1)) return told("R", reflection);

  // A place in the lattice is known to the last place of as many periods as a line is long, and cells lie 128 a period.
  const double periods = 1 + scene.depth_mm / (128 * scene.settings.speckle_cell_mm);
  const double of_loudest = 1e-3 + (scene.settings.speckle ? 4 * 128 * 1.2e-7 * periods : 0);
  const double loudest = largest(expected.speckle);
  const Worst speckle =
      worst(expected.speckle, got.speckle,
            tolerated(expected.speckle, spread.speckle, [&](double) { return of_loudest * loudest; }));
  if (!(speckle.error < 1)) return told("S", speckle);

  const double loudest_repeat = largest(expected.repeated);
  const Worst repeated = worst(expected.repeated, got.repeated,
                               tolerated(expected.repeated, spread.repeated, [&](double) { return 1e-4 * brightest; }));
  if (!(repeated.error < 1)) return told("V", repeated);

  // Grey values follow from U: what may be wrong of U, in decibels, and two grey levels.
  const Settings& s = scene.settings;
  const Image<double> fused_tolerance = tolerated(expected.fused, spread.fused, [&](double value) {
    return 1e-3 * value + (1e-4 * brightest + 2e-10 * s.blend) * loudest + 1e-4 * loudest_repeat;
  });
  for (std::size_t i = 0; i < expected.grey.pixels.size(); ++i) {
    const double u = expected.fused.pixels[i];
    // Where the envelope is near its zero, its own error is as large as it is.
    if (!expected.inside.pixels[i] || fused_tolerance.pixels[i] >= 0.5 * u) continue;
    const double db = -10 * std::log10(1 - fused_tolerance.pixels[i] / u);
    const double allowed = 2 + std::ceil(255 * db / s.dynamic_range_db) + 4 * spread.grey.pixels[i];
    if (std::abs(int(got.grey.pixels[i]) - int(expected.grey.pixels[i])) > allowed)
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

void Stressed::check(const Scene& scene) {
  const Stages<float> got = check_shaders(scene);
  // The card's normalised integers have no -32768.
  AcousticVolume volume = scene.volume;
  for (AcousticVoxel& voxel : volume.voxels) voxel.hu = std::max(voxel.hu, std::int16_t(-32767));
  const MediumField field = trilinear_field(volume);
  const Stages<double> expected = reference(scene, field);
  REQUIRE(out_of_bounds(expected) == "");
  REQUIRE(expected.inside.pixels == got.inside.pixels);

  // As in parity.h, for scenes of any size and density: a place is as uncertain as the furthest is far away. Where a
  // threshold lies within that, one draw in many falls to its other side: more are drawn before a verdict.
  const Grid& grid = scene.volume.grid;
  const double reach =
      glm::length(grid.spacing * glm::dvec3(grid.size)) + glm::length(scene.pose.translation) + scene.depth_mm;
  double densest = 1000;
  for (const AcousticVoxel& voxel : volume.voxels) densest = std::max(densest, std::abs(double(voxel.hu)));
  Spread spread(expected);
  std::string problem;
  std::uint32_t drawn = 0;
  for (const std::uint32_t draws : {4u, 256u}) {
    for (; drawn < draws; ++drawn) {
      // Where the gel's end falls on a sample, the last place decides on which side.
      Scene near = scene;
      near.settings.gel_mm += (drawn % 2 ? 3e-7 : -3e-7) * (scene.depth_mm + scene.settings.reflection_length_mm);
      spread.include(expected,
                     reference(near, as_single_precision_knows_it(field, drawn, 2e-7 * reach, 2e-7 * densest)));
    }
    problem = disagreement(scene, expected, got, spread);
    if (problem.empty()) break;
  }
  CHECK(problem == "");
}

}  // namespace insonate::test
