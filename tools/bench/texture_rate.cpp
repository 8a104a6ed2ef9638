#include "tools/bench/texture_rate.h"

#include <string>

#include "sim/wein/density_volume.h"
#include "tools/bench/shaders.h"

namespace insonate::gl {
namespace {

constexpr std::size_t kFetches = 64;  // per invocation, about as many as for a line

std::size_t invocations(std::size_t fetches) {
  return (fetches + kFetches - 1) / kFetches;
}

}  // namespace

TextureRate::TextureRate(const AcousticVolume& volume, double reflection_length_mm, std::size_t fetches,
                         const WorkDivision& division)
    : density_(density_volume(volume, reflection_length_mm)),
      program_(bench::shaders(), {"texture_rate.comp"},
               {{"GROUP", std::to_string(division.group)}, {"FETCHES", std::to_string(kFetches)}}),
      sums_(invocations(fetches) * sizeof(float), nullptr),
      groups_(
          division.in_rows((invocations(fetches) + std::size_t(division.group) - 1) / std::size_t(division.group))) {}

void TextureRate::run() const {
  density_.bind(0);
  sums_.bind_storage(0);
  program_.dispatch_groups(groups_.x, groups_.y);
}

}  // namespace insonate::gl
