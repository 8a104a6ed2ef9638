#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/phantom/recipe.h"
#include "sim/phantom/septa.h"
#include "sim/phantom/shapes.h"
#include "sim/volume/case.h"

namespace insonate {

/// A label with its appearance in CT.
struct PaintedLabel {
  Label label;
  float hu = 0;
  float texture_hu = 0;  ///< standard deviation of the texture; 0 for none
  float grain_mm = 2;    ///< coarseness of the texture
};

/// A shape with its label.
struct PaintedShape {
  ShapePtr shape;
  std::size_t label = 0;               ///< index into PhantomPlan::labels
  std::shared_ptr<const Septa> septa;  ///< takes the place of the label's texture; may be empty
};

/// A reference view before the position of the skin is known.
struct PlannedView {
  ReferenceView view;        ///< without its pose
  glm::dvec3 aim{0.0};       ///< patient point on the central beam, mm
  glm::dvec3 beam{0, 1, 0};  ///< direction of the beam into the body; unit
  glm::dvec3 marker{0.0};    ///< lateral direction of the marker; unit, perpendicular to the beam
  double press_mm = 8;       ///< depth of the face's middle under the skin
};

/// A recipe after reading and checking: all that is needed to make the case.
struct PhantomPlan {
  std::string name;
  std::uint32_t seed = 0;
  Grid grid;
  std::vector<PaintedLabel> labels;
  std::vector<PaintedShape> shapes;  ///< a later shape displaces earlier ones where they overlap
  std::vector<Landmark> landmarks;
  std::vector<PlannedView> views;
};

/// Returns the plan of a recipe. Throws InputError for anything in the recipe that is missing, misspelt, doubled or out
/// of range.
PhantomPlan plan_phantom(const Recipe& recipe);

}  // namespace insonate
