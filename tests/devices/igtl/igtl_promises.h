#pragma once

#include <string>

#include "devices/igtl/igtl_message.h"

namespace insonate::igtl {

/// Reads the bytes as a stream, whole and in portions of `portion` bytes. Returns an empty string if the reader keeps
/// what its header promises for any bytes and every parser survives what it finds; otherwise what is broken.
std::string broken_promise(ByteView bytes, std::size_t portion);

}  // namespace insonate::igtl
