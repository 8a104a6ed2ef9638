#include "sim/imaging/stage_tables.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <optional>

#include "sim/core/image.h"
#include "sim/model/beam.h"
#include "sim/model/noise.h"
#include "sim/model/refraction.h"
#include "sim/model/reverberation.h"
#include "sim/model/scatterers.h"
#include "sim/model/waves.h"

namespace insonate::gl {
namespace {

constexpr double kLn10 = 2.302585092994046;

// An interface is too weak for its tilt to be visible if it echoes less than this share of what the scatterers do:
// 0.004 dB. The beam's width carries the echo into neighbouring shadows, where scatterers are weaker. Clutter of as
// much covers it there. Without clutter the share is smaller, so that 30 dB of shadow do not reveal the tilt.
constexpr double kUnseenShare = 0.001, kUnseenShareInShadow = 1e-6;
constexpr double kMaxBlend = 1e-3;  // limit for the blend above: beyond it, reverberation would still show the tilt

/// The part of each pixel's window that lies inside the fan, rows first, as smooth.comp and fuse.comp sum.
class InsideWindow {
public:
  InsideWindow(const Image<std::uint8_t>& inside, const Gaussian& gaussian)
      : margin_(gaussian.radius), along_rows_(inside.width, inside.height) {
    std::vector<double> up_to{0};  // the sum of the weights before the i-th of the window
    for (int j = -margin_; j <= margin_; ++j) {
      weights_.push_back(float(std::exp(gaussian.exponent * j * j)));
      up_to.push_back(up_to.back() + double(weights_.back()));
    }
    const int width = inside.width, window = 2 * margin_ + 1;
    tbb::parallel_for(0, inside.height, [&](int y) {
      const std::uint8_t* row = &inside.at(0, y);
      float* parts = &along_rows_.at(0, y);
      // The fan crosses a row in one stretch, or in two beside its face.
      for (const std::uint8_t *end = row, *const last = row + width; end != last;) {
        const std::uint8_t* begin = std::find(end, last, 1);
        end = std::find(begin, last, 0);
        const int from = int(begin - row), to = int(end - row);
        for (int x = std::max(from - margin_, 0); x < std::min(to + margin_, width); ++x)
          if (row[x])
            parts[x] += float(up_to[std::size_t(std::clamp(to - x + margin_, 0, window))] -
                              up_to[std::size_t(std::clamp(from - x + margin_, 0, window))]);
      }
    });
  }

  /// Returns the parts of a row's pixels.
  std::vector<float> row(int y) const {
    std::vector<float> parts(std::size_t(along_rows_.width));
    for (int i = std::max(y - margin_, 0); i <= std::min(y + margin_, along_rows_.height - 1); ++i)
      for (std::size_t x = 0; x < parts.size(); ++x) parts[x] += weight(i - y) * along_rows_.at(int(x), i);
    return parts;
  }

private:
  float weight(int j) const { return weights_[std::size_t(j + margin_)]; }

  int margin_;
  std::vector<float> weights_;
  Image<float> along_rows_;
};

constexpr float kFar = 1e9f;  // samples

// Returns the first and the last sample of a line that may meet the body within `margin` beside it. Both leave one
// sample of tolerance, because the shader rounds its own positions. First > last if no sample does.
std::pair<float, float> samples_in_body(const DeviceVolume& volume, const glm::dvec3& start, const glm::dvec3& along,
                                        const glm::dvec3& margin, double last_sample) {
  const auto [first, last] = volume.meets_body(start, along, margin);
  if (last < first || last + 1 < 0 || first - 1 > last_sample) return {kFar, -kFar};
  return {float(first - 1), float(last + 1)};
}

// Returns the smallest and the largest slice thickness that a line's samples, and their margin, meet where slice planes
// bend, mm; (0, 0) where they do not bend.
std::pair<double, double> bent_between(const ScanLines& lines, const Settings& settings) {
  if (!has_elevation_focus(settings)) return {0, 0};
  const double margin = settings.reflection_length_mm / 2;
  const double at_face = slice_thickness_at_mm(settings, lines.r_min_mm - margin),
               at_end = slice_thickness_at_mm(settings, lines.r_max_mm + margin);
  return {settings.slice_thickness_mm, std::max(at_face, at_end)};
}

}  // namespace

bool meets_no_body(const PlacedLine& line) {
  return line.start.w > line.along.w;
}

std::vector<PlacedLine> line_in_air(const Settings& settings) {
  PlacedLine line{};
  line.start = glm::vec4(-1, -1, -1, -kFar);  // outside the texture; no sample from the face on lies in the body
  line.along.w = -kFar;
  line.elevation.w = 1;
  std::vector<PlacedLine> planes(std::size_t(settings.slice_planes), line);
  planes.front().lateral.w = 1;  // all slice planes give the same there; they are weighted where they are stored
  return planes;
}

std::vector<PlacedLine> placed_lines(const DeviceVolume& volume, const Pose& patient_from_probe, const ScanLines& lines,
                                     const Settings& settings, const glm::dmat4* stored_from_patient) {
  const glm::dmat4 texture_from_probe = volume.texture_from_patient() * patient_from_probe.matrix();
  glm::dmat4 lattice_from_probe = lattice_from_patient(settings.speckle_cell_mm) * patient_from_probe.matrix();
  // Whole periods of the translation change nothing, but would cost digits of the shader's single precision.
  for (int axis = 0; axis < 3; ++axis) lattice_from_probe[3][axis] -= std::floor(lattice_from_probe[3][axis]);
  if (stored_from_patient) lattice_from_probe = *stored_from_patient * patient_from_probe.matrix();

  const auto point = [](const glm::dmat4& map, const glm::dvec3& p) { return glm::dvec3(map * glm::dvec4(p, 1)); };
  const auto step = [](const glm::dmat4& map, const glm::dvec3& d) { return glm::dvec3(map * glm::dvec4(d, 0)); };
  const double dr = lines.dr_mm(), half_length = settings.reflection_length_mm / 2;
  const std::pair<double, double> bent = bent_between(lines, settings);
  std::vector<PlacedLine> placed;
  placed.reserve(std::size_t(settings.slice_planes) * lines.lines.size());
  for (const SlicePlane& plane : slice_planes(settings))
    for (std::size_t i = 0; i < lines.lines.size(); ++i) {
      const auto [offset, weight, beside_line] = plane.of_line(i);
      const ScanLine line = line_beside(lines, i, beside_line);
      const glm::dvec3 d = line.direction, lateral(d.y, -d.x, 0), elevation = glm::cross(d, lateral);
      const double beside = has_elevation_focus(settings) ? 0 : offset * settings.slice_thickness_mm;
      const glm::dvec3 first = line.start + glm::dvec3(0, 0, beside) + (lines.r_min_mm + dr / 2) * d;
      const glm::dvec3 start = point(texture_from_probe, first), along = step(texture_from_probe, dr * d);
      const glm::dvec3 to_side = step(texture_from_probe, half_length * lateral),
                       to_elevation = step(texture_from_probe, half_length * elevation),
                       elevated = step(texture_from_probe, {0, 0, offset});
      // Sound meets what lies within half the reflection length of a sample. A bent line stays between its smallest and
      // its largest distance from the imaging plane.
      const glm::dvec3 margin = glm::abs(to_side) + glm::abs(to_elevation) + half_length / dr * glm::abs(along) +
                                (bent.second - bent.first) / 2 * glm::abs(elevated);
      const glm::dvec3 middle = start + (bent.first + bent.second) / 2 * elevated;
      const auto [first_met, last_met] = settings.skipping
                                             ? samples_in_body(volume, middle, along, margin, lines.samples - 1)
                                             : std::pair(-kFar, kFar);
      placed.push_back({{start, first_met},
                        {along, last_met},
                        {to_side, weight},
                        {to_elevation, 0},
                        {point(lattice_from_probe, first), 0},
                        {step(lattice_from_probe, dr * d), 0},
                        {elevated, 0},
                        {step(lattice_from_probe, {0, 0, offset}), 0}});
    }
  return placed;
}

Buffer half_beam_window(const Settings& settings) {
  constexpr std::size_t kWeights = 128;
  const std::vector<double> window = beam_weights(settings);
  std::vector<float> half(window.begin() + std::ptrdiff_t(window.size() / 2), window.end());
  half.resize(kWeights);
  return Buffer(half.size() * sizeof(float), half.data());
}

TexelBuffer beam_by_depth(const ScanLines& lines, const Settings& settings) {
  std::vector<glm::vec4> depths(std::size_t(lines.samples), glm::vec4(1, 0, 0, 0));
  const std::vector<double> sigma = focused_beam_sigma(lines, settings);
  if (settings.waves) {
    // beam_weights() has the sum 1 already; the shader's own Gaussian begins with 1.
    for (std::size_t k = 0; settings.focused_beam && k < depths.size(); ++k) {
      const std::vector<double> weights = beam_weights_at(settings, sigma[k]);
      depths[k].x = float(weights[weights.size() / 2]);
    }
  } else if (settings.speckle) {
    const std::vector<double> scale = envelope_scale(lines, settings);
    for (std::size_t k = 0; k < depths.size(); ++k) depths[k].x = float(scale[k]);
  }
  if (settings.focused_beam) {
    for (std::size_t k = 0; k < depths.size(); ++k) {
      depths[k].y = float(focused_radius(sigma[k]));
      depths[k].z = depths[k].y > 0 ? float(-0.5 / (sigma[k] * sigma[k])) : 0;
    }
  }
  return TexelBuffer(GL_RGBA32F, depths.size(), depths.data());
}

Gaussian::Gaussian(double sigma_px, int limit_px) {
  if (sigma_px < 0.05) return;
  radius = std::min(int(std::ceil(3 * sigma_px)), limit_px);
  exponent = -0.5 / (sigma_px * sigma_px);
}

bool reverberates(const Settings& settings) {
  return settings.reverberation || settings.face_reflection > 0;
}
bool is_noisy(const Settings& settings) {
  return settings.electronic_noise || settings.clutter;
}
bool has_time_gain(const Settings& settings) {
  return std::ranges::any_of(settings.tgc_db, [](double db) { return db != 0; });
}
bool keeps_middle_plane(const Settings& settings) {
  return mirrors(settings) || ((settings.slice_planes > 1 || settings.waves) && reverberates(settings));
}
bool mirrors(const Settings& settings) {
  return settings.waves && settings.mirror_image > 0;
}

double least_alpha_with_normal(const Settings& settings) {
  if (!settings.skipping) return 0;
  return std::clamp(clutter_share(settings), kUnseenShareInShadow, kUnseenShare) * std::min(settings.blend, kMaxBlend);
}

SimulationParameters parameters_of(const Settings& settings, const ScanLines& lines, const Gaussian& reflection,
                                   const Gaussian& transmission) {
  const double dr = lines.dr_mm(), samples_per_length = settings.reflection_length_mm / dr;
  SimulationParameters p{};
  p.lines = int(lines.lines.size());
  p.samples = lines.samples;
  p.planes = 1;
  p.width = settings.image_width;
  p.height = settings.image_height;
  p.r_min_mm = float(lines.r_min_mm);
  p.dr_mm = float(dr);
  p.half_reflection_length = float(samples_per_length / 2);
  p.reflection_exponent = float(1 / samples_per_length);
  p.absorption_per_sample = float(settings.frequency_mhz * dr / 100 * kLn10);
  p.coupling_depth_mm = float(coupling_depth_mm(settings));
  p.least_alpha_with_normal = float(least_alpha_with_normal(settings));
  p.reflection_exponent_px = float(reflection.exponent);
  p.transmission_exponent_px = float(transmission.exponent);
  p.face_reflection = float(face_reflection(settings, lines.fan.steering));
  p.mirror_amplitude = float(std::sqrt(settings.mirror_image));
  p.face_amplitude = float(std::sqrt(settings.face_reflection));
  p.deflection_kept = float(std::exp(-dr / kDeflection_mm));
  p.deflection_per_step = float(dr / (settings.reflection_length_mm * kDeflection_rad));
  p.deflection_loss = float(dr / kDeflection_mm);
  p.slice_thickness_mm = float(settings.slice_thickness_mm);
  p.elevation_focus_mm = float(settings.elevation_focus_mm);
  p.clutter_kept = float(std::exp(-dr / kClutterTail_mm));
  p.slice_spread = float(slice_spread(settings));
  p.two_way = settings.two_way;
  p.specular_exponent = float(settings.specular_exponent);
  p.blend_amplitude = float(std::sqrt(settings.blend));
  const std::vector<double> pulse = pulse_weights(lines, settings);
  if (const std::size_t middle = pulse.size() / 2; middle > 0)
    p.pulse_exponent = float(std::log(pulse[middle + 1] / pulse[middle]));
  p.blend = float(settings.blend);
  p.clutter_share = float(clutter_share(settings));
  p.noise_level = float(noise_level(settings));
  p.edge_enhancement = float(settings.edge_enhancement);
  p.speckle_reduction = float(settings.speckle_reduction);
  p.ring_down = float(ring_down_at(settings, lines.r_min_mm));
  p.ring_down_per_sample = float(dr * settings.frequency_mhz / (1.54 * kRingDownWavelengths) * kLn10);
  p.gain_db = float(settings.gain_db);
  p.dynamic_range_db = float(settings.dynamic_range_db);
  p.fixed_level = float(settings.fixed_level);
  for (int i = 0; i < 8; ++i) p.tgc_db[i / 4][i % 4] = float(settings.tgc_db[std::size_t(i)]);
  return p;
}

TexelBuffer weights_of_pixels(const FanLayout& fan, const Gaussian& reflection, const Gaussian& transmission) {
  const InsideWindow of_reflection(fan.inside, reflection);
  std::optional<InsideWindow> of_transmission;
  if (transmission.radius > 0) of_transmission.emplace(fan.inside, transmission);
  const std::size_t channels = of_transmission ? 4 : 2, width = std::size_t(fan.inside.width);
  const auto values = std::make_unique_for_overwrite<float[]>(channels * fan.inside.pixels.size());
  tbb::parallel_for(0, fan.inside.height, [&](int y) {
    const std::vector<float> reflected = of_reflection.row(y);
    const std::vector<float> transmitted = of_transmission ? of_transmission->row(y) : std::vector<float>();
    for (std::size_t x = 0, pixel = std::size_t(y) * width; x < width; ++x, ++pixel) {
      float* of_pixel = values.get() + channels * pixel;
      const bool inside = fan.inside.pixels[pixel];
      of_pixel[0] = inside ? fan.line_and_sample[pixel].y + 1 : 0;
      of_pixel[1] = inside ? 1 / reflected[x] : 0;
      if (!of_transmission) continue;
      of_pixel[2] = inside ? 1 / transmitted[x] : 0;
      of_pixel[3] = 0;
    }
  });
  return TexelBuffer(channels == 4 ? GL_RGBA32F : GL_RG32F, fan.inside.pixels.size(), values.get());
}

TexelBuffer noise_of_lines(const ScanLines& lines, const Settings& settings) {
  const Image<double> noise = electronic_noise(lines, settings);
  std::vector<float> rows;
  for (int line = 0; line < noise.width; ++line)
    for (int k = 0; k < noise.height; ++k) rows.push_back(float(noise.at(line, k)));
  return TexelBuffer(GL_R32F, rows.size(), rows.data());
}

TexelBuffer noise_waves_of_lines(const ScanLines& lines, const Settings& settings) {
  const Image<std::complex<double>> noise = noise_wave(lines, settings);
  std::vector<glm::vec2> rows;
  for (int line = 0; line < noise.width; ++line)
    for (int k = 0; k < noise.height; ++k) rows.emplace_back(noise.at(line, k).real(), noise.at(line, k).imag());
  return TexelBuffer(GL_RG32F, rows.size(), rows.data());
}

TexelBuffer noise_waves_of_pixels(const ImageGeometry& geometry, const ScanLines& lines, const Settings& settings) {
  const Image<std::complex<double>> of_samples = noise_wave(lines, settings);
  std::vector<glm::vec2> of_pixels(std::size_t(geometry.width) * std::size_t(geometry.height));
  tbb::parallel_for(0, geometry.height, [&](int y) {
    glm::vec2* pixel = of_pixels.data() + std::size_t(y) * std::size_t(geometry.width);
    for (int x = 0; x < geometry.width; ++x) {
      const std::complex<double> noise = noise_of_pixel(of_samples, geometry, lines, x, y);
      *pixel++ = glm::vec2(noise.real(), noise.imag());
    }
  });
  return TexelBuffer(GL_RG32F, of_pixels.size(), of_pixels.data());
}

TexelBuffer noise_of_pixels(const FanLayout& fan, const ScanLines& lines, const Settings& settings) {
  const Image<double> of_samples = electronic_noise(lines, settings);
  std::vector<float> of_pixels;
  for (std::size_t i = 0; i < fan.inside.pixels.size(); ++i)
    of_pixels.push_back(fan.inside.pixels[i] ? float(bilinear(of_samples, double(fan.line_and_sample[i].x),
                                                              double(fan.line_and_sample[i].y)))
                                             : 0);
  return TexelBuffer(GL_R32F, of_pixels.size(), of_pixels.data());
}

}  // namespace insonate::gl
