#pragma once

#include <string>

#include "devices/bytes.h"

namespace insonate {

/// Passes the bytes to every parser of reports, and to the stream in portions that depend on the bytes. Returns an
/// empty string if all keep what their headers promise for any bytes; otherwise what is broken.
std::string broken_promise(Bytes bytes);

}  // namespace insonate
