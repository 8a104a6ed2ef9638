#pragma once

#include <string_view>

namespace insonate::gl {

/// Returns the text of a file of sim/shaders as it was at build time; an empty one for another name. The build
/// generates the definition (insonate_embed).
std::string_view embedded_shader(std::string_view name);

}  // namespace insonate::gl
