#include "sim/gl/texture_rate.h"

#include <string>

#include "sim/gl/density_volume.h"

namespace insonate::gl {
namespace {

constexpr std::size_t kFetches = 64;  // of an invocation, about as a line makes

std::size_t invocations(std::size_t fetches) {
  return (fetches + kFetches - 1) / kFetches;
}

}  // namespace

TextureRate::TextureRate(const AcousticVolume& volume, double reflection_length_mm, std::size_t fetches,
                         const Scheme& scheme)
    : density_(density_volume(volume, reflection_length_mm)),
      program_(ShaderSources(), {"texture_rate.comp"},
               {{"GROUP", std::to_string(scheme.group)}, {"FETCHES", std::to_string(kFetches)}}),
      sums_(invocations(fetches) * sizeof(float), nullptr),
      groups_(scheme.in_rows((invocations(fetches) + std::size_t(scheme.group) - 1) / std::size_t(scheme.group))) {}

void TextureRate::run() const {
  density_.bind(0);
  sums_.bind_storage(0);
  program_.dispatch_groups(groups_.x, groups_.y);
}

}  // namespace insonate::gl
