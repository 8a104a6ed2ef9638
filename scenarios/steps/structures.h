#pragma once

#include <bitset>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/core/pose.h"
#include "sim/volume/case.h"

namespace insonate {

/// Structures of a case's label map, taken together: an organ and its wall.
class StructureSet {
public:
  /// Names that the case does not have are passed over. Keeps a reference to the case.
  StructureSet(const Case& subject, const std::vector<std::string>& names);

  bool holds(const glm::dvec3& patient_mm) const {
    return values_[sample_nearest(subject_.labels, subject_.labels.grid.index_from_patient(patient_mm))];
  }
  bool holds(std::uint8_t value) const { return values_[value]; }
  bool any_voxel() const;
  double volume_mm3() const;
  /// From a point to the nearest voxel's centre; 0 inside; empty when there is none.
  std::optional<double> distance_mm(const glm::dvec3& patient_mm) const;

private:
  const Case& subject_;
  std::bitset<256> values_;
};

/// Adds a problem for each name that the case has no label for, or for the case when it has none at all.
void check_structures(const std::vector<std::string>& names, const SourcePlace& place, const Case& subject,
                      const std::string& where, std::vector<ScenarioProblem>& problems);

}  // namespace insonate
