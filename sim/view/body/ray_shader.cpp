#include "sim/view/body/ray_shader.h"

#include "sim/gl/headless_context.h"

namespace insonate::view {

RayShader ray_shader_of_device() {
  return gl::is_software_renderer() ? RayShader::fragment : RayShader::compute;
}

}  // namespace insonate::view
