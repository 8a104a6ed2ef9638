#include "sim/tissue/transmission.h"

#include <algorithm>
#include <cmath>

#include "sim/tissue/coupling.h"

namespace insonate {
namespace {

constexpr int kMin_hu = -1024;
constexpr int kMax_hu = 3071;          // what a 12-bit scanner writes; denser metal counts as bone
constexpr double kAirBelow_hu = -500;  // half way between air and fat; gel fills what is below
constexpr double kSoftTissue_hu = 50;  // between fluid and muscle: an organ such as liver, without contrast agent

}  // namespace

VoxelLine voxel_line(const Grid& grid, const ScanLines& set, std::size_t line, const Pose& patient_from_probe) {
  const ScanLine& way = set.lines[line];
  const auto index = [&](double r) {
    return grid.index_from_patient(patient_from_probe.point(way.start + way.direction * r));
  };
  const glm::dvec3 start = index(set.r_min_mm);
  return {start, (index(set.r_max_mm) - start) / double(set.samples)};
}

std::vector<double> soft_tissue_intensity(const ScanLines& lines, const TissueTable& tissues, double frequency_mhz) {
  const double loss_db_mm = tissues.at(kSoftTissue_hu).absorption_db_cm_mhz * frequency_mhz / 10;
  std::vector<double> intensity;
  for (int k = 0; k < lines.samples; ++k)
    intensity.push_back(std::pow(10.0, -loss_db_mm * (k + 0.5) * lines.dr_mm() / 10));
  return intensity;
}

Transmission::Transmission(const Volume<std::int16_t>& ct, const TissueTable& tissues, double sample_distance_mm,
                           double frequency_mhz, const GelLayer& gel)
    : ct_(&ct), dr_mm_(sample_distance_mm), gel_(gel) {
  const double half_step_cm_mhz = dr_mm_ / 20 * frequency_mhz;
  medium_of_hu_.reserve(kMax_hu - kMin_hu + 1);
  for (int hu = kMin_hu; hu <= kMax_hu; ++hu) {
    const TissueKnot knot = tissues.at(hu);
    medium_of_hu_.push_back({knot.impedance_mrayl, std::pow(10.0, -knot.absorption_db_cm_mhz * half_step_cm_mhz / 10)});
  }
}

const Transmission::Medium& Transmission::medium(const glm::dvec3& index, double distance_mm) const {
  double hu = sample_trilinear(*ct_, index);
  if (distance_mm < gel_.thickness_mm) {
    if (gel_.gradual)
      hu *= 1 - std::clamp((kCouplingTissue_hu - hu) / (kCouplingTissue_hu - kCouplingAir_hu), 0.0, 1.0);
    else if (hu < kAirBelow_hu)
      hu = 0;
  }
  constexpr double kHalfBelow = kMin_hu - 0.5;  // truncation after subtracting it rounds to the nearest integer
  return medium_of_hu_[std::size_t(std::clamp(hu, double(kMin_hu), double(kMax_hu)) - kHalfBelow)];
}

void Transmission::along(const VoxelLine& line, std::span<double> intensity) const {
  double arriving = 1;
  Medium before = medium(line.start, 0);
  for (std::size_t k = 0; k < intensity.size(); ++k) {
    const Medium after = medium(line.at(double(k + 1)), double(k + 1) * dr_mm_);
    const double contrast =
        (after.impedance_mrayl - before.impedance_mrayl) / (after.impedance_mrayl + before.impedance_mrayl);
    const double leaving = arriving * (1 - contrast * contrast) * before.half_step * after.half_step;
    intensity[k] = (arriving + leaving) / 2;
    arriving = leaving;
    before = after;
  }
}

}  // namespace insonate
