#include "sim/gl/scan_stages.h"

#include <algorithm>
#include <string>
#include <utility>

namespace insonate::gl {
namespace {

Defines with(Defines constants, std::size_t abreast, int images_in_turn) {
  constants.emplace_back("ABREAST", std::to_string(abreast));
  constants.emplace_back("IMAGES_IN_TURN", std::to_string(images_in_turn));
  return constants;
}

}  // namespace

ScanStages::ScanStages(const ShaderSources& sources, const Defines& constants, std::size_t abreast, int in_turn,
                       std::size_t samples, std::size_t images)
    : terms_abreast(std::max(int(abreast) / 2, 1)),
      images_in_turn((in_turn + int(abreast) - 1) / int(abreast) * int(abreast)),
      compiled_in(with(constants, abreast, images_in_turn)),
      traverse_grey(traverse_program(sources, compiled_in, Leaves::grey)),
      traverse_terms(traverse_program(sources, compiled_in, Leaves::terms)),
      picture(sources, {"wein_picture.comp"}, compiled_in),
      parts(sources, {"lc2_parts.comp"}, compiled_in),
      grey_scan(abreast > 1 ? GL_RGBA16 : GL_R16, samples * images / abreast),
      term_scan(abreast > 1 ? GL_RGBA16 : GL_RG16, samples * images / std::size_t(terms_abreast)) {}

Program ScanStages::traverse_program(const ShaderSources& sources, Defines compiled_in, Leaves leaves) {
  compiled_in.emplace_back("GREY", leaves == Leaves::grey ? "1" : "0");
  if (leaves == Leaves::intensity) compiled_in.emplace_back("INTENSITY", "");
  return Program(sources, {"wein_traverse.comp"}, std::move(compiled_in));
}

}  // namespace insonate::gl
