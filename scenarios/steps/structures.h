#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/core/pose.h"
#include "sim/volume/case.h"

namespace insonate {

/// How many voxels of some labels a label map has, and where.
struct LabelExtent {
  std::uint64_t voxels = 0;
  glm::ivec3 first{0}, last{-1};  ///< the corners of the box around them; meaningless without voxels

  void include(const LabelExtent& other);
};

/// Where each label of a case's label map lies. The map is read once, when an exam begins: reading all of a hospital's
/// CT takes longer than a picture may stand still.
class LabelIndex {
public:
  /// Keeps a reference to the case.
  explicit LabelIndex(const Case& subject);
  const Case& subject() const { return subject_; }
  const LabelExtent& of(std::uint8_t value) const { return extents_[value]; }

private:
  const Case& subject_;
  std::array<LabelExtent, 256> extents_;
};

/// Structures of a case's label map, taken together: an organ and its wall.
class StructureSet {
public:
  /// Names that the case does not have are passed over. Keeps a reference to the case.
  StructureSet(const LabelIndex& labels, const std::vector<std::string>& names);

  bool holds(const glm::dvec3& patient_mm) const {
    return values_[sample_nearest(subject_.labels, subject_.labels.grid.index_from_patient(patient_mm))];
  }
  bool holds(std::uint8_t value) const { return values_[value]; }
  bool any_voxel() const { return extent_.voxels > 0; }
  /// The box that they lie in.
  const LabelExtent& extent() const { return extent_; }
  double volume_mm3() const;
  /// The corners of the box around all voxels, edges and all (patient, mm); meaningless without any.
  std::array<glm::dvec3, 8> corners() const;

private:
  const Case& subject_;
  std::bitset<256> values_;
  LabelExtent extent_;
};

/// The voxels at the surface of structures, listed once: whoever is outside has none that is nearer.
class StructureSurface {
public:
  /// Keeps a reference to the case, as StructureSet does.
  StructureSurface(const LabelIndex& labels, const std::vector<std::string>& names);

  /// From a point to the nearest voxel's centre; 0 inside; empty when there is none.
  std::optional<double> distance_mm(const glm::dvec3& patient_mm) const;

private:
  const Grid& grid_;
  StructureSet structures_;
  std::vector<glm::ivec3> voxels_;
};

/// Adds a problem for each name that the case has no label for, or for the case when it has none at all.
void check_structures(const std::vector<std::string>& names, const SourcePlace& place, const Case& subject,
                      const std::string& where, std::vector<ScenarioProblem>& problems);

}  // namespace insonate
