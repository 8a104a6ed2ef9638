#pragma once

#include <string>

#include "devices/igtl/igtl_message.h"

namespace insonate::igtl {

/// Reads the bytes as a stream, whole and in portions of `portion` bytes. Empty when the reader keeps what its header
/// promises of any bytes, and every parser lives through what it finds; else what is broken.
std::string broken_promise(ByteView bytes, std::size_t portion);

}  // namespace insonate::igtl
