#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

#include "sim/phantom/shapes.h"

namespace insonate {

/// How the vessels of an organ branch from given stems to tips all over the organ.
///
/// The tips are added one by one: each lies where the organ is emptiest, and joins the vessel that reaches it on the
/// shortest way with the smallest bend (constrained constructive optimisation without its search for the least volume:
/// Schreiner and Buxbaum, IEEE Trans Biomed Eng 40, 1993). A vessel that feeds n tips has the radius
/// tip_radius_mm n^(1/3), by Murray's law (Proc Natl Acad Sci 12, 1926).
struct TreeRule {
  std::vector<Strand> stems;       ///< centre lines; the first one begins at the root, each other one on an earlier one
  ShapePtr within;                 ///< branches stay inside this shape, which has finite bounds
  std::vector<ShapePtr> clear_of;  ///< branches keep the gap from these
  float gap_mm = 1;                ///< also kept from the surface of `within`
  int tips = 50;                   ///< number of branches; fewer if the organ has no room for more
  float tip_radius_mm = 1;
  std::uint32_t seed = 0;
};

/// Returns the centre lines of the stems and of all branches. A stem's radius is the given one or, where the tips that
/// it feeds need more, the one by Murray's law. The same rule gives the same tree.
std::vector<Strand> grow_tree(const TreeRule& rule);

/// A vessel that runs beside another one, as bile ducts and arteries do beside the branches of the portal vein.
struct CompanionRule {
  float share = 0.4f;            ///< its radius as a share of the other's, 0.05 to 2
  float least_radius_mm = 0.6f;  ///< it ends where it would be thinner
  float most_radius_mm = 100;    ///< it is never thicker
  float gap_mm = 0.5f;           ///< between the two surfaces
  glm::vec3 towards{0, -1, 0};   ///< the side on which it runs
};

/// Returns the companions of strands.
std::vector<Strand> companions(const std::vector<Strand>& strands, const CompanionRule& rule);

/// Tapered tubes from an inner to an outer ellipsoid, spread evenly over all directions, as the pyramids of a kidney
/// are.
struct SpokesForm {
  glm::vec3 centre{0.0f};
  glm::vec3 inner{1.0f}, outer{2.0f};  ///< half axes of the ellipsoids on which the tubes begin and end, mm
  int count = 10;                      ///< 1 to 200
  float inner_mm = 1, outer_mm = 3;    ///< radii of the tubes' ends
  float vary = 0;                      ///< the outer radii vary down to 1 - vary of that, 0 to 0.8
  glm::vec3 opening{0.0f};             ///< no spoke points to within opening_deg of this direction
  float opening_deg = 0;               ///< 0 to 150
  std::uint32_t seed = 0;              ///< the same seed, count and opening give the same directions
};

/// Returns the centre lines of the spokes, two points each.
std::vector<Strand> spokes(const SpokesForm& form);

}  // namespace insonate
