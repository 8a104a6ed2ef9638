#include "scenarios/steps/structures.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/core/suggest.h"
#include "sim/core/text.h"

namespace insonate {

void LabelExtent::include(const LabelExtent& other) {
  if (other.voxels == 0) return;
  first = voxels == 0 ? other.first : glm::min(first, other.first);
  last = voxels == 0 ? other.last : glm::max(last, other.last);
  voxels += other.voxels;
}

LabelIndex::LabelIndex(const Case& subject) : subject_(subject) {
  if (subject.labels.empty()) return;
  const glm::ivec3 size = subject.labels.grid.size;
  const std::uint8_t* row = subject.labels.voxels.data();
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j, row += size.x)
      for (int i = 0; i < size.x;) {
        const int begin = i;
        while (i < size.x && row[i] == row[begin]) ++i;
        extents_[row[begin]].include({std::uint64_t(i - begin), {begin, j, k}, {i - 1, j, k}});
      }
}

StructureSet::StructureSet(const LabelIndex& labels, const std::vector<std::string>& names)
    : subject_(labels.subject()) {
  for (const std::string& name : names) {
    const Label* label = subject_.find_label(name);
    if (!label || values_[label->value]) continue;
    values_.set(label->value);
    extent_.include(labels.of(label->value));
  }
}

double StructureSet::volume_mm3() const {
  const glm::dvec3& spacing = subject_.labels.grid.spacing;
  return double(extent_.voxels) * spacing.x * spacing.y * spacing.z;
}

std::array<glm::dvec3, 8> StructureSet::corners() const {
  std::array<glm::dvec3, 8> corners;
  for (int c = 0; c < 8; ++c) {
    glm::dvec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = c >> axis & 1 ? extent_.last[axis] + 0.5 : extent_.first[axis] - 0.5;
    corners[std::size_t(c)] = subject_.labels.grid.patient_from_index(index);
  }
  return corners;
}

StructureSurface::StructureSurface(const LabelIndex& labels, const std::vector<std::string>& names)
    : grid_(labels.subject().labels.grid), structures_(labels, names) {
  if (!structures_.any_voxel()) return;
  const Volume<std::uint8_t>& map = labels.subject().labels;
  const glm::ivec3 first = structures_.extent().first, last = structures_.extent().last;
  const auto inside = [&](int i, int j, int k) { return structures_.holds(map.at({i, j, k})); };
  for (int k = first.z; k <= last.z; ++k)
    for (int j = first.y; j <= last.y; ++j)
      for (int i = first.x; i <= last.x; ++i) {
        if (!inside(i, j, k)) continue;
        // Outside the bounding box there are no voxels of the structures.
        const bool enclosed = i > first.x && i < last.x && j > first.y && j < last.y && k > first.z && k < last.z &&
                              inside(i - 1, j, k) && inside(i + 1, j, k) && inside(i, j - 1, k) &&
                              inside(i, j + 1, k) && inside(i, j, k - 1) && inside(i, j, k + 1);
        if (!enclosed) voxels_.push_back({i, j, k});
      }
}

std::optional<double> StructureSurface::distance_mm(const glm::dvec3& patient_mm) const {
  if (structures_.holds(patient_mm)) return 0.0;
  if (voxels_.empty()) return std::nullopt;
  const glm::dvec3 at = grid_.index_from_patient(patient_mm);
  double nearest = std::numeric_limits<double>::infinity();
  for (const glm::ivec3& voxel : voxels_) {
    const glm::dvec3 way = (glm::dvec3(voxel) - at) * grid_.spacing;
    nearest = std::min(nearest, glm::dot(way, way));
  }
  return std::sqrt(nearest);
}

void check_structures(const std::vector<std::string>& names, const SourcePlace& place, const Case& subject,
                      const std::string& where, std::vector<Mistake>& problems) {
  if (!names.empty() && subject.labels.empty())
    problems.push_back({place, where + " names structures, but the case '" + subject.name + "' has no labels",
                        "take a case with labels"});
  const std::vector<std::string> known = names_of(subject.label_table);
  for (const std::string& name : names)
    if (!subject.find_label(name))
      problems.push_back(
          {place, where + " names the structure '" + name + "', which the case '" + subject.name + "' does not have",
           known.empty() ? "take a case with labels" : suggest(name, known)});
}

}  // namespace insonate
