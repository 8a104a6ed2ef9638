#include "tests/accuracy/stressed_waves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "sim/probe/probe.h"
#include "sim/reference/clutter_reference.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/wave_tolerance.h"

namespace insonate::test {
namespace {

using S = Stages<double>;

/// Of the samples that a pixel lies between: the largest |f|, the largest tolerance of a part of f, and that of V.
struct Between {
  double wave = 0, of_wave = 0, of_repeated = 0;
};

Between between(const Stages<double>& stages, const Image<double>& of_re, const Image<double>& of_im,
                const Image<double>& of_repeated, const glm::dvec2& at) {
  Between found;
  const int line = int(std::floor(at.x)), k = int(std::floor(at.y));
  for (int j = std::max(line - 1, 0); j <= std::min(line + 2, of_re.width - 1); ++j)
    for (int i = std::max(k - 1, 0); i <= std::min(k + 2, of_re.height - 1); ++i) {
      found.wave = std::max(found.wave, std::hypot(stages.wave_re.at(j, i), stages.wave_im.at(j, i)));
      found.of_wave = std::max(found.of_wave, std::hypot(of_re.at(j, i), of_im.at(j, i)));
      found.of_repeated = std::max(found.of_repeated, of_repeated.at(j, i));
    }
  return found;
}

/// Returns by how much of itself the body wall's haze may be wrong at each sample: what the tolerances of f make of the
/// echoes that it is computed from.
std::vector<double> haze_tolerance(const Stages<double>& expected, const Image<double>& of_re,
                                   const Image<double>& of_im, const ScanLines& lines, const Settings& settings) {
  Stages<double> louder = expected;
  for (std::size_t i = 0; i < of_re.pixels.size(); ++i) {
    const double f = std::hypot(expected.wave_re.pixels[i], expected.wave_im.pixels[i]);
    louder.wave_re.pixels[i] = f + std::hypot(of_re.pixels[i], of_im.pixels[i]);
    louder.wave_im.pixels[i] = 0;
  }
  const Image<double> haze = wall_clutter_reference(expected, lines, settings).most;
  const Image<double> most = wall_clutter_reference(louder, lines, settings).most;
  std::vector<double> share(haze.pixels.size());
  for (std::size_t k = 0; k < share.size(); ++k)
    if (haze.pixels[k] > 0) share[k] = most.pixels[k] / haze.pixels[k] - 1;
  return share;
}

}  // namespace

std::string disagreement_of_waves(const Scene& scene, const Stages<double>& expected, const Image<double>& rounding,
                                  const Stages<float>& got, const Spread& spread, Image<double>& fused_tolerance) {
  const ScanLines lines = scan_lines(scene.probe, scene.depth_mm, scene.settings.samples);
  const auto largest = [](const Image<double>& image) { return *std::ranges::max_element(image.pixels); };
  const auto differs = [&](const char* what, Image<double> S::*part, const Image<float>& shaders,
                           const Image<double>& allowed) {
    const Worst found = worst(expected.*part, shaders, allowed);
    return found.error < 1 ? "" : described(what, found);
  };

  const double strongest = largest(expected.scattered);
  const std::string of_scattered = differs(
      "scattered", &S::scattered, got.scattered,
      spread.tolerated(expected, &S::scattered, [&](double s) { return 3e-4 * s + 1e-10 * strongest + 1e-30; }));
  if (!of_scattered.empty()) return of_scattered;

  // The angles among which scatterers lie are known to 6e-7 rad (scatter.comp).
  const double of_angle = lines.fan.face == LineFan::Face::parallel ? 0 : 6e-7 / lines.fan.step;
  const WaveTolerance of_rounding = wave_tolerance(expected, rounding, lines, scene.settings, 5e-4 + of_angle);
  const auto allowed = [&](Image<double> S::*part, const Image<double>& rounded) {
    Image<double> tolerance = spread.tolerated(expected, part, [](double) { return 1e-15; });  // of kMinEcho's root
    for (std::size_t i = 0; i < tolerance.pixels.size(); ++i) tolerance.pixels[i] += rounded.pixels[i];
    return tolerance;
  };
  const Image<double> of_re = allowed(&S::wave_re, of_rounding.wave), of_im = allowed(&S::wave_im, of_rounding.wave);
  const Image<double> of_repeated = spread.tolerated(
      expected, &S::repeated, [at_least = 1e-4 * largest(expected.repeated)](double) { return at_least + 1e-12; });
  for (const std::string& fault :
       {differs("e, real", &S::echo_re, got.echo_re, allowed(&S::echo_re, of_rounding.echo)),
        differs("e, imaginary", &S::echo_im, got.echo_im, allowed(&S::echo_im, of_rounding.echo)),
        differs("f, real", &S::wave_re, got.wave_re, of_re), differs("f, imaginary", &S::wave_im, got.wave_im, of_im),
        differs("V", &S::repeated, got.repeated, of_repeated)})
    if (!fault.empty()) return fault;

  // U = |f + d + noise|^2 + V: an error df makes one of 2 |f + d + noise| df + df^2. The place of a pixel among the
  // samples is known in single precision, so f may be wrong there by a share of its neighbours. d is smooth: its error
  // by the place is far below the 1e-3 of U.
  const double place = 2.4e-7 * std::max(rounding.width, rounding.height);
  const ImageGeometry picture =
      image_geometry(scene.probe, scene.depth_mm, expected.fused.width, expected.fused.height);
  const std::vector<double> of_haze = haze_tolerance(expected, of_re, of_im, lines, scene.settings);
  fused_tolerance = Image<double>(expected.fused.width, expected.fused.height);
  for (int y = 0; y < fused_tolerance.height; ++y)
    for (int x = 0; x < fused_tolerance.width; ++x)
      if (const auto at = line_position(scene.probe, scene.depth_mm, picture.plane_mm(x, y))) {
        const Between beside = between(expected, of_re, of_im, of_repeated, {at->line, at->r_mm / lines.dr_mm() - 0.5});
        const double u = expected.fused.at(x, y), of_wave = beside.of_wave + place * beside.wave;
        const auto k = std::size_t(std::clamp(at->r_mm / lines.dr_mm() - 0.5, 0.0, double(lines.samples - 1)));
        const double haze = std::max(of_haze[k], of_haze[std::min(k + 1, of_haze.size() - 1)]);
        fused_tolerance.at(x, y) =
            2 * std::sqrt(u) * of_wave + of_wave * of_wave + beside.of_repeated + (1e-3 + haze) * u + kMinEcho;
      } else {
        fused_tolerance.at(x, y) = kMinEcho;
      }
  return "";
}

}  // namespace insonate::test
