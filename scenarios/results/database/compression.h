#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace insonate {

/// Compresses bytes to zlib's format (RFC 1950), which includes a checksum of the bytes.
std::string compressed(std::string_view bytes);

/// Decompresses to exactly `size` bytes. Never allocates more, whatever the data claim. Returns nothing if the data are
/// damaged or have another size.
std::optional<std::string> decompressed(std::string_view zlib, std::size_t size);

}  // namespace insonate
