#pragma once

#include <cstdint>
#include <string>

#include "sim/core/image.h"

namespace insonate {

/// Returns a picture encoded as PNG, for storage elsewhere than in a file. Throws std::runtime_error if the encoding
/// fails.
std::string png_bytes(const Image<std::uint8_t>& grey);

}  // namespace insonate
