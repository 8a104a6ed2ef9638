#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace insonate {

/// A file's bytes of which only both ends need to be in memory. Its images are not needed, and may be larger than the
/// memory.
struct CutBytes {
  std::string_view front;  ///< the first bytes
  std::uint64_t size = 0;  ///< number of all bytes
  std::string_view back;   ///< the last bytes

  /// Makes a CutBytes of a whole file.
  static CutBytes whole(std::string_view bytes) { return {bytes, bytes.size(), bytes}; }

  /// Returns the bytes from `offset` on. `offset` is at most the size of `front`.
  CutBytes from(std::size_t offset) const {
    const std::uint64_t left = size - offset;
    const auto kept = std::size_t(std::min<std::uint64_t>(back.size(), left));
    return {front.substr(offset), left, back.substr(back.size() - kept)};
  }
};

}  // namespace insonate
