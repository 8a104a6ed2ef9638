#include "sim/wein/wein_reference.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace insonate {
namespace {

double voxel_hu(const AcousticVolume& volume, const glm::ivec3& i) {
  return volume.grid.contains(i) ? volume.at(i).hu : AcousticVoxel{}.hu;
}

/// Returns HU along one axis of the grid, at a whole index plus a distance in voxels.
double hu_along(const AcousticVolume& volume, glm::ivec3 i, int axis, double distance) {
  const double floor = std::floor(distance), f = distance - floor;
  i[axis] += int(floor);
  glm::ivec3 next = i;
  ++next[axis];
  return (1 - f) * voxel_hu(volume, i) + f * voxel_hu(volume, next);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / double(values.size());
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

struct Explained {
  double explained = 0, variance = 0;  ///< sums of squares
};

/// Returns how much of u's variance the best linear combination of the terms and a constant explains.
Explained explained_by(std::vector<double> u, std::vector<std::vector<double>> terms) {
  if (u.empty() || *std::max_element(u.begin(), u.end()) == *std::min_element(u.begin(), u.end())) return {};
  const auto centre = [](std::vector<double>& values) {
    const double mean = mean_of(values);
    for (double& value : values) value -= mean;
  };
  centre(u);
  const double variance = dot(u, u);

  // Subtracting the means takes out the constant. The terms are then made orthogonal, one after the other, and
  // subtracted from the image.
  std::vector<std::vector<double>> basis;
  for (std::vector<double>& term : terms) {
    centre(term);
    for (const std::vector<double>& known : basis) {
      const double share = dot(term, known) / dot(known, known);
      for (std::size_t i = 0; i < term.size(); ++i) term[i] -= share * known[i];
    }
    if (std::sqrt(dot(term, term) / double(term.size())) >= kMinTermDeviation) basis.push_back(term);
  }
  for (const std::vector<double>& term : basis) {
    const double share = dot(u, term) / dot(term, term);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] -= share * term[i];
  }
  return {variance - dot(u, u), variance};
}

}  // namespace

WeinField wein_field(const AcousticVolume& volume, double reflection_length_mm) {
  return [&volume, l = reflection_length_mm](const glm::dvec3& p) {
    const Grid& grid = volume.grid;
    const glm::dvec3 index = grid.index_from_patient(p), floor = glm::floor(index), f = index - floor;
    WeinMedium medium{0, glm::dvec3(0)};
    glm::dvec3 along_axes(0);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      const glm::dvec3 i = floor + glm::dvec3(step);
      const double weight = (step.x ? f.x : 1 - f.x) * (step.y ? f.y : 1 - f.y) * (step.z ? f.z : 1 - f.z);
      const glm::dvec3 size(grid.size);
      const bool exists = i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
      if (!exists) {
        medium.hu += weight * AcousticVoxel{}.hu;
        continue;
      }
      const glm::ivec3 voxel(i);
      medium.hu += weight * voxel_hu(volume, voxel);
      for (int axis = 0; axis < 3; ++axis) {
        const double half = l / 2 / grid.spacing[axis];
        along_axes[axis] += weight * (hu_along(volume, voxel, axis, half) - hu_along(volume, voxel, axis, -half));
      }
    }
    medium.gradient_hu = grid.direction * along_axes;
    return medium;
  };
}

WeinStages<double> wein_reference(const WeinField& field, const Probe& probe, double depth_mm,
                                  const WeinSettings& settings, const Pose& patient_from_probe) {
  const ScanLines lines = scan_lines(probe, depth_mm, settings.samples);
  const int n = int(lines.lines.size());
  const double dr = lines.dr_mm();
  WeinStages<double> stages;
  stages.intensity = stages.scan_echogenicity = stages.scan_reflection = Image<double>(n, lines.samples);
  for (int line = 0; line < n; ++line) {
    const ScanLine& sight = lines.lines[std::size_t(line)];
    const glm::dvec3 d = patient_from_probe.direction(sight.direction);
    double intensity = 1;
    for (int k = 0; k < lines.samples; ++k) {
      const double r = lines.r_min_mm + (k + 0.5) * dr;
      WeinMedium medium = field(patient_from_probe.point(sight.start + r * sight.direction));
      if (r < settings.contact_mm) {
        medium.hu *=
            1 - std::clamp((kCouplingTissue_hu - medium.hu) / (kCouplingTissue_hu - kCouplingAir_hu), 0.0, 1.0);
        medium.gradient_hu = glm::dvec3(0);
      }
      const double mu = std::max(medium.hu + 1000, kAirMu);
      const double steepness = glm::length(medium.gradient_hu), change = std::min(steepness / (2 * mu), 1.0);
      const double cosine = steepness > 0 ? std::abs(glm::dot(d, medium.gradient_hu)) / steepness : 0;
      const double reflected = change * change * cosine;

      stages.intensity.at(line, k) = intensity;
      stages.scan_reflection.at(line, k) =
          std::log(1 + settings.compression * intensity * reflected) / std::log(1 + settings.compression);
      const double echogenicity =
          std::clamp((medium.hu - settings.dark_hu) / (settings.bright_hu - settings.dark_hu), 0.0, 1.0);
      stages.scan_echogenicity.at(line, k) = settings.shadows ? intensity * echogenicity : echogenicity;
      intensity *= std::pow(1 - change * change, dr / settings.reflection_length_mm);
    }
  }

  const int w = settings.image_width, h = settings.image_height;
  const ImageGeometry geometry = image_geometry(probe, depth_mm, w, h);
  stages.echogenicity = stages.reflection = Image<double>(w, h);
  stages.grey = Image<std::uint8_t>(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto at = line_position(probe, depth_mm, geometry.plane_mm(x, y));
      if (!at) continue;
      const double sample = (at->r_mm - lines.r_min_mm) / dr - 0.5;
      const double e = bilinear(stages.scan_echogenicity, at->line, sample);
      const double r = bilinear(stages.scan_reflection, at->line, sample);
      stages.echogenicity.at(x, y) = e;
      stages.reflection.at(x, y) = r;
      const double s = settings.reflection_share;
      stages.grey.at(x, y) = std::uint8_t(std::lround(255 * (s * r + (1 - s) * e)));
    }
  return stages;
}

double lc2_reference(const Image<double>& ultrasound, const Image<std::uint8_t>& counts,
                     const Image<double>& echogenicity, const Image<double>& reflection, int patch) {
  const int side = patch > 0 ? patch : std::max({counts.width, counts.height, 1});
  double explained = 0, variance = 0;
  for (int y0 = 0; y0 < counts.height; y0 += side)
    for (int x0 = 0; x0 < counts.width; x0 += side) {
      std::vector<double> u, terms[2];
      for (int y = y0; y < std::min(y0 + side, counts.height); ++y)
        for (int x = x0; x < std::min(x0 + side, counts.width); ++x) {
          if (!counts.at(x, y)) continue;
          u.push_back(ultrasound.at(x, y));
          terms[0].push_back(echogenicity.at(x, y));
          terms[1].push_back(reflection.at(x, y));
        }
      const Explained of_patch = explained_by(u, {terms[0], terms[1]});
      explained += of_patch.explained;
      variance += of_patch.variance;
    }
  return variance > 0 ? explained / variance : 0;
}

}  // namespace insonate
