#pragma once

#include <string_view>

namespace insonate::gl {

/// Returns the text of a file of sim/shaders as it was at build time, or an empty text for an unknown name. The build
/// generates the definition (insonate_embed).
/// @param name  relative to sim/shaders, such as "imaging/beam.comp"
std::string_view embedded_shader(std::string_view name);

}  // namespace insonate::gl
