#pragma once

#include <glm/vec2.hpp>

#include <string>
#include <vector>

#include "scenarios/action.h"

namespace insonate {

/// The geometry of calipers and ellipses. The arguments are actions of those two kinds; coordinates are mm in the plane
/// of the picture.

/// Returns a caliper's length between its two ends, or the length of the ellipse axis that was drawn first.
double caliper_length_mm(const Action& placed);
double ellipse_area_mm2(const Action& ellipse);
/// Returns pi / 6 times the product of the three axes.
double ellipsoid_volume_ml(double first_mm, double second_mm, double third_mm);

/// Returns the points that the learner can drag: the two ends, and for an ellipse also the ends of its other axis.
std::vector<glm::dvec2> handles(const Action& placed);
/// Returns `placed` with one handle moved to `to`. An end of an ellipse's other axis stays on that axis.
Action with_handle_at(Action placed, std::size_t handle, const glm::dvec2& to);
/// Returns points on the outline of an ellipse. The outline closes from the last point to the first.
std::vector<glm::dvec2> outline(const Action& ellipse, std::size_t points);

/// Return values as ultrasound machines display them: "23.4 mm", from 100 mm on "12.34 cm"; "4.56 cm²"; "123 ml".
std::string length_text(double mm);
std::string area_text(double mm2);
std::string volume_text(double ml);
/// Returns the length of a caliper or the area of an ellipse as text.
std::string value_text(const Action& placed);

}  // namespace insonate
