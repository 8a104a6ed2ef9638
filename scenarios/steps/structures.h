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

/// The number of voxels of some labels in a label map, and their bounding box.
struct LabelExtent {
  std::uint64_t voxels = 0;
  glm::ivec3 first{0}, last{-1};  ///< inclusive corners of the bounding box; meaningless without voxels

  void include(const LabelExtent& other);
};

/// The extent of each label in a case's label map. The map is read once, when an exam begins: reading all of a
/// hospital's CT takes longer than a picture may stand still.
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

/// A set of structures of a case's label map, treated as one: for example an organ and its wall.
class StructureSet {
public:
  /// Ignores names that the case does not have. Keeps a reference to the case.
  StructureSet(const LabelIndex& labels, const std::vector<std::string>& names);

  bool holds(const glm::dvec3& patient_mm) const {
    return values_[sample_nearest(subject_.labels, subject_.labels.grid.index_from_patient(patient_mm))];
  }
  bool holds(std::uint8_t value) const { return values_[value]; }
  bool any_voxel() const { return extent_.voxels > 0; }
  /// Returns their voxel count and bounding box.
  const LabelExtent& extent() const { return extent_; }
  double volume_mm3() const;
  /// Returns the corners of the box around all voxels, including the voxels' outer edges (patient, mm). They are
  /// meaningless without voxels.
  std::array<glm::dvec3, 8> corners() const;

private:
  const Case& subject_;
  std::bitset<256> values_;
  LabelExtent extent_;
};

/// The surface voxels of structures, listed once. For a point outside, the nearest voxel is always a surface voxel.
class StructureSurface {
public:
  /// Keeps a reference to the case, as StructureSet does.
  StructureSurface(const LabelIndex& labels, const std::vector<std::string>& names);

  /// Returns the distance from a point to the centre of the nearest voxel; 0 inside the structures. Returns nothing if
  /// there are no voxels.
  std::optional<double> distance_mm(const glm::dvec3& patient_mm) const;

private:
  const Grid& grid_;
  StructureSet structures_;
  std::vector<glm::ivec3> voxels_;
};

/// Adds a problem for each name without a label in the case, or one problem if the case has no labels at all.
void check_structures(const std::vector<std::string>& names, const SourcePlace& place, const Case& subject,
                      const std::string& where, std::vector<Mistake>& problems);

}  // namespace insonate
