#include "scenarios/steps/structures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

#include "sim/core/suggest.h"

namespace insonate {

StructureSet::StructureSet(const Case& subject, const std::vector<std::string>& names) : subject_(subject) {
  for (const std::string& name : names)
    if (const Label* label = subject.find_label(name)) values_.set(label->value);
}

bool StructureSet::any_voxel() const {
  return std::any_of(subject_.labels.voxels.begin(), subject_.labels.voxels.end(),
                     [&](std::uint8_t value) { return values_[value]; });
}

double StructureSet::volume_mm3() const {
  const auto count = std::count_if(subject_.labels.voxels.begin(), subject_.labels.voxels.end(),
                                   [&](std::uint8_t value) { return values_[value]; });
  const glm::dvec3& spacing = subject_.labels.grid.spacing;
  return double(count) * spacing.x * spacing.y * spacing.z;
}

std::optional<double> StructureSet::distance_mm(const glm::dvec3& patient_mm) const {
  if (holds(patient_mm)) return 0.0;
  const Grid& grid = subject_.labels.grid;
  const glm::dvec3 at = grid.index_from_patient(patient_mm);
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i)
        if (values_[subject_.labels.at({i, j, k})]) {
          const glm::dvec3 way = (glm::dvec3(i, j, k) - at) * grid.spacing;
          nearest = std::min(nearest, glm::dot(way, way));
        }
  if (nearest == std::numeric_limits<double>::infinity()) return std::nullopt;
  return std::sqrt(nearest);
}

void check_structures(const std::vector<std::string>& names, const SourcePlace& place, const Case& subject,
                      const std::string& where, std::vector<ScenarioProblem>& problems) {
  if (!names.empty() && subject.labels.empty())
    problems.push_back({place, where + " names structures, but the case '" + subject.name + "' has no labels",
                        "take a case with labels"});
  std::vector<std::string> known;
  for (const Label& label : subject.label_table) known.push_back(label.name);
  for (const std::string& name : names)
    if (!subject.find_label(name))
      problems.push_back(
          {place, where + " names the structure '" + name + "', which the case '" + subject.name + "' does not have",
           known.empty() ? "take a case with labels" : suggest(name, known)});
}

}  // namespace insonate
