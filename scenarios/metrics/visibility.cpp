#include "scenarios/metrics/visibility.h"

#include <algorithm>
#include <cmath>

#include "scenarios/metrics/view_meter.h"

namespace insonate {
namespace {

Probe coarse(Probe probe) {
  probe.lines = Visibility::kLines;
  return probe;
}

}  // namespace

Visibility::Visibility(const Case& subject, const Probe& probe, double depth_mm, const TissueTable& tissues)
    : case_(&subject),
      probe_(coarse(probe)),
      depth_mm_(depth_mm),
      lines_(scan_lines(probe_, depth_mm, int(std::ceil(depth_mm / kSampleDistance_mm)))),
      transmission_(subject.ct, tissues, lines_.dr_mm(), probe_.frequency_mhz),
      soft_tissue_(soft_tissue_intensity(lines_, tissues, probe_.frequency_mhz)),
      looked_(lines_.lines.size()) {
  for (Line& line : looked_) line.intensity.resize(std::size_t(lines_.samples));
}

void Visibility::look_from(const Pose& patient_from_probe) {
  patient_from_probe_ = patient_from_probe;
  probe_from_patient_ = patient_from_probe.inverse();
  for (Line& line : looked_) line.traversed = false;
}

bool Visibility::reaches(const glm::dvec3& patient_mm) {
  const glm::dvec3 p = probe_from_patient_.point(patient_mm);
  if (std::abs(p.z) > kHalfSlice_mm) return false;
  const auto place = line_position(probe_, depth_mm_, glm::dvec2(p));
  if (!place) return false;
  const auto line = std::size_t(std::clamp(int(std::lround(place->line)), 0, kLines - 1));
  Line& looked = looked_[line];
  if (!looked.traversed) {
    transmission_.along(voxel_line(case_->ct.grid, lines_, line, patient_from_probe_), looked.intensity);
    looked.traversed = true;
  }
  const auto k = std::size_t(std::clamp(int(place->r_mm / lines_.dr_mm()), 0, lines_.samples - 1));
  return looked.intensity[k] >= kArrives * soft_tissue_[k];
}

}  // namespace insonate
