#pragma once

#include <cstdint>
#include <string>

#include "sim/core/image.h"

namespace insonate {

/// A picture as the bytes of a PNG file, for what keeps it elsewhere than in a file.
std::string png_bytes(const Image<std::uint8_t>& grey);

}  // namespace insonate
