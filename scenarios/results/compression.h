#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace insonate {

/// zlib's format (RFC 1950), which carries a checksum of the bytes.
std::string compressed(std::string_view bytes);

/// The way back, to exactly `size` bytes: no more is ever allocated, whatever the data claim. Empty when they are
/// damaged or come to another size.
std::optional<std::string> decompressed(std::string_view zlib, std::size_t size);

}  // namespace insonate
