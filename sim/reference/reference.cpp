#include "sim/reference/reference.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>

#include "sim/model/compounding.h"
#include "sim/model/noise.h"
#include "sim/model/refraction.h"
#include "sim/model/scatterers.h"
#include "sim/model/waves.h"
#include "sim/reference/clutter_reference.h"
#include "sim/reference/display_reference.h"
#include "sim/reference/reverberation_reference.h"
#include "sim/reference/wave_reference.h"

namespace insonate {
namespace {

/// Returns the lattice for a seed. It keeps the last one: drawing a lattice takes longer than a small picture.
std::shared_ptr<const ScattererLattice> lattice_of(std::uint32_t seed) {
  thread_local std::uint32_t kept_seed = 0;
  thread_local std::shared_ptr<const ScattererLattice> kept;
  if (!kept || kept_seed != seed) {
    kept = std::make_shared<ScattererLattice>(make_scatterers(seed));
    kept_seed = seed;
  }
  return kept;
}

/// Samples the lattice's complex amplitude at a patient position: trilinear, scaled back to variance 1.
class Scatterers {
public:
  explicit Scatterers(const Settings& settings)
      : lattice_(lattice_of(settings.speckle_seed)),
        lattice_from_patient_(lattice_from_patient(settings.speckle_cell_mm)) {}

  std::complex<double> at(const glm::dvec3& patient_mm) const {
    constexpr int side = ScattererLattice::kSide;
    const glm::dvec3 position = glm::dvec3(lattice_from_patient_ * glm::dvec4(patient_mm, 1)) * double(side) - 0.5;
    const glm::dvec3 floor = glm::floor(position);
    const glm::dvec3 f = position - floor;
    std::complex<double> sum = 0;
    double squares = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      const double weight = (step.x ? f.x : 1 - f.x) * (step.y ? f.y : 1 - f.y) * (step.z ? f.z : 1 - f.z);
      sum += weight * point(glm::ivec3(floor) + step);
      squares += weight * weight;
    }
    return sum / std::sqrt(squares);
  }

private:
  std::complex<double> point(const glm::ivec3& i) const {
    constexpr int side = ScattererLattice::kSide;
    const auto wrapped = [](int a) { return std::size_t((a % side + side) % side); };
    const std::size_t offset = 2 * ((wrapped(i.z) * side + wrapped(i.y)) * side + wrapped(i.x));
    return std::complex<double>(lattice_->stored[offset], lattice_->stored[offset + 1]) * (kScattererScale / 32767.0);
  }

  std::shared_ptr<const ScattererLattice> lattice_;
  glm::dmat4 lattice_from_patient_;
};

/// Smooths by a Gaussian over the pixels inside the fan, along rows and then columns, cut off at three sigma. Below a
/// twentieth of a pixel it returns the image unchanged.
Image<double> smoothed(const Image<double>& image, const Image<std::uint8_t>& inside, double sigma_px) {
  if (sigma_px < 0.05) return image;
  const int radius = std::min(int(std::ceil(3 * sigma_px)), std::max(image.width, image.height) - 1);
  const auto pass = [&](const Image<double>& from, int dx, int dy) {
    Image<double> to(from.width, from.height);
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x)
        for (int j = -radius; j <= radius && inside.at(x, y); ++j) {
          const int u = x + j * dx, v = y + j * dy;
          if (u >= 0 && v >= 0 && u < from.width && v < from.height)
            to.at(x, y) += std::exp(-0.5 * j * j / (sigma_px * sigma_px)) * from.at(u, v);
        }
    return to;
  };
  Image<double> ones(image.width, image.height);
  for (std::size_t i = 0; i < ones.pixels.size(); ++i) ones.pixels[i] = inside.pixels[i];
  Image<double> sum = pass(pass(image, 1, 0), 0, 1);
  const Image<double> weight = pass(pass(ones, 1, 0), 0, 1);
  for (std::size_t i = 0; i < sum.pixels.size(); ++i)
    if (inside.pixels[i]) sum.pixels[i] /= weight.pixels[i];
  return sum;
}

}  // namespace

/// Returns the share of gel in what lies within the gel layer, 0 to 1 (sim/tissue/coupling.h).
static double gel_share(double hu) {
  return std::clamp((kCouplingTissue_hu - hu) / (kCouplingTissue_hu - kCouplingAir_hu), 0.0, 1.0);
}

Medium with_gel(const Medium& medium, double r_mm, double coupling_depth_mm) {
  if (r_mm >= coupling_depth_mm) return medium;
  const double gel = gel_share(medium.hu);
  return {(1 - gel) * medium.hu, (1 - gel) * medium.echogenicity_db + gel * kMinEchogenicity_db};
}

MediumField trilinear_field(const AcousticVolume& volume) {
  return [&volume, inverse = glm::inverse(volume.grid.matrix())](const glm::dvec3& p) {
    const AcousticVoxel outside;
    const glm::dvec3 index(inverse * glm::dvec4(p, 1));
    const glm::dvec3 floor = glm::floor(index);
    if (!glm::all(glm::greaterThanEqual(floor, glm::dvec3(-1))) ||
        !glm::all(glm::lessThan(floor, glm::dvec3(volume.grid.size))))
      return Medium{double(outside.hu), outside.echogenicity_cdb / 100.0};
    const glm::dvec3 f = index - floor;
    Medium medium{0, 0};
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      const glm::ivec3 i = glm::ivec3(floor) + step;
      const double weight = (step.x ? f.x : 1 - f.x) * (step.y ? f.y : 1 - f.y) * (step.z ? f.z : 1 - f.z);
      const AcousticVoxel& voxel = volume.grid.contains(i) ? volume.at(i) : outside;
      medium.hu += weight * voxel.hu;
      medium.echogenicity_db += weight * voxel.echogenicity_cdb / 100.0;
    }
    return medium;
  };
}

ReferenceScan traverse_reference(const MediumField& field, const TissueTable& table, const ScanLines& lines,
                                 const Settings& settings, const Pose& patient_from_probe, const SlicePlane& plane,
                                 const StoredSpeckle* stored) {
  const int count = int(lines.lines.size());
  const double dr = lines.dr_mm(), l = settings.reflection_length_mm, coupled = coupling_depth_mm(settings);
  const Scatterers lattice(settings);
  ReferenceScan scan;
  const auto reserve = [&](auto... parts) { ((scan.*parts = Image<double>(count, lines.samples)), ...); };
  reserve(&ReferenceScan::intensity, &ReferenceScan::reflection);
  if (settings.waves)
    reserve(&ReferenceScan::amplitude, &ReferenceScan::mirror);
  else
    reserve(&ReferenceScan::echo_re, &ReferenceScan::echo_im);

  for (int line = 0; line < count; ++line) {
    const SlicePlane::Place& of_slice = plane.of_line(std::size_t(line));
    const ScanLine placed = line_beside(lines, std::size_t(line), of_slice.lateral);
    const glm::dvec3 start = patient_from_probe.point(placed.start);
    const glm::dvec3 d = placed.direction;
    const glm::dvec3 along = patient_from_probe.direction(d);
    const glm::dvec3 lateral = patient_from_probe.direction({d.y, -d.x, 0});
    const glm::dvec3 elevation = glm::cross(along, lateral);

    const glm::dvec3 out_of_plane = patient_from_probe.direction({0, 0, 1});
    const double offset = of_slice.offset;
    const auto place = [&](double r) {
      return start + r * along + offset * slice_thickness_at_mm(settings, r) * out_of_plane;
    };

    double intensity = 1;
    glm::dvec2 deflection(0);
    for (int k = 0; k < lines.samples; ++k) {
      const double r = lines.r_min_mm + (k + 0.5) * dr;
      const glm::dvec3 p = place(r);
      const Medium here = with_gel(field(p), r, coupled);
      const auto hu = [&](const glm::dvec3& at, double depth) { return with_gel(field(at), depth, coupled).hu; };
      const double a =
          (settings.absorption ? table.at(here.hu).absorption_db_cm_mhz : 0) + end_absorption(here.echogenicity_db);
      const auto absorbed = [&](double distance_mm) {
        return std::pow(10.0, -a * settings.frequency_mhz * distance_mm / 100);
      };

      const double hu_before = hu(place(r - l / 2), r - l / 2), hu_behind = hu(place(r + l / 2), r + l / 2);
      const double before = table.at(hu_before).impedance_mrayl, behind = table.at(hu_behind).impedance_mrayl;
      const double alpha = std::pow((behind - before) / (behind + before), 2);  // (1)
      // Impedance is a function of density, so both gradients have the same direction.
      const double left = hu(p - l / 2 * lateral, r), right = hu(p + l / 2 * lateral, r);
      const double below = hu(p - l / 2 * elevation, r), above = hu(p + l / 2 * elevation, r);
      const glm::dvec3 gradient(right - left, hu_behind - hu_before, above - below);
      const double steepness = glm::length(gradient);
      const double cosine = steepness > 0 ? std::abs(gradient.y) / steepness : 0;

      if (k == 0) intensity *= absorbed(dr / 2);
      scan.intensity.at(line, k) = intensity;
      double directed = settings.waves ? std::pow(cosine, settings.specular_exponent) : cosine;
      if (settings.waves && coupled > l / 2 + kMinGel_mm && r - l / 2 < coupled && r + l / 2 >= coupled)
        directed *= 1 + (kFreeGelShare - 1) * gel_share(hu_behind);
      scan.reflection.at(line, k) = heard(alpha * intensity * intensity * directed);  // (3)
      const double per_tenfold = settings.waves ? 20 : 10;  // amplitudes in dB of power, or as the paper's are
      const double amplitude =
          std::max(std::pow(10.0, here.echogenicity_db / per_tenfold) - std::pow(10.0, kSilent_db / per_tenfold), 0.0);
      if (settings.waves) {
        scan.amplitude.at(line, k) = amplitude;
        const double weak = settings.blend / 2,
                     surface = alpha * alpha / std::max(alpha * alpha + weak * weak, kMinEcho);
        scan.mirror.at(line, k) = std::copysign(std::sqrt(alpha * directed) * surface, behind - before);
      } else {
        const std::complex<double> echo = stored && settings.speckle
                                              ? stored_speckle_at(*stored, p)
                                              : amplitude * (settings.speckle ? lattice.at(p) : 1.0);
        scan.echo_re.at(line, k) = echo.real();
        scan.echo_im.at(line, k) = echo.imag();
      }

      intensity *= std::pow(1 - alpha, dr / l) * absorbed(dr);  // (5)
      if (settings.edge_shadow) {
        const auto log_speed = [](double density) {
          return std::clamp(density, kMinRefracting_hu, kMaxRefracting_hu) *
                 (density < 0 ? kLogSpeedBelowWater : kLogSpeedAboveWater);
        };
        const glm::dvec2 rise(log_speed(right) - log_speed(left), log_speed(above) - log_speed(below));
        deflection = std::exp(-dr / kDeflection_mm) * deflection + dr / l * rise;
        const double q = std::pow(glm::length(deflection) / kDeflection_rad, 4);
        intensity *= std::exp(-2 * q / (2 + q) * dr / kDeflection_mm);
      }
    }
  }
  return scan;
}

double heard(double echo) {
  return echo > kMinEcho ? echo : 0;
}

namespace {

using Wave = Image<std::complex<double>>;

/// Adds the planes of the slice up, and computes V before the beam's width.
struct Slice {
  ReferenceScan scan;            // weighted sums over the planes
  Image<double> mirrors, rough;  // with waves: of q I, and of the square that n's factor is the root of
  Image<double> scattered, repeats;
  Image<double> middle_intensity, middle_reflection;
};

/// Adds what a plane sends back, as waves (sim/model/waves.h).
void add_waves(Slice& slice, const ReferenceScan& one, const SlicePlane& plane, const Settings& settings) {
  for (std::size_t i = 0; i < one.intensity.pixels.size(); ++i) {
    const double weight = plane.of_line(i % std::size_t(one.intensity.width)).weight;
    const double intensity = one.intensity.pixels[i], squared = heard(intensity * intensity);
    const double transmission = settings.two_way ? squared : heard(intensity);
    const double scattered = std::sqrt(settings.blend * transmission) * one.amplitude.pixels[i];
    const double mirrored = std::sqrt(squared) * one.mirror.pixels[i];
    slice.mirrors.pixels[i] += weight * mirrored;
    slice.rough.pixels[i] += weight * std::pow(kRoughShare * mirrored + scattered, 2);
    slice.scattered.pixels[i] += weight * scattered * scattered;
    slice.scan.intensity.pixels[i] += weight * intensity;
  }
}

Slice traverse_slice(const MediumField& field, const TissueTable& table, const ScanLines& lines,
                     const Settings& settings, const Pose& patient_from_probe, const StoredSpeckle* stored) {
  const Image<double> none(int(lines.lines.size()), lines.samples);
  Slice slice{ReferenceScan{none, none, none, none, {}, {}}, none, none, none, none, {}, {}};
  const std::vector<SlicePlane> planes = slice_planes(settings);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const ReferenceScan one = traverse_reference(field, table, lines, settings, patient_from_probe, planes[p], stored);
    if (settings.waves) {
      add_waves(slice, one, planes[p], settings);
    } else {
      for (Image<double> ReferenceScan::*part :
           {&ReferenceScan::intensity, &ReferenceScan::reflection, &ReferenceScan::echo_re, &ReferenceScan::echo_im})
        for (std::size_t i = 0; i < (one.*part).pixels.size(); ++i)
          (slice.scan.*part).pixels[i] += planes[p].of_line(0).weight * (one.*part).pixels[i];  // of all lines alike
    }
    if (p != planes.size() / 2) continue;
    slice.repeats = reverberation_reference(one.intensity, one.reflection, lines, settings);
    slice.middle_intensity = one.intensity;
    slice.middle_reflection = one.reflection;
  }
  return slice;
}

/// Computes the stages of the beam (4) as the paper's model has them.
void widen(Stages<double>& stages, Slice& slice, const ScanLines& lines, const Settings& settings, bool is_stored) {
  const int n = int(lines.lines.size()), d = lines.samples;
  stages.reflection_beam = stages.transmission = stages.speckle = Image<double>(n, d);
  const std::vector<double> sigma = focused_beam_sigma(lines, settings);
  const std::vector<double> scale = envelope_scale(lines, settings);
  for (int k = 0; k < d; ++k) {
    const std::vector<double> weights = beam_weights_at(settings, sigma[std::size_t(k)]);
    const int half = int(weights.size() / 2);
    for (int line = 0; line < n; ++line) {
      double reflection = 0, total = 0;
      std::complex<double> echo = 0;
      for (int j = -half; j <= half; ++j) {  // (4)
        if (line + j < 0 || line + j >= n) continue;
        const double weight = weights[std::size_t(j + half)];
        reflection += weight * slice.scan.reflection.at(line + j, k);
        echo += weight * std::complex(slice.scan.echo_re.at(line + j, k), slice.scan.echo_im.at(line + j, k));
        total += weight;
      }
      stages.reflection_beam.at(line, k) = reflection / total;
      const double intensity = slice.scan.intensity.at(line, k);
      stages.transmission.at(line, k) = heard(settings.two_way ? intensity * intensity : intensity);
      stages.speckle.at(line, k) = is_stored && settings.speckle
                                       ? slice.scan.echo_re.at(line, k)
                                       : std::abs(echo) / total * (settings.speckle ? scale[std::size_t(k)] : 1);
      slice.scattered.at(line, k) = settings.blend * stages.transmission.at(line, k) * stages.speckle.at(line, k);
    }
  }
  stages.reflection = std::move(slice.scan.reflection);
}

void sum_waves(Stages<double>& stages, const Slice& slice, const ScanLines& lines, const Settings& settings,
               const Pose& patient_from_probe) {
  const auto part = [](const Wave& wave, auto of) {
    Image<double> image(wave.width, wave.height);
    std::ranges::transform(wave.pixels, image.pixels.begin(), of);
    return image;
  };
  const auto re = [](const std::complex<double>& c) { return c.real(); };
  const auto im = [](const std::complex<double>& c) { return c.imag(); };
  Wave echo = scatterers_reference(lines, settings, patient_from_probe);
  for (std::size_t i = 0; i < echo.pixels.size(); ++i)
    echo.pixels[i] = kMirrorShare * slice.mirrors.pixels[i] + std::sqrt(slice.rough.pixels[i]) * echo.pixels[i];
  if (settings.mirror_image > 0)
    add_mirror_images(echo, slice.middle_intensity, slice.middle_reflection, lines, settings);
  const Wave wave = wave_reference(echo, lines, settings);
  stages.echo_re = part(echo, re);
  stages.echo_im = part(echo, im);
  stages.wave_re = part(wave, re);
  stages.wave_im = part(wave, im);
  stages.scattered = slice.scattered;
}

/// Returns V behind the beam's width: a mean over the aperture or, with waves, a sum over the lines that are there.
Image<double> widened(const Image<double>& repeats, const ScanLines& lines, const Settings& settings) {
  Image<double> wide(repeats.width, repeats.height);
  const std::vector<double> sigma = focused_beam_sigma(lines, settings);
  for (int k = 0; k < wide.height; ++k) {
    const std::vector<double> weights = beam_weights_at(settings, sigma[std::size_t(k)]);
    const int half = int(weights.size() / 2);
    for (int line = 0; line < wide.width; ++line) {
      double sum = 0, total = 0;
      for (int j = -half; j <= half; ++j) {
        if (line + j < 0 || line + j >= wide.width) continue;
        sum += weights[std::size_t(j + half)] * repeats.at(line + j, k);
        total += weights[std::size_t(j + half)];
      }
      wide.at(line, k) = settings.waves ? sum : sum / total;
    }
  }
  return wide;
}

/// Returns the mean of the scatterers' echo at each depth over the lines, with its tail, for clutter.
Image<double> mean_echo_of(const Image<double>& scattered, double dr_mm) {
  Image<double> mean(1, scattered.height);
  for (int k = 0; k < scattered.height; ++k)
    for (int line = 0; line < scattered.width; ++line) mean.at(0, k) += scattered.at(line, k) / scattered.width;
  for (int k = 1; k < scattered.height; ++k)
    mean.at(0, k) += (mean.at(0, k - 1) - mean.at(0, k)) * std::exp(-dr_mm / kClutterTail_mm);
  return mean;
}

/// What one look of a picture (sim/model/compounding.h) shows: its stages up to f, and U and inside at its pixels.
Stages<double> look_reference(const MediumField& field, const TissueTable& table, const Probe& probe,
                              const ScanLines& lines, const Settings& settings, const Pose& patient_from_probe,
                              int look, const StoredSpeckle* stored) {
  Slice slice = traverse_slice(field, table, lines, settings, patient_from_probe, stored);
  Stages<double> stages;
  if (settings.waves)
    sum_waves(stages, slice, lines, settings, patient_from_probe);
  else
    widen(stages, slice, lines, settings, stored != nullptr);
  stages.repeated = widened(slice.repeats, lines, settings);
  stages.intensity = std::move(slice.scan.intensity);

  const int w = settings.image_width, h = settings.image_height;
  const ImageGeometry geometry = image_geometry(probe, lines.r_max_mm, w, h);
  const Image<double> mean_echo = mean_echo_of(slice.scattered, lines.dr_mm()),
                      noise_of_lines = electronic_noise(lines, settings);
  const WallClutter wall_clutter = wall_clutter_reference(stages, lines, settings);
  const ScanLines straight = scan_lines(probe, lines.r_max_mm, lines.samples);
  const Wave waves_of_receiver = noise_wave(straight, settings);
  const glm::ivec2 shift = noise_shift(patient_from_probe, look);
  Image<double> reflection(w, h), transmission(w, h), speckle(w, h), beside(w, h);
  stages.inside = Image<std::uint8_t>(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const glm::dvec2 at = geometry.plane_mm(x, y);
      const auto position =
          lines.fan.steering == 0 ? line_position(probe, lines.r_max_mm, at) : position_within(lines, at);
      if (!position) continue;
      const double sample = position->r_mm / lines.dr_mm() - 0.5;
      const auto here = [&](const Image<double>& image) { return bilinear(image, position->line, sample); };
      const double noise = noise_level(settings) + clutter_share(settings) * bilinear(mean_echo, 0, sample) +
                           wall_clutter.at(position->line, sample);
      stages.inside.at(x, y) = 1;
      if (settings.waves) {
        std::complex<double> wave(here(stages.wave_re) + ring_down_at(settings, position->r_mm), here(stages.wave_im));
        if (noise > 0)
          wave += std::sqrt(noise) *
                  noise_of_pixel(waves_of_receiver, geometry, straight, (x + shift.x) % w, (y + shift.y) % h);
        beside.at(x, y) = heard(std::norm(wave) + here(stages.repeated));
        continue;
      }
      reflection.at(x, y) = here(stages.reflection_beam);
      transmission.at(x, y) = here(stages.transmission);
      speckle.at(x, y) = here(stages.speckle);
      beside.at(x, y) = here(stages.repeated) + noise * here(noise_of_lines);
    }
  if (!settings.waves) {
    reflection = smoothed(reflection, stages.inside, settings.reflection_sigma_mm / geometry.mm_per_pixel);
    transmission = smoothed(transmission, stages.inside, settings.transmission_sigma_mm / geometry.mm_per_pixel);
  }
  stages.fused = Image<double>(w, h);
  for (std::size_t i = 0; i < stages.fused.pixels.size(); ++i)
    stages.fused.pixels[i] =
        (reflection.pixels[i] + settings.blend * transmission.pixels[i]) * speckle.pixels[i] + beside.pixels[i];  // (6)
  return stages;
}

}  // namespace

Stages<double> simulate_reference(const MediumField& field, const TissueTable& table, const Probe& probe,
                                  double depth_mm, const Settings& settings, const Pose& patient_from_probe,
                                  const StoredSpeckle* stored) {
  const std::vector<Pose> of_looks(look_angles(probe, settings).size(), patient_from_probe);
  return looks_reference(field, table, probe, depth_mm, settings, of_looks, nullptr, stored);
}

Stages<double> looks_reference(const MediumField& field, const TissueTable& table, const Probe& probe, double depth_mm,
                               const Settings& settings, std::span<const Pose> of_looks,
                               const Image<double>* frame_before, const StoredSpeckle* stored) {
  const std::vector<double> angles = look_angles(probe, settings);
  const std::size_t middle = angles.size() / 2;
  std::vector<Stages<double>> looks;
  for (std::size_t i = 0; i < angles.size(); ++i)
    looks.push_back(look_reference(field, table, probe, scan_lines(probe, depth_mm, settings.samples, angles[i]),
                                   settings, of_looks[i], i == middle ? 0 : int(i) + 1, stored));
  Stages<double> stages = looks[middle];
  if (looks.size() > 1)
    for (std::size_t i = 0; i < stages.fused.pixels.size(); ++i) {
      double sum = 0;
      int count = 0;
      for (const Stages<double>& look : looks)
        if (look.inside.pixels[i]) {
          sum += std::sqrt(look.fused.pixels[i]);
          ++count;
        }
      if (count > 0) stages.fused.pixels[i] = std::pow(sum / count, 2);
    }
  show_reference(stages, probe, depth_mm, settings, int(looks.size()), frame_before);
  return stages;
}

}  // namespace insonate
