#include "sim/gl/work_division.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "sim/gl/headless_context.h"

namespace insonate::gl {
namespace {

constexpr GLenum kSubgroupSize = 0x9532;  // GL_SUBGROUP_SIZE_KHR, younger than some headers

constexpr int kImagesPerInvocation = 8;  // twice as many would save the time of one image in a hundred

constexpr std::size_t kLinesThatFill = 8192;  // 8 vectors of 32 on 32 processors, estimated as the header describes

}  // namespace

WorkDivision WorkDivision::of_device() {
  WorkDivision division;
  const bool software = is_software_renderer();
  GLint lanes = software ? 8 : 32;
  if (epoxy_has_gl_extension("GL_KHR_shader_subgroup")) glGetIntegerv(kSubgroupSize, &lanes);
  division.group = std::clamp(lanes, 4, 128);
  if (software)
    division.images_per_invocation = kImagesPerInvocation;
  else
    division.lines_that_fill = kLinesThatFill;
  return division;
}

glm::ivec2 WorkDivision::in_rows(std::size_t groups) const {
  const std::size_t count = std::max<std::size_t>(groups, 1), most = std::size_t(most_groups);
  const std::size_t rows = (count + most - 1) / most;
  return {int((count + rows - 1) / rows), int(rows)};
}

}  // namespace insonate::gl
