#include "tools/render/stage_tissue.h"

#include <glm/geometric.hpp>

#include <cmath>

#include "sim/reference/reference.h"

namespace insonate {

Tissue tissue_along(const ScanLines& lines, const RenderedScene& scene, const SlicePlane& plane) {
  const MediumField field = trilinear_field(scene.volume);
  const double l = scene.settings.reflection_length_mm, coupled = coupling_depth_mm(scene.settings);
  const int n = int(lines.lines.size()), d = lines.samples;
  const Image<float> empty(n, d);
  Tissue tissue{empty, empty, empty, empty, empty, empty};

  for (int line = 0; line < n; ++line) {
    const SlicePlane::Place& of_slice = plane.of_line(std::size_t(line));
    const ScanLine in_probe = line_beside(lines, std::size_t(line), of_slice.lateral);
    const glm::dvec3 start = scene.patient_from_probe.point(in_probe.start);
    const glm::dvec3 along = scene.patient_from_probe.direction(in_probe.direction);
    const glm::dvec3 lateral = scene.patient_from_probe.direction({in_probe.direction.y, -in_probe.direction.x, 0});
    const glm::dvec3 elevation = glm::cross(along, lateral);
    const glm::dvec3 out_of_plane = scene.patient_from_probe.direction({0, 0, 1});
    const double offset = of_slice.offset;
    const auto place = [&](double r) {
      return start + r * along + offset * slice_thickness_at_mm(scene.settings, r) * out_of_plane;
    };
    for (int k = 0; k < d; ++k) {
      const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm();
      const glm::dvec3 p = place(r);
      const auto hu = [&](const glm::dvec3& at, double depth) { return with_gel(field(at), depth, coupled).hu; };
      const Medium here = with_gel(field(p), r, coupled);
      const TissueKnot met = scene.table.at(here.hu);
      tissue.hounsfield.at(line, k) = float(here.hu);
      tissue.echogenicity.at(line, k) = float(here.echogenicity_db);
      tissue.impedance.at(line, k) = float(met.impedance_mrayl);
      tissue.absorption.at(line, k) = float(met.absorption_db_cm_mhz + end_absorption(here.echogenicity_db));

      const double hu_before = hu(place(r - l / 2), r - l / 2), hu_behind = hu(place(r + l / 2), r + l / 2);
      const double before = scene.table.at(hu_before).impedance_mrayl;
      const double behind = scene.table.at(hu_behind).impedance_mrayl;
      const double contrast = (behind - before) / (behind + before);
      const glm::dvec3 rise(hu_behind - hu_before, hu(p + l / 2 * lateral, r) - hu(p - l / 2 * lateral, r),
                            hu(p + l / 2 * elevation, r) - hu(p - l / 2 * elevation, r));
      const double steepness = glm::length(rise);
      tissue.alpha.at(line, k) = float(contrast * contrast);
      tissue.incidence.at(line, k) = float(steepness > 0 ? std::abs(rise.x) / steepness : 0);
    }
  }
  return tissue;
}

}  // namespace insonate
