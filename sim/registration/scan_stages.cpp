#include "sim/registration/scan_stages.h"

#include <algorithm>
#include <string>
#include <utility>

namespace insonate::gl {
namespace {

Defines with(Defines constants, std::size_t abreast, int images_per_invocation) {
  constants.emplace_back("ABREAST", std::to_string(abreast));
  constants.emplace_back("IMAGES_IN_TURN", std::to_string(images_per_invocation));
  return constants;
}

}  // namespace

ScanStages::ScanStages(const ShaderSources& sources, const Defines& constants, std::size_t abreast, int in_turn,
                       std::size_t samples, std::size_t images)
    : interleaved_terms(std::max(int(abreast) / 2, 1)),
      images_per_invocation((in_turn + int(abreast) - 1) / int(abreast) * int(abreast)),
      compiled_in(with(constants, abreast, images_per_invocation)),
      traverse_grey(traverse_program(sources, compiled_in, Leaves::grey)),
      traverse_terms(traverse_program(sources, compiled_in, Leaves::terms)),
      picture(sources, {"registration/wein_picture.comp"}, compiled_in),
      parts(sources, {"registration/lc2_parts.comp"}, compiled_in),
      grey_scan(abreast > 1 ? GL_RGBA16 : GL_R16, samples * images / abreast),
      term_scan(abreast > 1 ? GL_RGBA16 : GL_RG16, samples * images / std::size_t(interleaved_terms)) {}

Program ScanStages::traverse_program(const ShaderSources& sources, Defines compiled_in, Leaves leaves) {
  compiled_in.emplace_back("GREY", leaves == Leaves::grey ? "1" : "0");
  if (leaves == Leaves::intensity) compiled_in.emplace_back("INTENSITY", "");
  return Program(sources, {"registration/wein_traverse.comp"}, std::move(compiled_in));
}

}  // namespace insonate::gl
