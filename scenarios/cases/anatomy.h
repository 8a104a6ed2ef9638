#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/cases/structure_shape.h"

namespace insonate {

/// A position along a vessel.
struct VesselLevel {
  std::string landmark;   ///< "aorta_l2"
  std::string name;       ///< "l2"
  std::string title;      ///< "at L2"
  glm::dvec3 point{0.0};  ///< centre of its cross-section there
  glm::dvec3 along{0.0};  ///< its direction there, unit, towards the head
};

/// A vessel's course through the abdomen.
struct Vessel {
  const StructureShape* shape;
  std::vector<VesselLevel> levels;  ///< from bottom to top
};

/// Two organs and the recess between them, in which fluid gathers.
struct Recess {
  std::string name;  ///< "hepatorenal"
  const StructureShape* organ;
  const StructureShape* kidney;
  glm::dvec3 point{0.0};
};

/// The parts of a patient's anatomy that landmarks and views are made from; see import_case(). Points into `shapes`.
struct Anatomy {
  std::vector<const StructureShape*> organs;
  std::vector<Vessel> vessels;
  std::vector<Recess> recesses;
};

/// Finds the organs, vessels and recesses of a case. Omits structures that are missing or smaller than 1000 voxels.
Anatomy find_anatomy(const Case& subject, const std::vector<StructureShape>& shapes);

/// Returns the landmarks of an anatomy, named as import_case() documents.
std::vector<Landmark> landmarks_of(const Anatomy& anatomy);

/// Return the names that landmarks_of() gives to the ends of an organ's long axis: at first_pole and at second_pole.
std::string first_pole_name(const StructureShape& organ);
std::string second_pole_name(const StructureShape& organ);

}  // namespace insonate
