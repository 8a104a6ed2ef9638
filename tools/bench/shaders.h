#pragma once

#include <string_view>

#include "sim/gl/program.h"

namespace insonate::bench {

/// Returns the text of a file of tools/bench/shaders, or an empty one for another name. The build generates the
/// definition (insonate_embed).
std::string_view embedded_shader(std::string_view name);

/// The benchmark's own shaders, and those of the simulator.
inline gl::ShaderSources shaders() {
  return gl::ShaderSources(embedded_shader);
}

}  // namespace insonate::bench
