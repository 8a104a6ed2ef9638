#include "sim/wein/scan_stages.h"

#include <algorithm>
#include <string>
#include <utility>

namespace insonate::gl {
namespace {

Defines with(Defines constants, std::size_t interleaved, int images_per_invocation) {
  constants.emplace_back("INTERLEAVED", std::to_string(interleaved));
  constants.emplace_back("IMAGES_PER_INVOCATION", std::to_string(images_per_invocation));
  return constants;
}

}  // namespace

ScanStages::ScanStages(const ShaderSources& sources, const Defines& constants, std::size_t interleaved,
                       int wanted_per_invocation, std::size_t samples, std::size_t images)
    : interleaved_terms(std::max(int(interleaved) / 2, 1)),
      images_per_invocation((wanted_per_invocation + int(interleaved) - 1) / int(interleaved) * int(interleaved)),
      compiled_in(with(constants, interleaved, images_per_invocation)),
      traverse_grey(traverse_program(sources, compiled_in, Leaves::grey)),
      traverse_terms(traverse_program(sources, compiled_in, Leaves::terms)),
      picture(sources, {"wein/wein_picture.comp"}, compiled_in),
      parts(sources, {"wein/lc2_parts.comp"}, compiled_in),
      grey_scan(interleaved > 1 ? GL_RGBA16 : GL_R16, samples * images / interleaved),
      term_scan(interleaved > 1 ? GL_RGBA16 : GL_RG16, samples * images / std::size_t(interleaved_terms)) {}

Program ScanStages::traverse_program(const ShaderSources& sources, Defines compiled_in, Leaves leaves) {
  compiled_in.emplace_back("GREY", leaves == Leaves::grey ? "1" : "0");
  if (leaves == Leaves::intensity) compiled_in.emplace_back("INTENSITY", "");
  return Program(sources, {"wein/wein_traverse.comp"}, std::move(compiled_in));
}

}  // namespace insonate::gl
