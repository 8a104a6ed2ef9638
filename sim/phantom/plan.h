#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "sim/phantom/recipe.h"
#include "sim/phantom/shapes.h"
#include "sim/volume/case.h"

namespace insonate {

/// What a label looks like in CT.
struct PaintedLabel {
  Label label;
  float hu = 0;
  float texture_hu = 0;  ///< standard deviation of the texture
  float grain_mm = 2;    ///< its coarseness
};

struct PaintedShape {
  ShapePtr shape;
  std::size_t label = 0;  ///< into PhantomPlan::labels
};

/// A reference view before the skin is known.
struct PlannedView {
  ReferenceView view;        ///< without its pose
  glm::dvec3 aim{0.0};       ///< what the central beam goes through
  glm::dvec3 beam{0, 1, 0};  ///< the beam's direction, into the body; unit
  glm::dvec3 marker{0.0};    ///< lateral direction of the marker; unit, square to the beam
  double press_mm = 8;       ///< how deep under the skin the face's middle lies
};

/// A recipe read and checked: everything that is needed to make the case.
struct PhantomPlan {
  std::string name;
  std::uint32_t seed = 0;
  Grid grid;
  std::vector<PaintedLabel> labels;
  std::vector<PaintedShape> shapes;  ///< a later one displaces the earlier ones where it lies
  std::vector<Landmark> landmarks;
  std::vector<PlannedView> views;
};

/// Throws InputError for anything in the recipe that is missing, misspelt, doubled or out of range.
PhantomPlan plan_phantom(const Recipe& recipe);

}  // namespace insonate
