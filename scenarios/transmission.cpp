#include "scenarios/transmission.h"

#include <algorithm>
#include <cmath>

namespace insonate {
namespace {

constexpr int kLeastHu = -1024;
constexpr int kMostHu = 3071;         // what a 12-bit scanner writes; metal beyond it is as good as bone
constexpr double kAirBelowHu = -500;  // half way between air and fat: gel fills what is below

}  // namespace

Transmission::Transmission(const Volume<std::int16_t>& ct, const TissueTable& tissues, const ScanLines& lines,
                           double frequency_mhz)
    : ct_(&ct), lines_(lines) {
  const double half_step_cm_mhz = lines.dr_mm() / 20 * frequency_mhz;
  medium_of_hu_.reserve(kMostHu - kLeastHu + 1);
  for (int hu = kLeastHu; hu <= kMostHu; ++hu) {
    const TissueKnot knot = tissues.at(hu);
    medium_of_hu_.push_back({knot.impedance_mrayl, std::pow(10.0, -knot.absorption_db_cm_mhz * half_step_cm_mhz / 10)});
  }
}

const Transmission::Medium& Transmission::medium(const glm::dvec3& index, double distance_mm) const {
  double hu = sample_trilinear(*ct_, index);
  if (distance_mm < kGel_mm && hu < kAirBelowHu) hu = 0;
  const int nearest = int(std::clamp(hu, double(kLeastHu), double(kMostHu)) - kLeastHu + 0.5);
  return medium_of_hu_[std::size_t(nearest)];
}

void Transmission::along(std::size_t line, const Pose& patient_from_probe, std::vector<double>& intensity) const {
  const ScanLine& way = lines_.lines[line];
  // The map from the patient to voxels is affine, so a line in the patient is a line through the voxels.
  const Grid& grid = ct_->grid;
  const glm::dvec3 first =
      grid.index_from_patient(patient_from_probe.point(way.start + way.direction * lines_.r_min_mm));
  const glm::dvec3 last =
      grid.index_from_patient(patient_from_probe.point(way.start + way.direction * lines_.r_max_mm));
  const glm::dvec3 step = (last - first) / double(lines_.samples);

  double arriving = 1;
  Medium before = medium(first, 0);
  for (int k = 0; k < lines_.samples; ++k) {
    const Medium after = medium(first + step * double(k + 1), (k + 1) * lines_.dr_mm());
    const double contrast =
        (after.impedance_mrayl - before.impedance_mrayl) / (after.impedance_mrayl + before.impedance_mrayl);
    const double leaving = arriving * (1 - contrast * contrast) * before.half_step * after.half_step;
    intensity[std::size_t(k)] = (arriving + leaving) / 2;
    arriving = leaving;
    before = after;
  }
}

}  // namespace insonate
