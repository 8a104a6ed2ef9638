#pragma once

#include <glm/vec2.hpp>

#include <string>
#include <vector>

#include "scenarios/action.h"

namespace insonate {

/// The geometry of what a caliper or an ellipse measures: of actions of those two kinds, in mm of the plane they lie
/// in.

/// Between the two ends; of an ellipse the axis that was drawn first.
double caliper_length_mm(const Action& placed);
double ellipse_area_mm2(const Action& ellipse);
/// By the formula pi / 6 times its three axes.
double ellipsoid_volume_ml(double first_mm, double second_mm, double third_mm);

/// Where it can be taken hold of: a caliper's two ends; of an ellipse also the ends of its other axis.
std::vector<glm::dvec2> handles(const Action& placed);
/// The same with one of its handles moved. An end of an ellipse's other axis stays on that axis.
Action with_handle_at(Action placed, std::size_t handle, const glm::dvec2& to);
/// Points of the outline of an ellipse, the last one followed by the first.
std::vector<glm::dvec2> outline(const Action& ellipse, std::size_t points);

/// As machines write them: "23.4 mm", from 100 mm on "12.34 cm"; "4.56 cm²"; "123 ml".
std::string length_text(double mm);
std::string area_text(double mm2);
std::string volume_text(double ml);
/// The length of a caliper, the area of an ellipse.
std::string value_text(const Action& placed);

}  // namespace insonate
