#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace insonate::view {

/// The appearance of a structure in the views.
struct OrganColour {
  glm::vec3 colour{0.0f};  ///< sRGB, 0 to 1
  float opacity = 0.0f;    ///< opacity of 1 mm, 0 (not drawn) to 1
};

/// One entry per label value.
using OrganColours = std::array<OrganColour, 256>;

/// Returns the colour that anatomical atlases give a structure, found by the words of its name ("right_kidney_cortex",
/// "rib_left_7", "portal_vein_and_splenic_vein"). The result is not drawn if no word is known, or if the structure
/// would hide what matters (skin, fat, muscle).
OrganColour colour_of_organ(std::string_view name);

/// Returns the appearance of each label value.
/// @param names  the structure's name per label value; 256 or fewer
OrganColours colours_of_organs(const std::vector<std::string>& names);

}  // namespace insonate::view
