#pragma once

#include <string>

#include "devices/bytes.h"

namespace insonate {

/// Gives the bytes to every parser of reports, and to the stream in portions that depend on the bytes. Empty when all
/// keep what their headers promise of any bytes; else what is broken.
std::string broken_promise(Bytes bytes);

}  // namespace insonate
