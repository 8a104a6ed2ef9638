#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace insonate {

/// A file's bytes of which only both ends need be at hand: its images are of no interest, and may be larger than the
/// memory.
struct CutBytes {
  std::string_view front;  ///< the first ones
  std::uint64_t size = 0;  ///< of all
  std::string_view back;   ///< the last ones

  /// All of them.
  static CutBytes whole(std::string_view bytes) { return {bytes, bytes.size(), bytes}; }

  /// Those from `offset` on, which is no more than there is in front.
  CutBytes from(std::size_t offset) const {
    const std::uint64_t left = size - offset;
    const auto kept = std::size_t(std::min<std::uint64_t>(back.size(), left));
    return {front.substr(offset), left, back.substr(back.size() - kept)};
  }
};

}  // namespace insonate
