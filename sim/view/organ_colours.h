#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace insonate::view {

/// How a structure looks in the views.
struct OrganColour {
  glm::vec3 colour{0.0f};  ///< sRGB, 0 to 1
  float opacity = 0.0f;    ///< of 1 mm of it, 0 (not drawn) to 1
};

/// Per label value.
using OrganColours = std::array<OrganColour, 256>;

/// The colour that anatomical atlases give the structure, found by the words of its name ("right_kidney_cortex",
/// "rib_left_7", "portal_vein_and_splenic_vein"); not drawn when no word is known, or when it would hide what matters
/// (skin, fat, muscle).
OrganColour colour_of_organ(std::string_view name);

/// @param names  per label value, the structure's name; 256 or fewer
OrganColours colours_of_organs(const std::vector<std::string>& names);

}  // namespace insonate::view
